"""Who computes the chunks of a job: processes of this machine, or the workers of a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Protocol

from worker.messages import Chunk, ChunkInputs
from worker.processes import computing_processes


class ChunkSource(Protocol):
    """Computes chunks of one job."""

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[Chunk]:
        """The chunks of these orientations, in the order in which they are finished.

        Orientations are taken when they can be computed; ``on_ready`` is called once, when the computation begins.
        """


@contextmanager
def chunk_source(inputs: ChunkInputs, processes: int, scheduler: str | None) -> Iterator[ChunkSource]:
    """The workers of the cluster at ``scheduler``, or without one ``processes`` local processes, terminated on leaving.

    Raises:
        InvalidValueError: ``scheduler`` is not the address of a scheduler.
        ClusterError: the cluster cannot be used.
    """
    if scheduler is None:
        with computing_processes(inputs, processes) as local:
            yield local
    else:
        # Dask takes a second to import, and is an extra.
        from worker.cluster.chunks import computing_cluster

        with computing_cluster(inputs, scheduler) as cluster:
            yield cluster
