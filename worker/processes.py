"""Chunks from several computing processes, as they finish.

Each process has a pipe of its own and nobody else holds its ends, so that the death of either side, by SIGKILL too, is
seen by the other as the end of the pipe: no process is left behind.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

from threadstate.errors import ThreadstateError
from threadstate.library.identity import LibraryInputs
from worker.forkserver import running_forkserver
from worker.messages import Chunk, Failure, Ready

ASKED_AHEAD = 2
"""How many chunks a process is asked for at a time: it computes on while one waits to be written."""

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

    def ask(self, orientation: int) -> None:
        try:
            self.connection.send(orientation)
        except ConnectionError:
            raise self._died() from None

    def _died(self) -> ComputeError:
        self.process.join(_JOIN_TIMEOUT_S)
        return ComputeError(f"a computing process died (exit code {self.process.exitcode})")


class ComputingProcesses:
    """Processes that compute chunks of one library; made by :func:`computing_processes`."""

    def __init__(self, inputs: LibraryInputs, count: int) -> None:
        self._context = running_forkserver()
        self._inputs = inputs
        self._computers = [self._start() for _ in range(count)]

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[Chunk]:
        """The chunks of these orientations, in the order in which they are finished.

        Args:
            orientations: their numbers.
            on_ready: called once, when the first process has its kernels.

        Raises:
            ComputeError: a process failed or died.
        """
        waiting = iter(orientations)
        asked = dict.fromkeys((computer.connection for computer in self._computers), 0)
        by_connection = {computer.connection: computer for computer in self._computers}
        starting = set(by_connection)
        announced = False
        while starting or any(asked.values()):
            for connection in wait(list(by_connection)):
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
                    asked[connection] -= 1
                while asked[connection] < ASKED_AHEAD and (index := next(waiting, None)) is not None:
                    by_connection[connection].ask(index)
                    asked[connection] += 1
                if isinstance(message, Chunk):
                    yield message

    @property
    def process_ids(self) -> tuple[int, ...]:
        """The system's numbers of the processes."""
        return tuple(computer.process.pid for computer in self._computers if computer.process.pid is not None)

    def close(self) -> None:
        """End the processes; what they are computing is lost."""
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


def _compute(connection: Connection, inputs: LibraryInputs) -> None:
    # Imported in the computing process alone: the writing one does without numba, which is slow to load and to leave.
    from worker.compute import serve_chunks

    serve_chunks(connection, inputs)


@contextmanager
def computing_processes(inputs: LibraryInputs, count: int) -> Iterator[ComputingProcesses]:
    """``count`` computing processes, ended on leaving."""
    processes = ComputingProcesses(inputs, count)
    try:
        yield processes
    finally:
        processes.close()
