"""docs/README.md lists every page once; the navigation of the site is derived from it."""

from __future__ import annotations

import re
from pathlib import Path


def test_every_page_is_listed_once_with_a_line(repository_root: Path) -> None:
    docs = repository_root / "docs"
    entries = re.findall(r"^- \[[^\]]+\]\(([^)#]+)\): \S.*\.$", (docs / "README.md").read_text(), re.MULTILINE)
    pages = {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")} - {"README.md"}
    assert len(pages) > 30
    assert sorted(entry for entry in entries if not entry.startswith("../")) == sorted(pages)


def test_every_entry_of_the_index_is_read(repository_root: Path) -> None:
    text = (repository_root / "docs" / "README.md").read_text()
    items = [line for line in text.splitlines() if line.startswith("- ")]
    assert all(re.fullmatch(r"- \[[^\]]+\]\([^)#]+\): \S.*\.", line) for line in items)
