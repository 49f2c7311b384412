"""Where chunks are computed: by processes of one's own, or by the workers of a Dask cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Protocol

from threadstate.library.identity import LibraryInputs
from worker.messages import Chunk
from worker.processes import computing_processes


class Computers(Protocol):
    """What computes chunks of one library."""

    def chunks(self, orientations: Iterable[int], on_ready: Callable[[], None]) -> Iterator[Chunk]:
        """The chunks of these orientations, in the order in which they are finished.

        Orientations are taken when there is somebody to compute them; ``on_ready`` is called once, when something is.
        """


@contextmanager
def computers(inputs: LibraryInputs, processes: int, scheduler: str | None) -> Iterator[Computers]:
    """The workers of the cluster at ``scheduler``; where that is None, ``processes`` processes, ended on leaving.

    Raises:
        InvalidValueError: ``scheduler`` is no address of one.
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
