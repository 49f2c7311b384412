"""Media types of the files of pages, and third-party JavaScript: as npm installed it, or as a built wheel contains
it.
"""

from __future__ import annotations

from pathlib import Path

from threadstate.errors import NotFoundError

HTML = "text/html; charset=utf-8"
JAVASCRIPT = "text/javascript; charset=utf-8"
CSS = "text/css; charset=utf-8"
SVG = "image/svg+xml"
TEXT = "text/plain; charset=utf-8"

_HERE = Path(__file__).parent
_IN_WHEEL = _HERE / "node_modules"
_IN_SOURCE_TREE = _HERE.parent / "node_modules"


def third_party_file(package: str, name: str) -> bytes:
    """The bytes of the file ``name`` of an npm package.

    Raises:
        NotFoundError: the package was not fetched.
    """
    for folder in (_IN_WHEEL, _IN_SOURCE_TREE):
        if (folder / package / name).is_file():
            return (folder / package / name).read_bytes()
    raise NotFoundError(f"{package}/{name} is not installed; run `make setup`")
