"""What runs on a Dask worker."""

from __future__ import annotations

from functools import cache

from threadstate.warm_up import load_kernels_exclusively
from worker.cluster.errors import VersionSkewError
from worker.cluster.versions import Versions, own_versions
from worker.compute import compute_chunk
from worker.garbage import collect_rarely
from worker.messages import Chunk, ChunkInputs


def remote_chunk(inputs: ChunkInputs, index: int, wanted: Versions) -> Chunk:
    """Compute the chunk of an orientation in a process that must have the ``wanted`` versions.

    Raises:
        VersionSkewError: this process has other versions.
    """
    require_versions(wanted)
    _prepare()
    return compute_chunk(inputs, index)


def require_versions(wanted: Versions) -> None:
    """Check that this process computes the same bits.

    Raises:
        VersionSkewError: this process has other versions.
    """
    if differences := wanted.differences(own_versions()):
        raise VersionSkewError(differences)


@cache
def _prepare() -> None:
    """Prepare the process, once; also that of a Dask worker that joins late."""
    collect_rarely()
    load_kernels_exclusively()
