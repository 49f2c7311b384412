"""docs/python.md lists the modules that pages and examples import, and no others than there are."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from scripts.docs_site.python_reference import MODULE

IMPORTED = re.compile(r"^from (threadstate[\w.]*) import", re.MULTILINE)


@pytest.fixture(scope="module")
def listed(repository_root: Path) -> list[str]:
    """The modules that the page lists."""
    return MODULE.findall((repository_root / "docs" / "python.md").read_text())


def test_every_module_is_there_once(repository_root: Path, listed: list[str]) -> None:
    assert len(listed) > 30
    assert sorted(set(listed)) == sorted(listed)
    paths = [repository_root / name.replace(".", "/") for name in listed]
    assert [path for path in paths if not (path.with_suffix(".py").is_file() or (path / "__init__.py").is_file())] == []


def test_every_module_that_is_imported_for_readers_is_listed(repository_root: Path, listed: list[str]) -> None:
    shown = [*(repository_root / "docs").rglob("*.md"), *(repository_root / "examples").glob("*.py")]
    imported = {module for path in shown for module in IMPORTED.findall(path.read_text())}
    assert {"threadstate.client", "threadstate.state.solve"} <= imported
    assert sorted(imported - set(listed)) == []


def test_every_answer_of_the_client_is_listed(repository_root: Path, listed: list[str]) -> None:
    models = {path.stem for path in (repository_root / "threadstate" / "client" / "models").glob("[!_]*.py")}
    assert sorted(f"threadstate.client.models.{name}" for name in models - {"answer"}) == sorted(
        name for name in listed if name.startswith("threadstate.client.models.")
    )
