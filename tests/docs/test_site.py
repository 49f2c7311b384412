"""The site of the documentation: whole, in the order of its index, and nothing in it is fetched from elsewhere."""

from __future__ import annotations

import re
import shutil
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest
from selenium import webdriver
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from harness.browser import start_chromium
from scripts.docs_site.build import SiteError, build_site
from scripts.docs_site.navigation import sections_of
from scripts.docs_site.python_reference import UndocumentedError, reference_pages
from tests.explorer.test_accessibility import AXE, GRAVE
from threadstate import client

pytestmark = pytest.mark.slow

LOADED = ("src", "srcset", "poster", "data", "action", "formaction", "background")
"""Attributes whose address a browser asks by itself, or sends a form to."""
NOT_LOADED = ("canonical", "prev", "next", "license")
"""Relations of a ``<link>`` that a browser does not follow."""
ELSEWHERE = re.compile(r"^\s*(?:https?:)?//", re.IGNORECASE)
IN_STYLE = re.compile(r"(?:url\(|@import)\s*[\"']?\s*(?:https?:)?//[^\"')\s]+", re.IGNORECASE)
IN_SCRIPT = re.compile(r"https?://(?!www\.w3\.org/)[\w.-]+\.\w+", re.IGNORECASE)
"""An address in a script, but for the names of XML's namespaces."""
IN_DRAWING = re.compile(r"(?:href|src)\s*=\s*[\"'](?:https?:)?//[^\"']+", re.IGNORECASE)
WAIT_S = 20.0
AXE_OPTIONS = {"preload": False, "rules": {"scrollable-region-focusable": {"enabled": False}}}
"""axe-core asks for style sheets that a page from a file may not read, and for a focus of boxes that browsers give."""

SMALL = {
    "README.md": "# Home\n",
    "CONTRIBUTING.md": "# Contributing\n",
    "CHANGELOG.md": "# Changes\n",
    "docs/README.md": "# Documentation\n\n## Tutorials\n\n- [One](one.md): first.\n- [2](two.md): second.\n"
    "- [Python](python.md): modules.\n",
    "docs/one.md": "# One\n\n## A, b (`c`)\n\n[two](two.md#things), [file](../made.toml), [folder](../docs)\n",
    "docs/two.md": "# 2. Two: and more\nBelow:\n- an item\n\n## Things\n| a | b |\n|---|---|\n| `\\|V\\|` | c |\n",
    "docs/python.md": "# Python\n\n| module | what it has |\n|---|---|\n| `threadstate.made` | all |\n",
    "made.toml": "a = 1\n",
    "threadstate/__init__.py": '"""A package."""\n',
    "threadstate/made.py": '"""Made, as docs/one.md says."""\n\n\ndef double(number: float, *, by: int = 2) -> float:\n'
    '    """Twice ``number``.\n\n    Raises:\n        ValueError: no number.\n    """\n    return by * number\n',
}
"""A repository with a few pages."""


@dataclass
class Read(HTMLParser):
    """What a page has and asks for."""

    anchors: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    elsewhere: list[str] = field(default_factory=list)
    tabs: list[str] = field(default_factory=list)
    _inside: str = ""
    _is_tab: bool = False

    def __post_init__(self) -> None:
        super().__init__()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self._inside, self._is_tab = tag, "md-tabs__link" in given.get("class", "")
        self.anchors |= {given[name] for name in ("id", "name") if name in given}
        asked = [given[name] for name in LOADED if name in given]
        if tag in ("link", "use", "image") and not set(given.get("rel", "").split()) & set(NOT_LOADED):
            asked += [given[name] for name in ("href", "xlink:href") if name in given]
        if given.get("http-equiv", "").lower() == "refresh":
            asked += [given.get("content", "").partition("=")[2]]
        self.elsewhere += [one for one in asked if ELSEWHERE.search(one)]
        self.elsewhere += IN_STYLE.findall(given.get("style", ""))
        self.links += asked
        if tag == "a" and "href" in given:
            self.links.append(given["href"])

    def handle_data(self, data: str) -> None:
        if self._inside == "script":
            self.elsewhere += IN_SCRIPT.findall(data)
        elif self._inside == "style":
            self.elsewhere += IN_STYLE.findall(data)
        elif self._is_tab and data.strip():
            self.tabs.append(data.strip())

    def handle_endtag(self, tag: str) -> None:
        if tag == self._inside:
            self._inside, self._is_tab = "", False


def read(page: Path) -> Read:
    """A page, read."""
    parser = Read()
    parser.feed(page.read_text())
    parser.close()
    return parser


def asked_elsewhere(file: Path) -> list[str]:
    """What a browser would fetch from another place because of a file."""
    kinds: dict[str, Callable[[str], list[str]]] = {
        ".css": IN_STYLE.findall,
        ".js": IN_SCRIPT.findall,
        ".svg": lambda text: [*IN_STYLE.findall(text), *IN_DRAWING.findall(text)],
    }
    if file.suffix == ".html":
        return read(file).elsewhere
    return kinds[file.suffix](file.read_text()) if file.suffix in kinds else []


