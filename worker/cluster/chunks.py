"""Chunks from the workers of a Dask cluster, as they finish.

The scheduler holds no state of its own: the missing chunks are in the database, and each chunk is written there as soon
as it arrives. Only as many are submitted as the workers can have queued, so that neither the scheduler's nor the
workers' memory grows with the library.
"""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from queue import Empty, SimpleQueue
from typing import TYPE_CHECKING

from threadstate.chances.model import Record
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.settled.rows import SettledRows
from threadstate.success.model import OrientationMap
from worker.cluster.errors import ClusterError, VersionSkewError
from worker.cluster.versions import own_versions
from worker.interruption import waiting
from worker.messages import Chunk, ChunkInputs, LibraryChunk
from worker.output import print_status
from worker.processes import QUEUED_PER_PROCESS, ComputeError

if TYPE_CHECKING:
    from distributed import Client, Future

CONNECT_TIMEOUT_S = 10
NO_WORKER_TIMEOUT_S = 60.0
"""How long a cluster may have no worker."""
LOOK_EVERY_S = 1.0
"""How often the number of threads is read."""
SCHEMES = ("tcp://", "tls://")
VALID_ADDRESS = "the address of a Dask scheduler, such as tcp://host:8786 or tls://host:8786"


class ComputingCluster:
    """The workers of a cluster that compute chunks of one job; made by :func:`computing_cluster`."""

    def __init__(self, inputs: ChunkInputs, address: str, client: Client) -> None:
        self._inputs = inputs
        self._address = address
        self._client = client
        self._submitted: set[Future[Chunk]] = set()
        self._done: SimpleQueue[Future[Chunk]] = SimpleQueue()
        self._room = 0
        self._threads_read_s = 0.0
        self._worker_seen_s = time.monotonic()

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[Chunk]:
        """The chunks of these orientations, in the order in which they are finished.

        Chunks of a worker that dies are computed by others.

        Args:
            orientations: their numbers, each taken when there is a worker for it.
            on_ready: called once, when the first chunk has arrived.

        Raises:
            ComputeError: a chunk failed, or killed one worker after another.
            ClusterError: the scheduler is unreachable, the cluster has no worker for a minute, or one has another
                version.
        """
        remaining = iter(orientations)
        announced = False
        while self._submit(remaining) or self._submitted:
            try:
                with waiting():
                    future = self._done.get(timeout=LOOK_EVERY_S)
            except Empty:
                continue
            chunk = self._result(future)
            self._submitted.remove(future)
            if not announced:
                announced = True
                on_ready()
            yield chunk

    def close(self) -> None:
        """Submit no more; chunks in progress are discarded."""
        self._submitted.clear()

    def _submit(self, remaining: Iterator[int]) -> bool:
        """Submit as many chunks as the workers can queue.

        Returns:
            Whether orientations may remain.
        """
        from worker.cluster.remote import remote_chunk

        self._read_threads()
        while len(self._submitted) < self._room:
            index = next(remaining, None)
            if index is None:
                return False
            future = self._client.submit(remote_chunk, self._inputs, index, own_versions(), pure=False)
            self._submitted.add(future)
            future.add_done_callback(self._done.put)
        return True

    def _read_threads(self) -> None:
        """Read the number of threads from time to time, as workers join and leave."""
        now_s = time.monotonic()
        if self._room and now_s - self._threads_read_s < LOOK_EVERY_S:
            return
        try:
            threads = sum(self._client.nthreads().values())
        except (OSError, TimeoutError) as error:
            raise self._unreachable(error) from None
        self._threads_read_s = now_s
        self._room = QUEUED_PER_PROCESS * threads
        if threads:
            self._worker_seen_s = now_s
        elif now_s - self._worker_seen_s > NO_WORKER_TIMEOUT_S:
            raise ClusterError(
                f"the Dask scheduler {self._address} has had no worker for {number_text(NO_WORKER_TIMEOUT_S)} s"
            )

    def _result(self, future: Future[Chunk]) -> Chunk:
        from distributed import CancelledError, KilledWorker

        try:
            chunk = future.result()
        except VersionSkewError as error:
            raise _skewed(str(error)) from None
        except KilledWorker as error:
            raise ComputeError(f"one Dask worker after another died of a chunk: {error}") from None
        except Exception as error:
            # A worker may raise anything, also an OSError; other errors are those of the connection.
            if future.status != "error" and isinstance(error, (CancelledError, OSError, TimeoutError)):
                raise self._unreachable(error) from None
            raise ComputeError(f"a Dask worker failed: {type(error).__name__}: {error}") from None
        assert isinstance(chunk, LibraryChunk | SettledRows | OrientationMap | Record)
        return chunk

    def _unreachable(self, error: BaseException) -> ClusterError:
        return ClusterError(f"the Dask scheduler {self._address} is gone ({type(error).__name__})")


@contextmanager
def computing_cluster(inputs: ChunkInputs, address: str) -> Iterator[ComputingCluster]:
    """The cluster of the scheduler at ``address``, after a check that its workers have this version.

    Raises:
        InvalidValueError: it is not the address of a scheduler.
        ClusterError: Dask is not installed, no scheduler answers, or a worker has another version.
    """
    with _connected(address) as client:
        _check_versions(client, address)
        cluster = ComputingCluster(inputs, address, client)
        try:
            yield cluster
        finally:
            cluster.close()


def cluster_threads(address: str) -> int:
    """The number of threads of a cluster's workers.

    Raises:
        InvalidValueError: it is not the address of a scheduler.
        ClusterError: as for :func:`computing_cluster`, or the cluster has no worker.
    """
    with _connected(address) as client:
        threads: int = sum(client.nthreads().values())
    if not threads:
        raise ClusterError(f"the Dask scheduler {address} has no worker")
    return threads


@contextmanager
def _connected(address: str) -> Iterator[Client]:
    if not address.startswith(SCHEMES):
        raise InvalidValueError("scheduler", address, VALID_ADDRESS)
    try:
        from distributed import Client
    except ImportError:
        raise ClusterError(
            "a scheduler needs Dask, which is not installed: pip install '.[dask]' in a checkout"
        ) from None

    # Failures are reported by errors of our own; Dask's log would repeat them in many lines.
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = Client(address, timeout=CONNECT_TIMEOUT_S, set_as_default=False, name="threadstate")
    except ValueError:
        raise InvalidValueError("scheduler", address, VALID_ADDRESS) from None
    except (OSError, TimeoutError):
        raise ClusterError(f"no Dask scheduler answers at {address}") from None
    try:
        yield client
    finally:
        client.close()


def _check_versions(client: Client, address: str) -> None:
    from worker.cluster.remote import require_versions

    answers = client.run(require_versions, own_versions(), on_error="return")
    if not answers:
        print_status(f"the Dask scheduler {address} has no worker yet; waiting for one")
    for place, answer in answers.items():
        if answer is not None:
            raise _skewed(f"{answer} (at {place})")


def _skewed(differences: str) -> ClusterError:
    return VersionSkewError(f"a Dask worker cannot compute the same bits: {differences}")
