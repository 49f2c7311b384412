"""docs/architecture.md names files that are there, and the ways of a pose are short."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

MOST_FILES = 12
"""How many files one has to open to follow a state, kernels counted as one."""


@pytest.fixture(scope="module")
def page(repository_root: Path) -> str:
    """The page."""
    return (repository_root / "docs" / "architecture.md").read_text()


def files_named(text: str) -> list[str]:
    """The Python files that a text names, in order."""
    return re.findall(r"`([\w/]+\.py)`", text)


def test_every_file_named_is_there(repository_root: Path, page: str) -> None:
    named = files_named(page)
    assert len(named) > MOST_FILES
    assert [name for name in named if not (repository_root / name).is_file()] == []


@pytest.mark.parametrize("way", ["The way of a pose that is solved", "The way of a pose that is stored"])
def test_a_way_is_short(page: str, way: str) -> None:
    section = page.partition(f"## {way}\n")[2].partition("\n## ")[0]
    assert 5 < len(set(files_named(section))) <= MOST_FILES


def test_every_folder_of_the_package_is_described(repository_root: Path, page: str) -> None:
    folders = {path.parent.name for path in (repository_root / "threadstate").glob("*/__init__.py")}
    table = page.partition("## Inside threadstate\n")[2].partition("\n## ")[0]
    described = {name for cell in re.findall(r"^\| (`.*?`) \|", table, re.M) for name in re.findall(r"`(\w+)`", cell)}
    assert described == folders


def test_the_picture_shows_every_folder(repository_root: Path) -> None:
    picture = (repository_root / "docs" / "architecture.svg").read_text()
    shown = {name for text in re.findall(r'<text class="name".*?>(.*?)</text>', picture) for name in text.split(" · ")}
    folders = {path.parent.name for path in (repository_root / "threadstate").glob("*/__init__.py")}
    assert folders | {"threadstate", "worker", "service", "migrations"} <= shown
