"""Computing processes: chunks of a library from several of them, as they finish.

Each process has a pipe of its own whose ends nobody else holds, so that the death of either side, by SIGKILL too, is
seen by the other as the end of the pipe: no process is left behind. All processes are forked from a forkserver, a clean
process with the kernels loaded.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import get_args

from threadstate.errors import ThreadstateError
from worker.forkserver import running_forkserver
from worker.interruption import waiting
from worker.messages import Chunk, ChunkInputs, Failure, Ready

QUEUED_PER_PROCESS = 2
"""Chunks queued per process, so that it computes while a chunk waits to be written."""

_JOIN_TIMEOUT_S = 5.0


class ComputeError(ThreadstateError):
    """A computing process failed."""


@dataclass(frozen=True)
class _Computer:
    process: BaseProcess
    connection: Connection

    def receive(self) -> object:
        try:
            return self.connection.recv()
        except (EOFError, ConnectionError):
            raise self._died() from None

    def submit(self, orientation: int) -> None:
        try:
            self.connection.send(orientation)
        except ConnectionError:
            raise self._died() from None

    def _died(self) -> ComputeError:
        self.process.join(_JOIN_TIMEOUT_S)
        return ComputeError(f"a computing process died (exit code {self.process.exitcode})")


class ComputingProcesses:
    """Processes that compute chunks of one job; made by :func:`computing_processes`."""

    def __init__(self, inputs: ChunkInputs, count: int) -> None:
        self._context = running_forkserver()
        self._inputs = inputs
        self._computers = [self._start() for _ in range(count)]

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[Chunk]:
        """The chunks of these orientations, in the order in which they are finished.

        Args:
            orientations: their numbers.
            on_ready: called once, when the first process has loaded its kernels.

        Raises:
            ComputeError: a process failed or died.
        """
        remaining = iter(orientations)
        queued = dict.fromkeys((computer.connection for computer in self._computers), 0)
        by_connection = {computer.connection: computer for computer in self._computers}
        starting = set(by_connection)
        announced = False
        while starting or any(queued.values()):
            with waiting():
                ready = wait(list(by_connection))
            for connection in ready:
                assert isinstance(connection, Connection)
                message = by_connection[connection].receive()
                if isinstance(message, Failure):
                    raise ComputeError(f"a computing process failed: {message.reason}")
                if isinstance(message, Ready):
                    starting.remove(connection)
                    if not announced:
                        announced = True
                        on_ready()
                else:
                    queued[connection] -= 1
                while queued[connection] < QUEUED_PER_PROCESS and (index := next(remaining, None)) is not None:
                    by_connection[connection].submit(index)
                    queued[connection] += 1
                if isinstance(message, get_args(Chunk)):
                    yield message

    @property
    def process_ids(self) -> tuple[int, ...]:
        """The process ids."""
        return tuple(computer.process.pid for computer in self._computers if computer.process.pid is not None)

    def close(self) -> None:
        """Terminate the processes; chunks in progress are lost."""
        for computer in self._computers:
            computer.connection.close()
        for computer in self._computers:
            computer.process.terminate()
            computer.process.join(_JOIN_TIMEOUT_S)

    def _start(self) -> _Computer:
        ours, theirs = self._context.Pipe()
        process = self._context.Process(target=_compute, args=(theirs, self._inputs), daemon=True)
        process.start()
        theirs.close()
        return _Computer(process, ours)


def _compute(connection: Connection, inputs: ChunkInputs) -> None:
    # Imported in the computing process alone: the writing one does not need numba, which is slow to load.
    from worker.compute import serve_chunks

    serve_chunks(connection, inputs)


@contextmanager
def computing_processes(inputs: ChunkInputs, count: int) -> Iterator[ComputingProcesses]:
    """``count`` processes that compute chunks, ended on leaving."""
    processes = ComputingProcesses(inputs, count)
    try:
        yield processes
    finally:
        processes.close()
