"""Builds the image, starts the composed containers and puts them to use: ``make containers`` (needs Docker).

A project, a port and volumes of its own, so that nothing that runs already is touched; all of it is removed at the end.
"""

from __future__ import annotations

import argparse
import json
import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from threadstate.client import Client
from threadstate.settings import SCHEDULER

ROOT = Path(__file__).parents[1]
PROJECT = "threadstate-trial"
STEPS = ("migrate", "first-library")
STAYING = ("database", "service", "worker")
CLUSTER = ("scheduler", "dask-worker")
LONGEST_S = 600.0
LOOK_S = 0.5
_LOOK_WITHIN = (
    'test "$(id -u)" -gt 0 && grep -q "^CapEff:.0*$" /proc/self/status && ! touch /written 2>/dev/null'
    ' && ! env | grep "PASSWORD=" && touch /tmp/written'
)
"""What holds in every container: no root, no capability, nothing to write to, no password in sight."""


@dataclass(frozen=True)
class Container:
    """What the engine says of one: ``health`` is empty where nobody looks."""

    service: str
    ended: bool
    health: str
    exit_code: int


class Composition:
    """The compose file under :data:`PROJECT`, its service at 127.0.0.1:``port``, its password in ``folder``."""

    def __init__(self, folder: Path, port: int) -> None:
        password = folder / "database_password"
        password.write_text("trial\n")
        password.chmod(0o444)
        changed = folder / "changed.yml"
        changed.write_text(
            f"secrets: {{database_password: {{file: {json.dumps(str(password))}}}}}\n"
            f'services: {{service: {{ports: !override ["127.0.0.1:{port}:8000"]}}}}\n'
        )
        self.address = f"http://127.0.0.1:{port}"
        files = ("--file", str(ROOT / "docker-compose.yml"), "--file", str(changed))
        where = ("--project-name", PROJECT, "--project-directory", str(ROOT))
        self._compose = ("docker", "compose", *where, *files)

    def up(self, *options: str, cluster: bool = False) -> None:
        """Start what is not running, with ``cluster`` the Dask cluster too, which the worker then fans out to."""
        profile = ("--profile", "dask") if cluster else ()
        self._run((*profile, "up", "--detach", *options), "tcp://scheduler:8786" if cluster else "")

    def run(self, *arguments: str) -> str:
        """``docker compose`` over all services with these arguments, and what it said."""
        return self._run(("--profile", "dask", *arguments), "")

    def _run(self, arguments: Sequence[str], scheduler: str) -> str:
        done = subprocess.run(
            (*self._compose, *arguments),
            env={**os.environ, SCHEDULER: scheduler},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
        if done.returncode:
            sys.exit(f"docker compose {' '.join(arguments)}: {done.stdout}{done.stderr}")
        return done.stdout

    def containers(self) -> list[Container]:
        """All, those that have ended too."""
        lines = self.run("ps", "--all", "--format", "json").splitlines()
        found = [json.loads(line) for line in lines]
        return [Container(one["Service"], one["State"] == "exited", one["Health"], one["ExitCode"]) for one in found]

    def settled(self, staying: Sequence[str]) -> bool:
        """Whether the steps have ended well and those services are healthy.

        Raises:
            SystemExit: a step has failed.
        """
        containers = self.containers()
        for one in containers:
            if one.service in STEPS and one.ended and one.exit_code:
                sys.exit(f"{one.service} ended with {one.exit_code}: {self.run('logs', one.service)}")
        ended = {one.service for one in containers if one.service in STEPS and one.ended}
        healthy = {one.service for one in containers if one.health == "healthy"}
        return ended == set(STEPS) and set(staying) <= healthy


def _wait(settled: Callable[[], bool]) -> None:
    begun = time.monotonic()
    while not settled():
        if time.monotonic() - begun > LONGEST_S:
            sys.exit(f"not so after {LONGEST_S:.0f} s")
        time.sleep(LOOK_S)


def _tell(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def _start(composition: Composition) -> None:
    begun = time.monotonic()
    composition.up()
    _wait(lambda: composition.settled(STAYING))
    _tell(f"up, its library published, every container healthy: {time.monotonic() - begun:.0f} s")
    for name in STAYING:
        composition.run("exec", "--no-TTY", name, "sh", "-c", _LOOK_WITHIN)
    _tell("no root, no capability, nothing to write to but /tmp, no password in an environment: " + ", ".join(STAYING))


def _key(composition: Composition) -> str:
    said = composition.run("exec", "--no-TTY", "worker", "threadstate", "key", "create", "--name", "trial")
    return next(word for word in said.split() if word.startswith("ts_"))


def _lose_a_worker(composition: Composition, client: Client) -> None:
    job = client.ask(grid={"phase_step": 5})
    _wait(lambda: job.refresh().committed > 0)
    composition.run("exec", "--no-TTY", "worker", "sh", "-c", "kill -9 -1 || true")
    lost_at = job.refresh().committed
    job.wait(timeout_s=LONGEST_S)
    _tell(f"worker killed after {lost_at} of {job.document.chunks} chunks, started again, job done")


def _use_the_cluster(composition: Composition, client: Client) -> None:
    composition.up("--scale", "dask-worker=2", cluster=True)
    _wait(lambda: composition.settled((*STAYING, *CLUSTER)))
    for name in CLUSTER:
        composition.run("exec", "--no-TTY", name, "sh", "-c", _LOOK_WITHIN)
    job = client.ask(grid={"phase_step": 7.5})
    job.wait(timeout_s=LONGEST_S)
    _tell(f"{job.document.chunks} chunks computed by the workers of a Dask cluster")


def _stop_and_go_on(composition: Composition, client: Client) -> None:
    before = [one.content_sha256 for one in client.libraries().libraries]
    begun = time.monotonic()
    composition.run("stop")
    took_s = time.monotonic() - begun
    failed = [one for one in composition.containers() if one.exit_code]
    if failed:
        sys.exit(f"did not end with 0: {failed}")
    _tell(f"stopped in {took_s:.1f} s, each with 0")
    composition.up()
    _wait(lambda: composition.settled(STAYING))
    if [one.content_sha256 for one in client.libraries().libraries] != before:
        sys.exit("other libraries than before")
    _tell(f"up again with the same {len(before)} libraries")


@contextmanager
def _composition() -> Iterator[Composition]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with tempfile.TemporaryDirectory() as folder:
        composition = Composition(Path(folder), port)
        try:
            yield composition
        finally:
            composition.run("down", "--volumes")


def main() -> None:
    """Build, start, use, stop, remove."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    with _composition() as composition:
        composition.run("build")
        _tell("image built")
        _start(composition)
        with Client(composition.address, key=_key(composition)) as client:
            _lose_a_worker(composition, client)
            _use_the_cluster(composition, client)
            _stop_and_go_on(composition, client)


if __name__ == "__main__":
    main()
