"""What is handed out besides the code: the compose file, the make targets, the entry point."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tomllib
from importlib.metadata import entry_points, packages_distributions
from pathlib import Path


def test_compose_file_is_valid(repository_root: Path) -> None:
    commands = [
        [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.compose-spec", "docker-compose.yml"]
    ]
    compose = ["docker", "compose"]
    if (
        shutil.which(compose[0])
        and subprocess.run([*compose, "version"], check=False, capture_output=True).returncode == 0
    ):
        commands.append([*compose, "--profile", "dask", "config", "--quiet"])
    for command in commands:
        run = subprocess.run(command, cwd=repository_root, check=False, capture_output=True, text=True)
        assert run.returncode == 0, run.stdout + run.stderr


def test_every_file_that_the_image_copies_is_let_through_and_there(repository_root: Path) -> None:
    let_through = {
        line[1:] for line in (repository_root / ".dockerignore").read_text().splitlines() if line.startswith("!")
    }
    copied = {
        name
        for names in re.findall(
            r"^COPY (?!--from)(.+) \S+$", (repository_root / "Dockerfile").read_text(), re.MULTILINE
        )
        for name in names.split()
    }
    assert copied == let_through
    assert all((repository_root / name).exists() for name in copied)


def test_readme_opens_with_targets_that_exist(repository_root: Path) -> None:
    promised = re.findall(r"^make (\w+)", (repository_root / "README.md").read_text(), re.MULTILINE)
    targets = re.findall(r"^(\w+):", (repository_root / "Makefile").read_text(), re.MULTILINE)
    assert {"run", "test", "setup"} <= set(promised) <= set(targets)


def test_command_is_installed() -> None:
    (command,) = (one for one in entry_points(group="console_scripts") if one.name == "threadstate")
    assert command.value == "worker.command:main"
    assert callable(command.load())


def test_every_dependency_is_imported(repository_root: Path) -> None:
    """Or named as a driver in the address of a database, which loads it."""
    project = tomllib.loads((repository_root / "pyproject.toml").read_text())["project"]
    names = [re.match(r"[A-Za-z0-9-]+", one) for one in project["dependencies"]]
    modules = {name: set[str]() for name in (one[0] for one in names if one)}
    for module, distributions in packages_distributions().items():
        for distribution in {one.lower().replace("_", "-") for one in distributions} & modules.keys():
            modules[distribution].add(module)
    rooms = ("threadstate", "worker", "service", "migrations")
    sources = "\n".join(path.read_text() for room in rooms for path in (repository_root / room).rglob("*.py"))
    used = set(re.findall(r"^\s*(?:import|from) (\w+)|postgresql\+(\w+)", sources, re.M))
    imported = {name for pair in used for name in pair if name}
    assert [name for name, tops in modules.items() if not tops & imported] == []
