"""The servers that are measured, each its own process, and a rebuild that disturbs them."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from benchmarks.load.wrk import LoadError
from threadstate.settings import CACHE_MB, DATA_DIR, DATABASE, PORT

LONGEST_START_S = 120.0
NOTHING_CACHED = {CACHE_MB: "0"}
_CLI = (sys.executable, "-c", "from worker.cli import main; main()")


def prepare(folder: Path, library: Path | None) -> str:
    """The URL of a database in that folder with the library of ``threadstate rebuild``: a copy, or computed."""
    path = folder / "threadstate.sqlite3"
    if library is not None:
        shutil.copy(library, path)
    database = f"sqlite:///{path}"
    subprocess.run([*_CLI, "rebuild", "--database", database], check=True, stdout=subprocess.DEVNULL)
    return database


@contextmanager
def threadstate_service(folder: Path, database: str, settings: Mapping[str, str]) -> Iterator[str]:
    """The address of one process of the service."""
    port = _free_port()
    environment = {**os.environ, DATA_DIR: str(folder), DATABASE: database, PORT: str(port), **settings}
    with _server([sys.executable, "-m", "service"], environment, port, "/readyz") as address:
        yield address


@contextmanager
def datasette(python: Path, database: str) -> Iterator[str]:
    """The address of one process of Datasette, over the same file."""
    port = _free_port()
    command = [str(python), "-m", "datasette", database.removeprefix("sqlite:///"), "--port", str(port)]
    with _server(
        [*command, "--setting", "sql_time_limit_ms", "30000"], os.environ, port, "/-/versions.json"
    ) as address:
        yield address


@contextmanager
def rebuilding(database: str) -> Iterator[None]:
    """While a finer library is computed into the same database; it is not published."""
    command = [*_CLI, "rebuild", "--database", database, "--phase-step", "0.1"]
    with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
        try:
            time.sleep(5.0)  # until it computes
            yield
            if process.poll() is not None:
                raise LoadError(f"the rebuild ended meanwhile, with {process.returncode}")
        finally:
            process.terminate()


def wait_until_prepared(address: str) -> None:
    """Wait until the service has done what is slow the first time.

    Raises:
        LoadError: it does not.
    """
    until = time.monotonic() + LONGEST_START_S
    while "threadstate_prepared 1.0" not in _text(address + "/metrics"):
        if time.monotonic() > until:
            raise LoadError("the service was not prepared")
        time.sleep(0.5)


def _text(address: str) -> str:
    with urllib.request.urlopen(address, timeout=60.0) as answer:
        return str(answer.read(), "utf-8")


@contextmanager
def _server(command: list[str], environment: Mapping[str, str], port: int, ready: str) -> Iterator[str]:
    address = f"http://127.0.0.1:{port}"
    with (
        tempfile.TemporaryFile() as said,
        subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=said) as process,
    ):
        try:
            until = time.monotonic() + LONGEST_START_S
            while not _answers(address + ready):
                if process.poll() is not None or time.monotonic() > until:
                    said.seek(0)
                    raise LoadError(said.read().decode(errors="replace"))
                time.sleep(0.1)
            yield address
        finally:
            process.terminate()


def _answers(address: str) -> bool:
    try:
        with urllib.request.urlopen(address, timeout=5.0):
            return True
    except (urllib.error.URLError, ConnectionError, TimeoutError):
        return False


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
