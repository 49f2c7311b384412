"""Requests for where held bolts come to rest, computed or stored."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from threadstate.client.call import LATEST, Call, LibraryName, PagedCall, get, path_of, post
from threadstate.client.calls.states import LARGEST_PAGE
from threadstate.client.models.assemblies import Assembly
from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.settled import (
    SettleAnswer,
    Settled,
    SettledLibraryDetail,
    SettledLibraryList,
    SettledPage,
)


def settle(
    poses: Iterable[tuple[float, float, float]],
    *,
    device: Mapping[str, Any] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[SettleAnswer]:
    """Where a bolt comes to rest that a ``device`` holds at 1 to 1000 poses (roll, pitch, phase) and pushes.

    A device is a mapping with the keys of its document; None is the default one. Of a known thread, or with the pair of
    ``library``. Lengths of the answer are in ``unit``, those of the device in its own.
    """
    body = {
        "designation": designation,
        "library": library,
        "device": None if device is None else dict(device),
        "poses": [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses],
    }
    # Nothing is stored: repeatable.
    return post(path_of("v1", "settle"), SettleAnswer, body, repeatable=True, unit=unit)


def assemble(
    roll: float,
    pitch: float,
    phase: float,
    *,
    strategy: str | None = None,
    mu: float | None = None,
    longest_step: float | None = None,
    confirm: bool = False,
    device: Mapping[str, Any] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[Assembly]:
    """The path of a bolt that a ``device`` settles at a pose and turns, and whether it engages.

    ``strategy`` is ``ccw_then_cw`` (None) or ``cw``, ``mu`` the friction of all contacts (None: 0),
    ``longest_step`` that of the phase in degrees, 0.25 to 2 (None: 2, with friction 1); with ``confirm`` half of it
    is followed as well, and the path flagged where that changes it; the others are as for :func:`settle`.
    """
    body = {
        "designation": designation,
        "library": library,
        "pose": {"roll": float(roll), "pitch": float(pitch), "phase": float(phase)},
        "strategy": strategy,
        "mu": None if mu is None else float(mu),
        "longest_step": None if longest_step is None else float(longest_step),
        "confirm": True if confirm else None,
        "device": None if device is None else dict(device),
    }
    # Nothing is stored: repeatable.
    return post(path_of("v1", "assemblies"), Assembly, body, repeatable=True, unit=unit)


def ask_settled(
    *,
    device: Mapping[str, Any] | None = None,
    grid: Mapping[str, float] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
) -> Call[JobDocument]:
    """Request a library of settled states; omitted values are the defaults of ``threadstate rebuild-settled``.

    Needs a key for writing. ``grid`` has ``tilt_max``, ``tilt_step`` and ``phase_step`` in degrees, ``device`` the keys
    of its document.
    """
    body = {
        "designation": designation,
        "library": library,
        "device": None if device is None else dict(device),
        "grid": None if grid is None else dict(grid),
    }
    # The same inputs are the same job: repeatable.
    return post(path_of("v1", "settled"), JobDocument, body, repeatable=True)


def settled_libraries() -> Call[SettledLibraryList]:
    """All published libraries of settled states, the latest first."""
    return get(path_of("v1", "settled"), SettledLibraryList)


def settled_library(settled_library: int | str = LATEST) -> Call[SettledLibraryDetail]:
    """One library of settled states: its device, and counts by outcome and flag; its number, or ``latest``."""
    return get(path_of("v1", "settled", settled_library), SettledLibraryDetail)


def settled_states(
    *,
    settled_library: int | str = LATEST,
    roll: float | None = None,
    pitch: float | None = None,
    phase: float | None = None,
    phase_min: float | None = None,
    phase_max: float | None = None,
    outcome: str | None = None,
    flag: str | None = None,
    contacts: int | None = None,
    falls: int | None = None,
    limit: int = LARGEST_PAGE,
    unit: str | None = None,
) -> PagedCall[Settled]:
    """The settled states of a library for which all filters hold, in order; ``limit`` is the size of a page.

    ``contacts`` and ``falls`` are how many of them a state has.
    """
    filters = {
        "roll": roll,
        "pitch": pitch,
        "phase": phase,
        "phase_min": phase_min,
        "phase_max": phase_max,
        "outcome": outcome,
        "flag": flag,
        "contacts": contacts,
        "falls": falls,
    }
    path = path_of("v1", "settled", settled_library, "states")
    return PagedCall(get(path, SettledPage, **filters, limit=limit, unit=unit), Settled)


def settled_state(
    roll: float, pitch: float, phase: float, *, settled_library: int | str = LATEST, unit: str | None = None
) -> Call[Settled]:
    """The settled state of a pose of the library's grid; lengths in ``unit``, else in the library's own."""
    return get(path_of("v1", "settled", settled_library, "states", roll, pitch, phase), Settled, unit=unit)
