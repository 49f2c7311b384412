"""What is handed out besides the code: the compose file, the make targets, the entry point."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from importlib.metadata import entry_points
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
