"""Requests for jobs."""

from __future__ import annotations

from collections.abc import Mapping

from threadstate.client.call import EVENT_STREAM, Call, PagedCall, get, path_of, post
from threadstate.client.models.jobs import JobDocument, JobPage

LARGEST_PAGE = 100


def ask(
    *,
    designation: str | None = None,
    grid: Mapping[str, float] | None = None,
    method: str | None = None,
    tolerances: Mapping[str, float] | None = None,
    mesh: Mapping[str, str | bool] | None = None,
) -> Call[JobDocument]:
    """Request a library; omitted values are the defaults of ``threadstate rebuild``. Needs a key for writing.

    ``grid`` has ``tilt_max``, ``tilt_step`` and ``phase_step`` in degrees.
    """
    body = {"designation": designation, "grid": grid, "method": method, "tolerances": tolerances, "mesh": mesh}
    # The same inputs are the same job: repeatable.
    return post(path_of("v1", "jobs"), JobDocument, body, repeatable=True)


def jobs(*, limit: int = LARGEST_PAGE) -> PagedCall[JobDocument]:
    """All jobs, the latest first."""
    return PagedCall(get(path_of("v1", "jobs"), JobPage, limit=limit), JobDocument)


def job(job_id: int) -> Call[JobDocument]:
    """The state and progress of a job."""
    return get(path_of("v1", "jobs", job_id), JobDocument)


def cancel(job_id: int) -> Call[JobDocument]:
    """Cancel a job that has not ended; needs a key for writing."""
    # A cancelled job stays cancelled: repeatable.
    return Call("DELETE", path_of("v1", "jobs", job_id), JobDocument.model_validate_json)


def events(job_id: int) -> Call[bytes]:
    """The events of a job until it ends, as a stream."""
    return Call("GET", path_of("v1", "jobs", job_id, "events"), bytes, accept=EVENT_STREAM)
