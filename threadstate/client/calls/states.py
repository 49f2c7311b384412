"""Requests for states, stored or solved."""

from __future__ import annotations

from collections.abc import Iterable

from threadstate.client.call import LATEST, Call, LibraryName, PagedCall, get, get_content, library_path, path_of, post
from threadstate.client.models.states import (
    HistoryColumns,
    HistoryRows,
    LibraryState,
    SolveAnswer,
    State,
    StatePage,
    UndecidedDocument,
    UndecidedPage,
)

LARGEST_PAGE = 1000
CSV = "text/csv"


def state(
    roll: float, pitch: float, phase: float, *, library: LibraryName = LATEST, unit: str | None = None
) -> Call[State]:
    """The state of a pose of the library's grid; lengths in ``unit``, else in the library's own."""
    return get(library_path(library, "states", roll, pitch, phase), State, unit=unit)


def states(
    *,
    library: LibraryName = LATEST,
    roll: float | None = None,
    pitch: float | None = None,
    phase: float | None = None,
    phase_min: float | None = None,
    phase_max: float | None = None,
    state_class: str | None = None,
    bolt_region: str | None = None,
    nut_region: str | None = None,
    flag: str | None = None,
    support_margin_min: float | None = None,
    support_margin_max: float | None = None,
    mu_hold_min: float | None = None,
    mu_hold_max: float | None = None,
    mu_wedge_min: float | None = None,
    mu_wedge_max: float | None = None,
    sort: str | None = None,
    limit: int = LARGEST_PAGE,
    unit: str | None = None,
) -> PagedCall[LibraryState]:
    """The states of a library for which all filters hold, in the order ``sort``; ``limit`` is the size of a page."""
    filters = {
        "roll": roll,
        "pitch": pitch,
        "phase": phase,
        "phase_min": phase_min,
        "phase_max": phase_max,
        "class": state_class,
        "bolt_region": bolt_region,
        "nut_region": nut_region,
        "flag": flag,
        "support_margin_min": support_margin_min,
        "support_margin_max": support_margin_max,
        "mu_hold_min": mu_hold_min,
        "mu_hold_max": mu_hold_max,
        "mu_wedge_min": mu_wedge_min,
        "mu_wedge_max": mu_wedge_max,
    }
    first = get(library_path(library, "states"), StatePage, **filters, sort=sort, limit=limit, unit=unit)
    return PagedCall(first, LibraryState)


def undecided(*, library: LibraryName = LATEST, limit: int = LARGEST_PAGE) -> PagedCall[UndecidedDocument]:
    """The poses of the grid that the library's solver method could not decide, and why."""
    return PagedCall(get(library_path(library, "undecided"), UndecidedPage, limit=limit), UndecidedDocument)


def history(roll: float, pitch: float, *, library: LibraryName = LATEST, unit: str | None = None) -> Call[HistoryRows]:
    """The states of an orientation at all phases of the grid, in order."""
    return get(library_path(library, "histories", roll, pitch), HistoryRows, format="rows", unit=unit)


def history_columns(
    roll: float, pitch: float, *, library: LibraryName = LATEST, unit: str | None = None
) -> Call[HistoryColumns]:
    """The same as columns of equal length, by name."""
    return get(library_path(library, "histories", roll, pitch), HistoryColumns, format="columns", unit=unit)


def history_csv(roll: float, pitch: float, *, library: LibraryName = LATEST, unit: str | None = None) -> Call[bytes]:
    """The same columns as a table (CSV in UTF-8)."""
    return get_content(library_path(library, "histories", roll, pitch), CSV, format="csv", unit=unit)


def solve(
    poses: Iterable[tuple[float, float, float]],
    *,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[SolveAnswer]:
    """The states of 1 to 1000 poses (roll, pitch, phase), on a grid or not, by the exact solver, in their order.

    Of a known thread, or with the pair and the tolerances of ``library``.
    """
    body = {
        "designation": designation,
        "library": library,
        "poses": [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses],
    }
    # Nothing is stored: repeatable.
    return post(path_of("v1", "solve"), SolveAnswer, body, repeatable=True, unit=unit)
