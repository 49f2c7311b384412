"""The rules of the architecture: which part of the project may import which."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOMS = ("threadstate", "worker", "service", "migrations")

FORBIDDEN = [
    # Four rooms, one direction.
    ("threadstate", ("worker", "service", "migrations", "fastapi", "starlette", "uvicorn", "typer", "multiprocessing")),
    ("worker", ("service", "fastapi", "starlette")),
    (
        "service",
        (
            "worker",
            "migrations",
            "alembic",
            "typer",
            # Libraries are read there and written elsewhere.
            "threadstate.library.write",
            "threadstate.library.copying",
            "threadstate.jobs.work",
        ),
    ),
    ("migrations", ("worker", "service", "threadstate.thread", "threadstate.contact", "threadstate.state")),
    # What is stored of libraries knows nothing of jobs and keys, and these compute nothing.
    ("threadstate/library", ("threadstate.jobs", "threadstate.access")),
    ("threadstate/jobs", ("numba", "threadstate.contact", "threadstate.state.solve", "threadstate.access")),
    ("threadstate/access", ("threadstate.jobs",)),
    # The physics knows no database, and data flows thread -> contact -> state -> library.
    (
        "threadstate/thread",
        (
            "sqlalchemy",
            "threadstate.contact",
            "threadstate.state",
            "threadstate.mesh",
            "threadstate.library",
            "threadstate.history",
        ),
    ),
    (
        "threadstate/contact",
        ("sqlalchemy", "threadstate.state", "threadstate.mesh", "threadstate.library", "threadstate.history"),
    ),
    ("threadstate/state", ("sqlalchemy", "threadstate.mesh", "threadstate.library", "threadstate.history")),
    ("threadstate/mesh", ("sqlalchemy", "threadstate.library", "threadstate.history")),
    ("threadstate/history", ("sqlalchemy", "threadstate.mesh", "threadstate.library")),
    # The search for changes knows no physics.
    ("threadstate/history/changes.py", ("threadstate",)),
    # The network stands on labels alone: it knows neither how they were found nor where they are kept.
    (
        "threadstate/network",
        (
            "numba",
            "sqlalchemy",
            "threadstate.contact",
            "threadstate.state.solve",
            "threadstate.mesh",
            "threadstate.library",
        ),
    ),
    # The client knows the service by its answers alone, and loads nothing that computes or stores.
    (
        "threadstate/client",
        (
            "numba",
            "sqlalchemy",
            "fcl",
            "threadstate.contact",
            "threadstate.state.solve",
            "threadstate.library.tables",
            "threadstate.library.read",
            "threadstate.export.read",
            "threadstate.export.file",
        ),
    ),
    # Exports say what is stored, and compute nothing; what their columns mean needs no database.
    ("threadstate/export", ("numba", "threadstate.contact", "threadstate.state.solve", "threadstate.client")),
    ("threadstate/export/states.py", ("sqlalchemy", "pyarrow", "threadstate.library")),
    # The tables know no physics: names alone (classes, flags, regions) come from there.
    (
        "threadstate/library/tables.py",
        ("numba", "numpy", "threadstate.contact", "threadstate.state.solve", "threadstate.thread.profile"),
    ),
]


def _files(root: Path, part: str) -> list[Path]:
    path = root / part
    return [path] if path.is_file() else sorted(path.rglob("*.py"))


def _imports(path: Path) -> Iterator[str]:
    """Every module that a file imports, wherever in it, by its full name."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path} imports relatively"
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize(("part", "forbidden"), FORBIDDEN, ids=[part for part, _ in FORBIDDEN])
def test_a_part_imports_nothing_that_it_may_not(repository_root: Path, part: str, forbidden: tuple[str, ...]) -> None:
    files = _files(repository_root, part)
    assert files
    broken = [
        f"{path.relative_to(repository_root)} imports {module}"
        for path in files
        for module in _imports(path)
        if any(f"{module}.".startswith(f"{name}.") for name in forbidden)
    ]
    assert broken == []


def test_mesh_libraries_are_imported_in_their_room_alone(repository_root: Path) -> None:
    importing = {
        path.relative_to(repository_root).parent.as_posix()
        for room in ROOMS
        for path in _files(repository_root, room)
        if any(module.split(".")[0] in ("fcl", "trimesh") for module in _imports(path))
    }
    assert importing == {"threadstate/mesh"}


def test_one_file_alone_imports_fcl(repository_root: Path) -> None:
    importing = [
        path
        for part in (*ROOMS, "benchmarks", "studies", "tests")
        for path in _files(repository_root, part)
        if any(module.split(".")[0] == "fcl" for module in _imports(path))
    ]
    assert len(importing) == 1


def test_one_file_alone_imports_pyarrow(repository_root: Path) -> None:
    importing = {
        path.relative_to(repository_root).as_posix()
        for room in ROOMS
        for path in _files(repository_root, room)
        if any(module.split(".")[0] == "pyarrow" for module in _imports(path))
    }
    assert importing == {"threadstate/export/parquet.py"}


def test_one_file_alone_imports_matplotlib_and_only_when_it_draws(repository_root: Path) -> None:
    files = [path for room in ROOMS for path in _files(repository_root, room)]
    importing = [path for path in files if any(module.split(".")[0] == "matplotlib" for module in _imports(path))]
    assert [path.relative_to(repository_root).as_posix() for path in importing] == ["worker/plots.py"]
    at_the_top = [
        ast.unparse(node)
        for node in ast.parse(importing[0].read_text()).body
        if isinstance(node, ast.Import | ast.ImportFrom) and "matplotlib" in ast.unparse(node)
    ]
    assert at_the_top == []
