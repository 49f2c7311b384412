"""What fails in a process that computes is told with its reason, whatever kind of error it is."""

from __future__ import annotations

from collections.abc import Callable
from multiprocessing import Pipe
from typing import Any

import pytest

from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.cluster.chunks import ComputingCluster
from worker.cluster.errors import ClusterError
from worker.compute import serve_chunks
from worker.messages import Chunk, Failure, Ready
from worker.processes import ComputeError

pytestmark = pytest.mark.sqlite_alone

INPUTS = LibraryInputs(quarter_twenty_unc(), Grid(0.0, 1.0, 180.0), SolveOptions())


@pytest.mark.parametrize("error", [EOFError("ran out of input"), ConnectionResetError("by peer"), KeyError("x")])
def test_a_process_tells_what_fails_in_it(error: Exception, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object) -> Chunk:
        raise error

    monkeypatch.setattr("worker.compute.compute_chunk", failing)
    monkeypatch.setattr("worker.compute.signal.signal", lambda *_: None)
    ours, theirs = Pipe()
    ours.send(0)
    serve_chunks(theirs, INPUTS)
    theirs.close()
    assert ours.recv() == Ready()
    assert ours.recv() == Failure(f"{type(error).__name__}: {error}")


class _Future:
    """A chunk's that has failed."""

    def __init__(self, error: Exception, status: str) -> None:
        self.status = status
        self._error = error

    def add_done_callback(self, tell: Callable[[object], None]) -> None:
        tell(self)

    def result(self) -> Chunk:
        raise self._error


class _Client:
    """Of a cluster of one thread, where everything fails."""

    def __init__(self, future: _Future) -> None:
        self._future = future

    def nthreads(self) -> dict[str, int]:
        return {"one": 1}

    def submit(self, *_: object, **__: object) -> _Future:
        return self._future


@pytest.mark.parametrize(
    ("status", "expected", "message"),
    [
        ("error", ComputeError, "a Dask worker failed: PermissionError: .*Permission denied"),
        ("cancelled", ClusterError, "the Dask scheduler tcp://one:1 is gone"),
    ],
)
def test_an_error_of_a_dask_worker_is_not_the_schedulers_end(
    status: str, expected: type[Exception], message: str
) -> None:
    client: Any = _Client(_Future(PermissionError(13, "Permission denied"), status))
    with pytest.raises(expected, match=message):
        next(ComputingCluster(INPUTS, "tcp://one:1", client).chunks([0], lambda: None))
