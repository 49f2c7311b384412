"""The files of the page at ``/docs``; the third-party ones come from the package that was fetched at set-up."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from service.media_types import CSS, JAVASCRIPT, TEXT
from service.third_party import third_party_file

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
