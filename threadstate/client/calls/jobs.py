"""Requests for jobs."""

from __future__ import annotations

from collections.abc import Mapping

from threadstate.client.call import Call, PagedCall, get, path_of, post
from threadstate.client.models.jobs import JobDocument, JobPage

LARGEST_PAGE = 100
EVENT_STREAM = "text/event-stream"


def ask(
    *,
    designation: str | None = None,
    grid: Mapping[str, float] | None = None,
    method: str | None = None,
    tolerances: Mapping[str, float] | None = None,
    mesh: Mapping[str, str | bool] | None = None,
) -> Call[JobDocument]:
    """Have a library computed; what is left out is as for ``threadstate rebuild``. Needs a key for writing.

    ``grid`` has ``tilt_max``, ``tilt_step`` and ``phase_step`` in degrees.
    """
    body = {"designation": designation, "grid": grid, "method": method, "tolerances": tolerances, "mesh": mesh}
    # The same inputs are the same job, so that it may be asked for again.
    return post(path_of("v1", "jobs"), JobDocument, body, repeatable=True)


def jobs(*, limit: int = LARGEST_PAGE) -> PagedCall[JobDocument]:
    """All jobs, the latest first."""
    return PagedCall(get(path_of("v1", "jobs"), JobPage, limit=limit), JobDocument)


def job(job_id: int) -> Call[JobDocument]:
    """How far a job is."""
    return get(path_of("v1", "jobs", job_id), JobDocument)


def cancel(job_id: int) -> Call[JobDocument]:
    """Cancel a job that has not ended; needs a key for writing."""
    # One that is cancelled stays so, so that it may be cancelled again.
    return Call("DELETE", path_of("v1", "jobs", job_id), JobDocument.model_validate_json)


def events(job_id: int) -> Call[bytes]:
    """What has happened to a job and what happens until it ends, as a stream."""
    return Call("GET", path_of("v1", "jobs", job_id, "events"), bytes, accept=EVENT_STREAM)
