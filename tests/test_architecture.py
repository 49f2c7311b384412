"""Rules of the architecture that no linter knows; which room may import which is in ``pyproject.toml``."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOMS = ("threadstate", "worker", "service", "migrations")

# In two parts each, so that this file does not name them either.
REGISTRY_HOSTS = tuple(
    ".".join(parts)
    for parts in (
        ("pypi", "org"),
        ("pythonhosted", "org"),
        ("npmjs", "org"),
        ("npmjs", "com"),
        ("yarnpkg", "com"),
        ("docker", "io"),
        ("ghcr", "io"),
        ("jsdelivr", "net"),
        ("unpkg", "com"),
    )
)


@pytest.fixture(scope="session")
def tracked_files(repository_root: Path) -> list[Path]:
    """Every file under version control that is still there."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=repository_root, check=True, capture_output=True, text=True)
    return [repository_root / name for name in listed.stdout.split("\0") if name and (repository_root / name).is_file()]


def modules_loaded_by(code: str) -> set[str]:
    """Names of all modules in a fresh process after ``code``."""
    report = f"{code}; import sys; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", report], check=True, capture_output=True, text=True)
    return set(run.stdout.split())


def test_service_loads_no_mesh_library_and_no_worker() -> None:
    loaded = modules_loaded_by("import service.app")
    assert "service.states.endpoints" in loaded
    assert not {name for name in loaded if name.partition(".")[0] in ("fcl", "trimesh", "worker", "migrations")}


def test_network_loads_no_solver_and_no_database(repository_root: Path) -> None:
    modules = sorted(path.stem for path in (repository_root / "threadstate" / "network").glob("[!_]*.py"))
    loaded = modules_loaded_by(f"from threadstate.network import {', '.join(modules)}")
    assert {f"threadstate.network.{name}" for name in modules} <= loaded
    assert not {name for name in loaded if name.partition(".")[0] in ("numba", "sqlalchemy", "fastapi", "pydantic")}


def test_computing_processes_load_no_database() -> None:
    loaded = modules_loaded_by("import worker.compute, threadstate.warm_up")
    assert {"threadstate.library.rows", "numba"} <= loaded
    assert not {name for name in loaded if name.partition(".")[0] in ("sqlalchemy", "psycopg", "fastapi")}


def test_plots_load_matplotlib_only_when_they_are_drawn() -> None:
    loaded = modules_loaded_by("import worker.plots")
    assert not {name for name in loaded if name.partition(".")[0] == "matplotlib"}


def test_what_is_loaded_late_is_there_to_be_loaded() -> None:
    assert {"fcl", "trimesh", "matplotlib"} <= modules_loaded_by("import fcl, trimesh, matplotlib")


def test_no_tracked_file_names_a_package_registry(tracked_files: list[Path], repository_root: Path) -> None:
    naming = [
        f"{path.relative_to(repository_root)} names {host}"
        for path in tracked_files
        for host in REGISTRY_HOSTS
        if host.encode() in path.read_bytes()
    ]
    assert naming == []


def test_lock_files_pin_by_hash_and_hold_no_address(repository_root: Path) -> None:
    for name in sorted(path.name for path in repository_root.glob("requirements*.lock")):
        text = (repository_root / name).read_text()
        assert "://" not in text
        assert "--index-url" not in text
        for requirement in text.replace("\\\n", " ").splitlines():
            assert "==" in requirement, requirement
            assert "--hash=sha256:" in requirement, requirement
    packages = json.loads((repository_root / "package-lock.json").read_text())["packages"]
    assert len(packages) > 1
    for name, package in packages.items():
        assert "resolved" not in package
        assert name == "" or package["integrity"].startswith("sha512-")


def undocumented(path: Path) -> Iterator[str]:
    """The module, and its public classes, functions and methods, that have no docstring."""
    tree = ast.parse(path.read_text())
    if ast.get_docstring(tree) is None:
        yield f"{path}"
    nodes = [("", node) for node in tree.body]
    while nodes:
        prefix, node = nodes.pop()
        if isinstance(node, ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) and not node.name.startswith("_"):
            if ast.get_docstring(node) is None:
                yield f"{path}: {prefix}{node.name}"
            if isinstance(node, ast.ClassDef):
                nodes += [(f"{node.name}.", inner) for inner in node.body]


def test_everything_public_is_documented(repository_root: Path) -> None:
    files = [path for room in ROOMS for path in (repository_root / room).rglob("*.py")]
    assert len(files) > 40
    assert [name for path in files for name in undocumented(path)] == []
