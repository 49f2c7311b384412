"""What runs on a Dask worker."""

from __future__ import annotations

from functools import cache

from threadstate.library.identity import LibraryInputs
from threadstate.warm_up import load_kernels_in_turn
from worker.cluster.errors import VersionSkewError
from worker.cluster.versions import Versions, own_versions
from worker.compute import compute_chunk
from worker.garbage import collect_rarely
from worker.messages import Chunk


def remote_chunk(inputs: LibraryInputs, index: int, wanted: Versions) -> Chunk:
    """The orientation of that number, from a process of the same versions as the one that asks.

    Raises:
        VersionSkewError: this process is of others.
    """
    require_versions(wanted)
    _prepare()
    return compute_chunk(inputs, index)


def require_versions(wanted: Versions) -> None:
    """See that this process would compute the same bits.

    Raises:
        VersionSkewError: it is of other versions.
    """
    if differences := wanted.differences(own_versions()):
        raise VersionSkewError(differences)


@cache
def _prepare() -> None:
    """Make a process ready, once: a Dask worker that joins late too."""
    collect_rarely()
    load_kernels_in_turn()
