"""Dask clusters of processes of their own, as an operator would start them."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

TIMEOUT_S = 60.0
DASK = ["setpriv", "--pdeathsig", "KILL", sys.executable, "-m", "dask"]
"""It ends with this process, however that ends."""


class Cluster:
    """A scheduler and its workers on this machine; workers are processes of one thread without a nanny."""

    def __init__(self, folder: Path, environment: Mapping[str, str]) -> None:
        self._folder = folder
        self._environment = environment
        self._file = folder / "scheduler.json"
        self.workers: list[subprocess.Popen[bytes]] = []
        self.scheduler = self._start(
            "scheduler",
            *("--host", "127.0.0.1", "--port", "0", "--dashboard-address", "127.0.0.1:0"),
            *("--scheduler-file", str(self._file)),
        )
        end = time.monotonic() + TIMEOUT_S
        while not self._file.exists() or not self._file.read_text():
            assert time.monotonic() < end, (folder / "log").read_text()
            time.sleep(0.02)
        self.address: str = json.loads(self._file.read_text())["address"]

    def add_worker(self, **environment: str) -> subprocess.Popen[bytes]:
        """Start one more worker, which joins when it is ready."""
        options = [
            "--no-nanny",
            "--nthreads=1",
            "--memory-limit=0",
            "--dashboard-address=127.0.0.1:0",
            "--host=127.0.0.1",
        ]
        worker = self._start(
            "worker", self.address, *options, "--local-directory", str(self._folder), environment=environment
        )
        self.workers.append(worker)
        return worker

    def replace_dead_workers(self, count: int) -> None:
        """Have that many living workers again, and no others."""
        self.workers = [worker for worker in self.workers if worker.poll() is None]
        while len(self.workers) < count:
            self.add_worker()

    def close(self) -> None:
        """End all processes, whatever they are at."""
        for process in (*self.workers, self.scheduler):
            process.send_signal(signal.SIGKILL)
            process.wait(TIMEOUT_S)

    def _start(self, *arguments: str, environment: Mapping[str, str] | None = None) -> subprocess.Popen[bytes]:
        with (self._folder / "log").open("ab") as log:
            return subprocess.Popen(
                [*DASK, *arguments],
                cwd=self._folder,
                env={**self._environment, **(environment or {})},
                stdout=log,
                stderr=log,
            )


@contextmanager
def running_cluster(folder: Path, environment: Mapping[str, str], workers: int) -> Iterator[Cluster]:
    """A cluster of that many workers, gone on leaving."""
    cluster = Cluster(folder, environment)
    try:
        for _ in range(workers):
            cluster.add_worker()
        yield cluster
    finally:
        cluster.close()
