"""``/docs`` and ``/openapi.json``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from service.docs.assets import ASSETS, PAGE
from service.edge.middleware import CONTENT_SECURITY_POLICY
from service.media_types import HTML
from service.representation import json_response, representation
from threadstate.errors import NotFoundError

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
