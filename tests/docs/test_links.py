"""Every link between the pages leads to a file, and to a heading, that is there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

LINK = re.compile(r"\[(?:[^\]\[]|\[[^\]]*\])*\]\(([^)\s]+)\)")


def pages(root: Path) -> list[Path]:
    """The pages of the documentation."""
    return [*sorted(root.glob("*.md")), *sorted((root / "docs").rglob("*.md"))]


def without_code(text: str) -> str:
    """A page without its blocks of code, whose brackets are no links and whose hashes are no headings."""
    return re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings: lower case, without punctuation, spaces as hyphens."""
    headings = re.findall(r"^#+ (.*)$", without_code(page.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


def broken_links(page: Path) -> Iterator[str]:
    """What a page links to that is not there."""
    for link in LINK.findall(without_code(page.read_text())):
        if "://" in link:
            continue
        name, _, anchor = link.partition("#")
        target = (page.parent / name) if name else page
        if not target.exists() or (anchor and anchor not in anchors(target)):
            yield link


def test_every_link_leads_somewhere(repository_root: Path) -> None:
    broken = [
        f"{page.relative_to(repository_root)}: {link}" for page in pages(repository_root) for link in broken_links(page)
    ]
    assert broken == []


@pytest.mark.parametrize("link", ["gone.md", "#nothing", "other.md#nothing"])
def test_a_broken_link_is_found(tmp_path: Path, link: str) -> None:
    (tmp_path / "other.md").write_text("# There\n")
    page = tmp_path / "page.md"
    page.write_text(f"# Here, too\n[there](other.md#there), [here](#here-too), ![drawing]({link})\n")
    assert list(broken_links(page)) == [link]
