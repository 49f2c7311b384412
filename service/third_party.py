"""Third-party JavaScript, as npm fetched it at set-up or as a built wheel brings it."""

from __future__ import annotations

from pathlib import Path

from threadstate.errors import NotFoundError

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
