"""``/`` and the files that its page needs."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from service.explorer.files import INDEX, PageFile, page
from service.representation import REVALIDATE, zipped_representation
from threadstate.errors import NotFoundError

router = APIRouter(include_in_schema=False)

FOR_GOOD = "public, max-age=31536000, immutable"
"""The address of a file holds the page's version: what is behind it never changes."""


@router.get("/")
def explorer(request: Request) -> Response:
    """The page."""
    return _answer(request, page().files[INDEX], REVALIDATE)


@router.get("/explorer/{version}/{name:path}")
def explorer_file(request: Request, version: str, name: str) -> Response:
    """A file that the page needs."""
    found = page().files.get(name)
    if found is None or version != page().version:
        raise NotFoundError("no such file; the page at / names those that there are")
    return _answer(request, found, FOR_GOOD)


def _answer(request: Request, file: PageFile, cache_control: str) -> Response:
    headers = {"Cache-Control": cache_control}
    return zipped_representation(request, file.content, file.zipped, file.media_type, headers)
