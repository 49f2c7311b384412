"""Pages of the repository as pages of the site.

Markdown is written for its readers in a checkout: links lead to files of the repository, lists follow their sentence at
once, anchors are those that a forge makes. Here links are turned to where the site has their targets, files that pages
link to become pages themselves, and headings get the anchors that links expect.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from scripts.docs_site.navigation import Navigation, navigation_of, normal, sections_of
from scripts.docs_site.python_reference import PACKAGE, reference_pages
from scripts.docs_site.python_reference import PAGE as PYTHON_PAGE

DOCS = PurePosixPath("docs")
INDEX = DOCS / "README.md"
HOME = PurePosixPath("README.md")
ADDRESSES = {
    HOME: PurePosixPath("index.md"),
    INDEX: PurePosixPath("pages.md"),
    PurePosixPath("CONTRIBUTING.md"): PurePosixPath("contributing.md"),
    PurePosixPath("CHANGELOG.md"): PurePosixPath("changelog.md"),
}
"""Where pages are that are called otherwise in the site, or that are outside docs."""
FILES = PurePosixPath("files")
"""Where the site has pages of files that pages link to."""
LANGUAGES = {".py": "python", ".toml": "toml", ".cff": "yaml", ".json": "json"}

DARK = "(prefers-color-scheme: dark)"
"""Where drawings are dark. Those of the site are on a light ground, as a page's colours are chosen on it."""

BLOCK_OF_CODE = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(?P<mark>!?)\[(?P<text>(?:[^\]\[]|\[[^\]]*\])*)\]\((?P<target>[^)\s]+)\)")
HEADING = re.compile(r"^(?P<level>#+) (?P<title>.*)$", re.MULTILINE)
ITEM, ROW = re.compile(r"- "), re.compile(r"\|")
CODE = re.compile(r"`[^`]*`")


@dataclass(frozen=True)
class Page:
    """A page of the repository: its path there, and its path in the site."""

    source: PurePosixPath
    address: PurePosixPath


def stage(root: Path, folder: Path) -> Navigation:
    """Write the site's pages and pictures into ``folder``, and return its navigation.

    Raises:
        FileNotFoundError: a page links to a file that is not there.
    """
    shutil.copytree(root / DOCS, folder, ignore=shutil.ignore_patterns("*.md"))
    for drawing in folder.rglob("*.svg"):
        drawing.write_text(drawing.read_text().replace(DARK, "not all"))
    pages = list(_pages(root))
    addresses = {page.source: page.address for page in pages}
    headings: dict[PurePosixPath, str] = {}
    staging = _Staging(root, addresses)
    for page in pages:
        text = (root / page.source).read_text()
        headings[page.source] = text.partition("\n")[0].removeprefix("# ")
        _write(folder / page.address, staging.staged(page, text))
    for path in sorted(staging.files):
        _write(folder / file_address(path), _file_page(path, (root / path).read_text()))
    python_pages = reference_pages(root, (root / PYTHON_PAGE).read_text())
    for one in python_pages:
        _write(folder / one.address, one.text)
    below: dict[PurePosixPath, Navigation] = {
        PYTHON_PAGE: [{one.module.removeprefix(f"{PACKAGE}."): str(one.address)} for one in python_pages]
    }
    index = (root / INDEX).read_text()
    home: Navigation = [{"Home": [str(addresses[HOME]), {"All pages": str(addresses[INDEX])}]}]
    return home + navigation_of(sections_of(index), addresses, headings, below, DOCS)


def file_address(path: PurePosixPath) -> PurePosixPath:
    """Where the site has the page of a file that is no page."""
    return FILES / path.with_name(f"{path.name}.md")


def anchors_of(titles: list[str]) -> list[str]:
    """The anchors of headings: lower case, without punctuation, spaces as hyphens, numbered where they repeat."""
    anchors: list[str] = []
    for title in titles:
        words = LINK.sub(r"\g<text>", title).lower()
        anchor = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        before = anchors.count(anchor)
        anchors.append(f"{anchor}-{before}" if before else anchor)
    return anchors


class _Staging:
    """Turns pages; ``files`` are the files outside the site's pages that these have linked to."""

    def __init__(self, root: Path, addresses: dict[PurePosixPath, PurePosixPath]) -> None:
        self._root = root
        self._addresses = addresses
        self.files: set[PurePosixPath] = set()

    def staged(self, page: Page, text: str) -> str:
        """The page as the site's generator takes it."""
        anchors = iter(anchors_of([found["title"] for found in HEADING.finditer(_without_code(text))]))
        return _outside_code(text, lambda part: self._turned(page, part, anchors))

    def _turned(self, page: Page, text: str, anchors: Iterator[str]) -> str:
        linked = LINK.sub(lambda link: self._link(page, link), text)
        anchored = HEADING.sub(lambda found: f"{found[0]} {{ #{next(anchors)} }}", linked)
        return "\n".join(_with_blank_lines(anchored.split("\n")))

    def _link(self, page: Page, link: re.Match[str]) -> str:
        name, hash_sign, anchor = link["target"].partition("#")
        if "://" in name or not name:
            return link[0]
        source = normal(page.source.parent / name)
        path = self._root / source
        if path.is_dir():
            return link["text"]
        if not path.is_file():
            raise FileNotFoundError(f"{page.source}: {link['target']}")
        to = os.path.relpath(self._address(source), page.address.parent)
        linked = f"{link['mark']}[{link['text']}]({to}{hash_sign}{anchor})"
        return f"[{linked}]({to})" if link["mark"] else linked

    def _address(self, source: PurePosixPath) -> PurePosixPath:
        if source in self._addresses:
            return self._addresses[source]
        if source.is_relative_to(DOCS):
            return source.relative_to(DOCS)
        self.files.add(source)
        return file_address(source)


def _pages(root: Path) -> Iterator[Page]:
    for source in ADDRESSES:
        yield Page(source, ADDRESSES[source])
    for path in sorted((root / DOCS).rglob("*.md")):
        source = PurePosixPath(path.relative_to(root).as_posix())
        if source not in ADDRESSES:
            yield Page(source, source.relative_to(DOCS))


def _file_page(path: PurePosixPath, text: str) -> str:
    fence = "````"
    return f"# {path}\n\n{fence}{LANGUAGES.get(path.suffix, 'text')}\n{text.rstrip()}\n{fence}\n"


def _without_code(text: str) -> str:
    return BLOCK_OF_CODE.sub("", text)


def _outside_code(text: str, turned: Callable[[str], str]) -> str:
    """A text whose parts outside blocks of code are turned."""
    parts, end = [], 0
    for block in BLOCK_OF_CODE.finditer(text):
        parts += [turned(text[end : block.start()]), block[0]]
        end = block.end()
    return "".join([*parts, turned(text[end:])])


def _with_blank_lines(lines: list[str]) -> Iterator[str]:
    """The lines, with a blank one before each list and each table that follows a text at once."""
    before = ""
    inside = False
    for line in lines:
        if not line:
            inside = False
        elif ITEM.match(line) or ROW.match(line):
            if before and not inside:
                yield ""
            inside = True
        yield CODE.sub(_with_bare_bars, line) if ROW.match(line) else line
        before = line


def _with_bare_bars(code: re.Match[str]) -> str:
    """Code of a table's cell: its bars, which end no cell here, are written with a backslash for a forge."""
    return code[0].replace("\\|", "|")


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
