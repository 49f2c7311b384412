"""Requests for success maps."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from threadstate.client.call import LATEST, Call, LibraryName, PagedCall, get, path_of, post
from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.success import (
    GrowingMap,
    OutcomesAnswer,
    SuccessMapDetail,
    SuccessMapList,
    SuccessOrientationPage,
    SummarisedOrientation,
)

LARGEST_PAGE = 1000


def outcomes(
    poses: Iterable[tuple[float, float, float]],
    *,
    strategy: str | None = None,
    mu: float | None = None,
    point_limit: int | None = None,
    time_limit: float | None = None,
    device: Mapping[str, Any] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[OutcomesAnswer]:
    """How the paths end that start at 1 to 100 poses (roll, pitch, phase), without the paths themselves.

    The arguments are those of :func:`assemble`; a path with more points in a turn than ``point_limit`` (None: 1,000) is
    undecided, as is what has not ended after ``time_limit`` seconds (None: the request is refused then).
    """
    body = {
        "designation": designation,
        "library": library,
        "poses": [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses],
        "strategy": strategy,
        "mu": None if mu is None else float(mu),
        "point_limit": point_limit,
        "time_limit": time_limit,
        "device": None if device is None else dict(device),
    }
    # Nothing is stored: repeatable.
    return post(path_of("v1", "outcomes"), OutcomesAnswer, body, repeatable=True, unit=unit)


def ask_success_map(
    *,
    device: Mapping[str, Any] | None = None,
    strategy: str | None = None,
    mu: float | Sequence[float] | None = None,
    grid: Mapping[str, float] | None = None,
    phase_tolerance: float | None = None,
    mu_tolerance: float | None = None,
    point_limit: int | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
) -> Call[JobDocument]:
    """Request a success map; omitted values are the defaults of ``threadstate success``. Needs a key for writing.

    A ``device`` is a mapping with the keys of its document. ``strategy`` is ``ccw_then_cw`` or ``cw``, ``mu`` a
    friction or several, ascending. ``grid`` has ``tilt_max``, ``tilt_step`` and, between starting phases,
    ``phase_step``, in degrees.
    """
    body = {
        "designation": designation,
        "library": library,
        "device": None if device is None else dict(device),
        "strategy": strategy,
        "mu": None if mu is None else [float(mu)] if isinstance(mu, int | float) else [float(one) for one in mu],
        "grid": None if grid is None else dict(grid),
        "phase_tolerance": phase_tolerance,
        "mu_tolerance": mu_tolerance,
        "point_limit": point_limit,
    }
    # The same inputs are the same job: repeatable.
    return post(path_of("v1", "success-maps"), JobDocument, body, repeatable=True)


def success_maps(*, library: LibraryName | None = None) -> Call[SuccessMapList]:
    """All published success maps, the latest first; with ``library`` those of its pair."""
    return get(path_of("v1", "success-maps"), SuccessMapList, library=library)


def success_map(success_map: int | str = LATEST) -> Call[SuccessMapDetail]:
    """One success map: its device, and how many orientations engage at each friction; its number, or ``latest``."""
    return get(path_of("v1", "success-maps", success_map), SuccessMapDetail)


def success_orientations(
    *, success_map: int | str = LATEST, limit: int = LARGEST_PAGE, unit: str | None = None
) -> PagedCall[SummarisedOrientation]:
    """What a map has of each orientation, in the order of roll and pitch; ``limit`` is the size of a page."""
    path = path_of("v1", "success-maps", success_map, "orientations")
    return PagedCall(get(path, SuccessOrientationPage, limit=limit, unit=unit), SummarisedOrientation)


def success_orientation(
    roll: float, pitch: float, *, success_map: int | str = LATEST, unit: str | None = None
) -> Call[SummarisedOrientation]:
    """What a map has of one orientation of its grid; lengths in ``unit``, else in the map's own."""
    path = path_of("v1", "success-maps", success_map, "orientations", roll, pitch)
    return get(path, SummarisedOrientation, unit=unit)


def growing_map(job_id: int, *, unit: str | None = None) -> Call[GrowingMap]:
    """What is computed so far of the success map of a job."""
    return get(path_of("v1", "jobs", job_id, "success-map"), GrowingMap, unit=unit)
