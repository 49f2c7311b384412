"""The client where nothing but its own dependencies is installed, and what is said there of everything else."""

from __future__ import annotations

import subprocess
import sys
import venv
from collections.abc import Iterator
from importlib.metadata import Distribution, distribution
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from threadstate.errors import MissingExtraError
from threadstate.library.engine import reader_engine
from worker.serving import exec_service

ASK = """
import sys
from threadstate.client import Client

with Client(sys.argv[1]) as client:
    state = client.state(1.0, 0.0, 30.0, library=1)
print(state.roll, state.phase)
"""


def _with_dependencies(requirements: list[str]) -> Iterator[Distribution]:
    """The installed distributions that requirements name, without extras, and those that these need in turn."""
    wait, seen = [*requirements], set[str]()
    while wait:
        requirement = Requirement(wait.pop())
        name = canonicalize_name(requirement.name)
        if name in seen or (requirement.marker and not requirement.marker.evaluate({"extra": ""})):
            continue
        seen.add(name)
        found = distribution(name)
        yield found
        wait += found.requires or []


@pytest.fixture(scope="module")
def python(tmp_path_factory: pytest.TempPathFactory, repository_root: Path) -> Path:
    """An interpreter with the project's wheel, unpacked, and links to what its metadata requires without extras."""
    folder = tmp_path_factory.mktemp("client")
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=repository_root, check=True, capture_output=True)
    (wheel,) = folder.glob("*.whl")
    venv.create(folder / "venv", symlinks=True)
    (packages,) = (folder / "venv" / "lib").glob("python*/site-packages")
    subprocess.run([sys.executable, "-m", "zipfile", "-e", str(wheel), str(packages)], check=True)
    (metadata,) = packages.glob("*.dist-info")
    for found in _with_dependencies(Distribution.at(metadata).requires or []):
        for name in {path.parts[0] for path in found.files or () if path.parts[0] not in ("..", "__pycache__")}:
            (packages / name).symlink_to(Path(str(found.locate_file(name))))
    return folder / "venv" / "bin" / "python"


def _run(python: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([python, "-I", *arguments], cwd=python.parent, capture_output=True, text=True, check=False)


def test_a_state_is_fetched_with_the_client_alone(python: Path, address: str) -> None:
    run = _run(python, "-c", ASK, address)
    assert run.stderr == ""
    assert run.stdout.split() == ["1.0", "30.0"]


@pytest.mark.parametrize("missing", ["numba", "numpy", "scipy", "fcl", "matplotlib", "sqlalchemy", "psycopg"])
def test_what_computes_or_stores_is_not_there(python: Path, missing: str) -> None:
    assert f"No module named '{missing}'" in _run(python, "-c", f"import {missing}").stderr


def test_a_wheel_holds_what_runs_and_nothing_of_the_development(python: Path) -> None:
    (packages,) = (python.parent.parent / "lib").glob("python*/site-packages")
    ours = {path.name for path in packages.iterdir() if not path.is_symlink() and path.suffix != ".dist-info"} - {
        "__pycache__"
    }
    assert ours == {"threadstate", "worker", "service", "migrations"}


def test_the_command_line_says_which_extra_it_needs(python: Path) -> None:
    run = _run(python, "-c", "from worker.command import main; main()", "--help")
    assert run.returncode == 1
    assert run.stderr.startswith("threadstate: the command line needs the extra `service`: pip install '.[service]'")
    assert len(run.stderr.splitlines()) == 1


def test_importing_the_client_loads_no_numpy() -> None:
    code = "import sys, threadstate.client; print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    loaded = {name.partition(".")[0] for name in run.stdout.split()}
    assert "httpx2" in loaded
    assert not loaded & {"numpy", "numba", "sqlalchemy", "pandas"}


def test_a_driver_that_is_not_installed_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "psycopg", None)
    with pytest.raises(MissingExtraError, match=r"pip install '\.\[postgresql\]'"):
        reader_engine("postgresql://user@host/name")


def test_a_service_that_is_not_installed_is_named_with_its_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "uvicorn", None)
    with pytest.raises(MissingExtraError, match=r"pip install '\.\[service\]'"):
        exec_service("sqlite:///nothing", "127.0.0.1", 0)
