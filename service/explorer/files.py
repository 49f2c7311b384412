"""The files of the explorer's page, with their compressed bytes, read once."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from service.media_types import CSS, HTML, JAVASCRIPT, SVG, TEXT
from service.third_party import third_party_file

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
"""Where the page names the modules that its first view needs, so that they are fetched all at once."""
_LATER = {"js/main.js"} | {
    f"js/{name}.js"
    for name in (
        *("scene_view", "glb"),
        *("tab_views", "disks_view", "disks", "follows_view", "network_view", "overview", "path_view"),
        *("locate_view", "poses_view"),
    )
}
"""The module that asks for the others, and those that come after the first view: the solids', and those of the tabs."""
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
