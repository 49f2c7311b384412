"""What the compose file and the image promise, as far as it can be seen without starting them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml

from scripts import try_containers
from threadstate import settings
from worker.cli import command_group

OURS = ("migrate", "first-library", "service", "worker", "scheduler", "dask-worker")
STEPS = ("migrate", "first-library")
"""They end when they are done."""


def _compose(repository_root: Path) -> dict[str, Any]:
    loaded: dict[str, Any] = yaml.safe_load((repository_root / "docker-compose.yml").read_text())
    return loaded


@pytest.fixture(scope="module")
def services(repository_root: Path) -> dict[str, dict[str, Any]]:
    """The services by their names, with what they share written out."""
    found: dict[str, dict[str, Any]] = _compose(repository_root)["services"]
    return found


def _dockerfile(repository_root: Path) -> str:
    return (repository_root / "Dockerfile").read_text()


def _pins(path: Path) -> dict[tuple[str, str], frozenset[str]]:
    """The hashes of every (name==version, marker) of a lock file."""
    pins = {}
    for requirement in path.read_text().replace("\\\n", " ").splitlines():
        pinned, _, rest = requirement.partition(" --hash=")
        name, _, marker = pinned.partition(";")
        pins[name.strip(), marker.strip()] = frozenset(f"--hash={rest}".split())
    return pins


def test_the_services_are_these(services: dict[str, dict[str, Any]]) -> None:
    assert sorted(services) == sorted((*OURS, "database"))
    assert {name for name, one in services.items() if one.get("profiles") == ["dask"]} == {"scheduler", "dask-worker"}


def test_the_trial_knows_every_service(services: dict[str, dict[str, Any]]) -> None:
    assert sorted((*try_containers.STEPS, *try_containers.STAYING, *try_containers.CLUSTER)) == sorted(services)
    assert {name for name, one in services.items() if "profiles" in one} == set(try_containers.CLUSTER)


def test_every_service_is_hardened(services: dict[str, dict[str, Any]]) -> None:
    for name, one in services.items():
        assert one["read_only"] is True, name
        assert one["cap_drop"] == ["ALL"], name
        assert "cap_add" not in one, name
        assert "privileged" not in one, name
        assert one["security_opt"] == ["no-new-privileges:true"], name
        user, group = one["user"].split(":")
        assert int(user) > 0, name
        assert int(group) > 0, name
        assert any(mount.split(":")[0] == "/tmp" for mount in one["tmpfs"]), name
        assert all("docker.sock" not in mount for mount in one.get("volumes", [])), name


def test_every_service_that_stays_is_watched_and_restarted(services: dict[str, dict[str, Any]]) -> None:
    for name, one in services.items():
        if name in STEPS:
            assert one["healthcheck"] == {"disable": True}, name
            assert one["restart"] in ("no", "on-failure:5"), name
        else:
            # That of the service is the image's.
            assert name == "service" or one["healthcheck"]["test"][0] in ("CMD", "CMD-SHELL"), name
            assert one["restart"] == "unless-stopped", name
            assert re.fullmatch(r"\d+[ms]", one["stop_grace_period"]), name


def test_nothing_starts_before_what_it_needs(services: dict[str, dict[str, Any]]) -> None:
    needs = {name: one.get("depends_on", {}) for name, one in services.items()}
    migrated = {"migrate": {"condition": "service_completed_successfully"}}
    assert needs == {
        "database": {},
        "migrate": {"database": {"condition": "service_healthy"}},
        "first-library": migrated,
        "service": migrated,
        "worker": migrated,
        "scheduler": {},
        "dask-worker": {"scheduler": {"condition": "service_healthy"}},
    }


def test_the_service_alone_can_be_reached_and_from_this_machine_alone(
    repository_root: Path, services: dict[str, dict[str, Any]]
) -> None:
    assert {name: one["ports"] for name, one in services.items() if "ports" in one} == {
        "service": ["127.0.0.1:8000:8000"]
    }
    networks = _compose(repository_root)["networks"]
    outward = {name for name, network in networks.items() if not network.get("internal")}
    assert {name for name, one in services.items() if outward & set(one["networks"])} == {"service"}
    # A Dask worker computes; it neither reaches the database nor knows its password.
    for name in ("scheduler", "dask-worker"):
        assert services[name]["networks"] == ["dask"]
        assert "secrets" not in services[name]


@pytest.mark.slow
def test_every_command_is_one_of_the_command_line(services: dict[str, dict[str, Any]], repository_root: Path) -> None:
    in_image = re.findall(r'^CMD \["threadstate", "([^"]+)"\]$', _dockerfile(repository_root), re.MULTILINE)
    assert in_image == ["run"]
    for name in OURS:
        program, command, *options = services[name]["command"]
        if program == "threadstate":
            known = {option for one in command_group().commands[command].params for option in one.opts}
        else:
            assert program == "dask"
            run = [sys.executable, "-m", program, command, "--help"]
            help_text = subprocess.run(run, check=True, capture_output=True, text=True).stdout
            known = set(re.findall(r"--[a-z-]+", help_text))
        given = {option.partition("=")[0] for option in options if option.startswith("-")}
        assert given <= known, name


def test_every_setting_is_one_that_there_is(services: dict[str, dict[str, Any]], repository_root: Path) -> None:
    given = {name for one in services.values() for name in one.get("environment", {}) if name.startswith("THREAD")}
    in_image = set(re.findall(r"(THREADSTATE_\w+)=", _dockerfile(repository_root)))
    assert given
    assert in_image
    assert given | in_image <= set(settings.NAMES)


def test_no_password_is_in_the_file_or_in_an_environment(
    services: dict[str, dict[str, Any]], repository_root: Path
) -> None:
    compose = _compose(repository_root)
    assert compose["secrets"] == {"database_password": {"file": "./secrets/database_password"}}
    assert "/secrets/" in (repository_root / ".gitignore").read_text().splitlines()
    for one in services.values():
        for name, value in one.get("environment", {}).items():
            assert "PASSWORD" not in name or (name.endswith("_FILE") and value == "/run/secrets/database_password")
            assert not re.search(r"://[^/@]*:[^/@]*@", value)


def test_images_are_pinned(services: dict[str, dict[str, Any]], repository_root: Path) -> None:
    named = {one["image"] for one in services.values()}
    named |= set(re.findall(r"^FROM (\S+)", _dockerfile(repository_root), re.MULTILINE))
    assert named == {"threadstate:local", "postgres:18-bookworm", "python:3.11-slim-bookworm"}


def test_the_image_has_what_runs_and_nothing_that_builds(repository_root: Path) -> None:
    _, build, final = re.split(r"^FROM ", _dockerfile(repository_root), flags=re.MULTILINE)
    assert "requirements-runtime.lock" in build
    assert re.findall(r"^COPY .*$", final, re.MULTILINE) == ["COPY --from=build /opt/threadstate /opt/threadstate"]
    assert re.search(r"^USER 1000:1000$", final, re.MULTILINE)
    assert re.search(r"^HEALTHCHECK ", final, re.MULTILINE)
    for name in ("node", "npm", "hatchling", "pytest"):
        assert name not in final


def test_the_runtime_lock_agrees_with_the_lock_of_the_tests(repository_root: Path) -> None:
    everything = _pins(repository_root / "requirements.lock")
    for name in ("requirements-runtime.lock", "requirements-build.lock"):
        pins = _pins(repository_root / name)
        assert pins
        # Markers differ: what an extra needs everywhere, a dependency of a tool may need on one system alone.
        by_name = {pinned: hashes for (pinned, _), hashes in everything.items()}
        assert {pinned: hashes for (pinned, _), hashes in pins.items()}.items() <= by_name.items()


def test_the_runtime_lock_is_without_tools(repository_root: Path) -> None:
    names = {pinned.partition("==")[0] for pinned, _ in _pins(repository_root / "requirements-runtime.lock")}
    assert {"threadstate", "pytest", "ruff", "mypy", "hatchling", "selenium"} & names == set()
    assert {"distributed", "numba", "psycopg", "pyarrow", "uvicorn"} <= names