def broken_links(site: Path) -> Iterator[str]:
    """What pages of a site link to that is not there."""
    pages = {path: read(path) for path in site.rglob("*.html")}
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc or path.name == "404.html":
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            if not target.is_file():
                yield f"{path.relative_to(site)}: {link}"
            elif target in pages and parts.fragment and unquote(parts.fragment) not in pages[target].anchors:
                yield f"{path.relative_to(site)}: {link}, no such anchor"


@pytest.fixture(scope="module")
def site(repository_root: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The built site."""
    folder = tmp_path_factory.mktemp("built").resolve() / "site"
    build_site(repository_root, folder)
    return folder


@pytest.fixture
def small(tmp_path: Path) -> Path:
    """A repository with a few pages."""
    for name, text in SMALL.items():
        path = tmp_path / "small" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "small"


def test_every_page_of_the_index_is_built(repository_root: Path, site: Path) -> None:
    names = {path.relative_to(repository_root / "docs") for path in (repository_root / "docs").rglob("*.md")}
    wanted = {name.with_suffix(".html").as_posix() for name in names if name.name != "README.md"}
    built = {path.relative_to(site).as_posix() for path in site.rglob("*.html")}
    assert sorted(wanted - built) == []
    assert {"index.html", "pages.html", "contributing.html", "changelog.html"} <= built


def test_the_navigation_is_that_of_the_index(repository_root: Path, site: Path) -> None:
    sections = sections_of((repository_root / "docs" / "README.md").read_text())
    titles = [section.title for section in sections]
    assert {"Tutorials", "How-to", "Reference", "Explanations", "Studies", "Decisions"} <= set(titles)
    assert read(site / "index.html").tabs == ["Home", *titles]


def test_every_link_leads_somewhere(site: Path) -> None:
    assert list(broken_links(site)) == []


def test_nothing_is_fetched_from_elsewhere(site: Path) -> None:
    files = [path for path in site.rglob("*") if path.is_file()]
    assert {".html", ".css", ".js", ".svg"} <= {path.suffix for path in files}
    # The search's index is the text of the pages, with the addresses that they name.
    asked = {path.relative_to(site).as_posix(): asked_elsewhere(path) for path in files if path.name != "search.js"}
    assert {name: found for name, found in asked.items() if found} == {}


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.html", '<script src="https://example.com/a.js"></script>'),
        ("a.html", '<img src="//example.com/a.png">'),
        ("a.html", '<link rel="stylesheet" href="https://example.com/a.css">'),
        ("a.html", '<p style="background: url(https://example.com/a.png)">'),
        ("a.html", "<style>@import 'https://example.com/a.css';</style>"),
        ("a.html", "<script>fetch('https://example.com/a')</script>"),
        ("a.css", "a { background: url('https://example.com/a.png') }"),
        ("a.js", "import('https://example.com/a.js')"),
        ("a.svg", '<svg><image href="https://example.com/a.png"/></svg>'),
    ],
)
def test_what_is_fetched_from_elsewhere_is_found(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    assert asked_elsewhere(tmp_path / name) != []


def test_a_link_to_a_source_is_not_fetched(tmp_path: Path) -> None:
    (tmp_path / "a.html").write_text('<a href="https://example.com">a</a><link rel="canonical" href="https://b.com">')
    assert asked_elsewhere(tmp_path / "a.html") == []


def test_cells_are_marked_by_their_length(site: Path) -> None:
    glossary = (site / "glossary.html").read_text()
    assert '<td class="long">What a device turns the bolt about' in glossary
    assert '<td class="short"><code class="name">about</code></td>' in glossary


def test_bars_in_code_of_tables_are_bare(site: Path) -> None:
    assert "\\|" not in (site / "certificate.html").read_text()


def test_the_client_is_documented_as_it_is(site: Path) -> None:
    anchors = read(site / "python" / "threadstate.client.html").anchors
    assert set(client.__all__) <= anchors
    for one in (client.Client, client.AsyncClient):
        methods = {f"{one.__name__}.{name}" for name in vars(one) if not name.startswith("_")}
        assert len(methods) > 40
        assert sorted(methods - anchors) == []


def test_names_lead_to_their_own_module(site: Path) -> None:
    settle, client_page = (
        (site / "python" / f"{name}.html").read_text() for name in ("threadstate.device.settle", "threadstate.client")
    )
    assert 'href="threadstate.thread.pair.html#Pair"' in settle
    assert 'href="threadstate.errors.html#InvalidValueError"' in settle
    assert 'href="threadstate.client.models.states.html#State"' in client_page
    assert "threadstate.state.model.html#Contact" not in client_page


def test_a_small_site_has_pages_files_and_modules(small: Path, tmp_path: Path) -> None:
    build_site(small, tmp_path / "site")
    assert list(broken_links(tmp_path / "site")) == []
    one, two, made = (
        (tmp_path / "site" / name).read_text() for name in ("one.html", "two.html", "python/threadstate.made.html")
    )
    assert 'href="two.html#things"' in one
    assert 'href="files/made.toml.html"' in one
    assert 'id="a-b-c"' in one
    assert ">folder<" not in one
    assert "<li>an item</li>" in two
    assert '<code class="name">|V|</code>' in two
    assert "2. Two" in read_navigation(one)
    assert 'href="../one.html"' in made
    assert "double" in made
    assert "ValueError" in made


def read_navigation(page: str) -> str:
    """The part of a page that is its navigation."""
    return page.partition('class="md-sidebar')[2].partition('class="md-content')[0]


@pytest.mark.parametrize("link", ["[a](two.md#gone)", "[a](#gone)"])
def test_a_broken_anchor_fails_the_build(small: Path, tmp_path: Path, link: str) -> None:
    (small / "docs" / "one.md").write_text(f"# One\n\n{link}\n")
    (tmp_path / "site").mkdir()
    with pytest.raises(SiteError, match=r"one\.md"):
        build_site(small, tmp_path / "site")
    assert (tmp_path / "site").is_dir()


def test_a_link_to_a_file_that_is_not_there_fails_the_build(small: Path, tmp_path: Path) -> None:
    (small / "docs" / "one.md").write_text("# One\n\n[a](../gone.toml)\n")
    with pytest.raises(FileNotFoundError, match=r"gone\.toml"):
        build_site(small, tmp_path / "site")


@pytest.mark.parametrize(
    ("module", "message"),
    [
        ('"""Made."""\n\n\ndef double() -> None:\n    pass\n', "threadstate.made.double: no docstring"),
        ('"""Made."""\n\n__all__ = ["gone"]\n', "threadstate.made.gone: no such name"),
        (None, "threadstate.made: no such module"),
    ],
)
def test_what_is_listed_and_not_documented_is_refused(small: Path, module: str | None, message: str) -> None:
    path = small / "threadstate" / "made.py"
    path.unlink()
    if module is not None:
        path.write_text(module)
    with pytest.raises(UndocumentedError, match=message):
        reference_pages(small, SMALL["docs/python.md"])


@pytest.fixture(scope="module")
def chromium() -> Iterator[webdriver.Chrome]:
    """A headless browser as wide as a phone."""
    chromium = start_chromium(390, 844)
    yield chromium
    chromium.quit()


@pytest.mark.parametrize("name", ["index", "cli", "glossary", "certificate", "success", "python/threadstate.client"])
def test_a_page_is_no_wider_than_a_phone_and_complains_of_nothing(
    site: Path, chromium: webdriver.Chrome, name: str
) -> None:
    chromium.get((site / f"{name}.html").as_uri())
    assert chromium.execute_script("return document.documentElement.scrollWidth") <= 390
    assert chromium.get_log("browser") == []


@pytest.mark.parametrize("scheme", ["default", "slate"])
def test_axe_finds_nothing_serious(repository_root: Path, site: Path, chromium: webdriver.Chrome, scheme: str) -> None:
    chromium.get((site / "success.html").as_uri())
    chromium.execute_script(
        "document.querySelector(`[data-md-color-scheme=${arguments[0]}].md-option`).click()", scheme
    )
    assert chromium.execute_script("return document.body.dataset.mdColorScheme") == scheme
    chromium.execute_cdp_cmd("Runtime.evaluate", {"expression": (repository_root / AXE).read_text()})
    found = chromium.execute_async_script("axe.run(arguments[0]).then(arguments[1])", AXE_OPTIONS)
    assert len(found["passes"]) > 10
    assert [one["help"] for one in found["violations"] if one["impact"] in GRAVE] == []


def test_the_search_finds_a_page(site: Path, chromium: webdriver.Chrome) -> None:
    chromium.get((site / "decisions" / "0031-device.html").as_uri())
    chromium.find_element(By.CSS_SELECTOR, "label.md-header__button[for=__search], .md-search__button").click()
    ended = time.monotonic() + WAIT_S
    found = ""
    while "Success maps" not in found and time.monotonic() < ended:
        chromium.switch_to.active_element.send_keys(Keys.CONTROL, "a")
        chromium.switch_to.active_element.send_keys("area of tilt")
        found = chromium.execute_script(
            "return [...document.querySelectorAll('*')].map((one) => one.shadowRoot?.textContent ?? '').join(' ')"
        )
    assert "Success maps" in found
    assert chromium.get_log("browser") == []


def test_a_build_replaces_the_one_before(small: Path, tmp_path: Path) -> None:
    folder = tmp_path / "site"
    folder.mkdir()
    (folder / "old.html").write_text("old")
    build_site(small, folder)
    assert not (folder / "old.html").exists()
    shutil.rmtree(folder)
