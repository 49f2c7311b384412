"""What goes wrong with a cluster and not with a chunk."""

from __future__ import annotations

from threadstate.errors import ThreadstateError


class ClusterError(ThreadstateError):
    """The scheduler or its workers are not there, or are of another version; what is committed stays."""


class VersionSkewError(ClusterError):
    """A Dask worker is of another version: its chunks may be others."""
