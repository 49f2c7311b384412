"""``/docs`` and ``/openapi.json``, with the files of the page; the third-party ones come from packages fetched at
set-up.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from fastapi import APIRouter, Request, Response

from service.page_files import CSS, HTML, JAVASCRIPT, TEXT, third_party_file
from service.representation import json_response, representation
from service.request_middleware import CONTENT_SECURITY_POLICY
from threadstate.errors import NotFoundError

PACKAGE = "swagger-ui-dist"
_HERE = Path(__file__).parent


@dataclass(frozen=True)
class Asset:
    """A file that the page needs: its name, its media type, and whether it is third-party."""

    name: str
    media_type: str
    third_party: bool

    def content(self) -> bytes:
        """The file's bytes.

        Raises:
            NotFoundError: the third-party package was not fetched.
        """
        return third_party_file(PACKAGE, self.name) if self.third_party else (_HERE / self.name).read_bytes()


ASSETS = {
    asset.name: asset
    for asset in (
        Asset("swagger-ui-bundle.js", JAVASCRIPT, third_party=True),
        Asset("swagger-ui.css", CSS, third_party=True),
        Asset("swagger-ui-bundle.js.LICENSE.txt", TEXT, third_party=True),
        Asset("LICENSE", TEXT, third_party=True),
        Asset("NOTICE", TEXT, third_party=True),
        Asset("start.js", JAVASCRIPT, third_party=False),
    )
}
"""All files of the page, and the licences of the third-party ones, by their names."""

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>threadstate: the interface</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="/docs/assets/swagger-ui.css">
</head>
<body>
<div id="interface"></div>
<script src="/docs/assets/swagger-ui-bundle.js"></script>
<script src="/docs/assets/start.js"></script>
</body>
</html>
"""

router = APIRouter(include_in_schema=False)

# The page's library styles elements in place.
_PAGE_POLICY = f"{CONTENT_SECURITY_POLICY}; style-src 'self' 'unsafe-inline'"


@router.get("/docs")
def docs(request: Request) -> Response:
    """The interface, to be read and tried."""
    headers = {"Content-Security-Policy": _PAGE_POLICY}
    return representation(request, PAGE.encode(), HTML, headers)


@router.get("/docs/assets/{name}")
def docs_asset(request: Request, name: str) -> Response:
    """A file that the page needs."""
    asset = ASSETS.get(name)
    if asset is None:
        raise NotFoundError(f"no such file; there are {', '.join(ASSETS)}")
    return representation(request, asset.content(), asset.media_type)


@router.get("/openapi.json")
def openapi(request: Request) -> Response:
    """The interface as an OpenAPI document."""
    return json_response(request, request.app.openapi())
