"""``/``: the explorer's page and its files, read and compressed once; and a page for unknown addresses."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

from fastapi import APIRouter, FastAPI, Request, Response
from starlette.exceptions import HTTPException

from service.page_files import CSS, HTML, JAVASCRIPT, SVG, TEXT, third_party_file
from service.representation import REVALIDATE, zipped_representation
from threadstate.errors import NotFoundError

_PAGE = Path(__file__).parent / "page"
_MEDIA_TYPES = {".html": HTML, ".css": CSS, ".js": JAVASCRIPT, ".svg": SVG}

THIRD_PARTY = {
    "third-party/three.module.js": ("three", "build/three.module.js", JAVASCRIPT),
    "third-party/three.core.js": ("three", "build/three.core.js", JAVASCRIPT),
    "third-party/three.LICENSE.txt": ("three", "LICENSE", TEXT),
}
"""Names under which third-party files are served: package, name there, media type."""

INDEX = "index.html"
UNKNOWN = "unknown.html"
_VERSION_MARK = b"{{version}}"
_MODULES_MARK = b"<!-- modules -->"
"""Where the page lists the modules of its first view, so that they are fetched at once."""
_LATER = {"js/main.js"} | {
    f"js/{name}.js"
    for name in (
        *("scene_view", "glb", "force_marks"),
        *("tab_views", "disks_view", "disks", "follows_view", "network_view", "overview", "path_view"),
        *("locate_view", "poses_view", "load_view", "jamming_view", "device_view"),
        *("turned_path_view", "turned_path_chart"),
    )
}
"""Modules that are not preloaded: the entry point, and those that are needed after the first view."""
_VERSION_LENGTH = 16


@dataclass(frozen=True)
class PageFile:
    """A file of the page: its media type, its bytes, and the same compressed by gzip."""

    media_type: str
    content: bytes
    zipped: bytes


@dataclass(frozen=True)
class Page:
    """All files by their names, and the version that changes with any of them."""

    version: str
    files: dict[str, PageFile]


@lru_cache(maxsize=1)
def page() -> Page:
    """The page.

    Raises:
        NotFoundError: the third-party packages were not fetched.
    """
    sources = {
        path.relative_to(_PAGE).as_posix(): (_MEDIA_TYPES[path.suffix], path.read_bytes())
        for path in sorted(_PAGE.rglob("*"))
        if path.is_file()
    }
    for name, (package, source, media_type) in THIRD_PARTY.items():
        sources[name] = (media_type, third_party_file(package, source))
    version = _version(sources)
    modules = [name for name in sources if name.startswith("js/") and name not in _LATER]
    preloads = "\n".join(f'<link rel="modulepreload" href="/explorer/{version}/{name}">' for name in modules)

    def filled(media_type: str, content: bytes) -> bytes:
        if media_type != HTML:
            return content
        return content.replace(_MODULES_MARK, preloads.encode()).replace(_VERSION_MARK, version.encode())

    files = {name: _file(media_type, filled(media_type, content)) for name, (media_type, content) in sources.items()}
    return Page(version, files)


def _version(sources: dict[str, tuple[str, bytes]]) -> str:
    digest = hashlib.sha256()
    for name, (_, content) in sources.items():
        digest.update(f"{name} {len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()[:_VERSION_LENGTH]


def _file(media_type: str, content: bytes) -> PageFile:
    return PageFile(media_type, content, gzip.compress(content, mtime=0))


router = APIRouter(include_in_schema=False)

FOR_GOOD = "public, max-age=31536000, immutable"
"""The address of a file contains the page's version, so its content never changes."""


@router.get("/")
def explorer(request: Request) -> Response:
    """The page."""
    return _answer(request, page().files[INDEX], REVALIDATE)


@router.get("/explorer/{version}/{name:path}")
def explorer_file(request: Request, version: str, name: str) -> Response:
    """A file that the page needs."""
    found = page().files.get(name)
    if found is None or version != page().version:
        raise NotFoundError("no such file; the page at / names the files")
    return _answer(request, found, FOR_GOOD)


def _answer(request: Request, file: PageFile, cache_control: str) -> Response:
    headers = {"Cache-Control": cache_control}
    return zipped_representation(request, file.content, file.zipped, file.media_type, headers)


def install_unknown_page(app: FastAPI) -> None:
    """Respond to 404 with a page where a browser asks for HTML; other handlers must be installed before."""
    answer: Any = app.exception_handlers[HTTPException]

    def answer_or_page(request: Request, error: Any) -> Response:
        if error.status_code == 404 and _asks_for_a_page(request):
            unknown = page().files[UNKNOWN]
            return Response(unknown.content, 404, {"Cache-Control": "no-store"}, unknown.media_type)
        response: Response = answer(request, error)
        return response

    app.add_exception_handler(HTTPException, answer_or_page)


def _asks_for_a_page(request: Request) -> bool:
    return "text/html" in request.headers.get("accept", "") and not request.url.path.startswith("/v1/")
