"""Errors of a cluster, as opposed to those of a chunk."""

from __future__ import annotations

from threadstate.errors import ThreadstateError


class ClusterError(ThreadstateError):
    """The scheduler or its workers are unreachable or have another version; committed chunks stay."""


class VersionSkewError(ClusterError):
    """A Dask worker has another version: its chunks may differ."""
