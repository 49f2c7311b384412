"""The search of an orientation's map: a grid of paths, bisected where outcomes differ.

It knows neither device nor kernels: how a path ends is asked of a function of phase and friction.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from threadstate.success.model import Cell, CriticalFriction, PhaseBoundary

TURN_DEG = 360.0


def mapped_cells(
    compute: Callable[[float, float], Cell],
    phases_deg: Sequence[float],
    frictions: Sequence[float],
    phase_tolerance_deg: float,
    mu_tolerance: float,
) -> tuple[tuple[Cell, ...], tuple[PhaseBoundary, ...], CriticalFriction]:
    """All paths of an orientation, by friction and phase, its boundaries of outcome and its critical friction.

    At each of ``frictions`` (ascending) a path starts from each phase (ascending, evenly over the turn). ``compute``
    gives the path from a phase at a friction; each is asked for once. Which paths are computed depends on outcomes
    alone.
    """
    cells: dict[tuple[float, float], Cell] = {}

    def cell(phase_deg: float, mu: float) -> Cell:
        if (mu, phase_deg) not in cells:
            cells[mu, phase_deg] = compute(phase_deg, mu)
        return cells[mu, phase_deg]

    for mu in frictions:
        for phase_deg in phases_deg:
            cell(phase_deg, mu)
    boundaries = tuple(
        boundary for mu in frictions for boundary in _phase_boundaries(cell, phases_deg, mu, phase_tolerance_deg)
    )
    critical = _critical_friction(cell, phases_deg, frictions, mu_tolerance)
    return tuple(cells[key] for key in sorted(cells)), boundaries, critical


def _phase_boundaries(
    cell: Callable[[float, float], Cell], phases_deg: Sequence[float], mu: float, tolerance_deg: float
) -> list[PhaseBoundary]:
    """Boundaries of outcome along the phase, ascending; the last gap of the turn leads back to the first phase."""
    found = []
    # The gaps still to be looked at, the next one last.
    gaps = list(reversed(list(pairwise([*phases_deg, phases_deg[0] + TURN_DEG]))))
    while gaps:
        start_deg, end_deg = gaps.pop()
        before, after = cell(start_deg % TURN_DEG, mu), cell(end_deg % TURN_DEG, mu)
        if before.outcome is after.outcome:
            continue
        if end_deg - start_deg <= tolerance_deg or not (before.is_decided and after.is_decided):
            found.append(PhaseBoundary(mu, start_deg, end_deg, before.outcome, after.outcome))
            continue
        middle_deg = 0.5 * (start_deg + end_deg)
        gaps += [(middle_deg, end_deg), (start_deg, middle_deg)]
    return found


def _critical_friction(
    cell: Callable[[float, float], Cell], phases_deg: Sequence[float], frictions: Sequence[float], tolerance: float
) -> CriticalFriction:
    """The interval of the critical friction, from frictionless paths on."""
    failures = {mu: _worst([cell(phase_deg, mu) for phase_deg in phases_deg]) for mu in frictions}
    if 0.0 not in failures:
        failures[0.0] = _first_failure(cell, phases_deg, 0.0)
    last: float | None = None
    for mu in sorted(failures):
        failure = failures[mu]
        if failure is not None:
            break
        last = mu
    else:
        return CriticalFriction(last, None, None, None, reenters=False)
    first = failure.mu
    reenters = any(mu > first and found is None for mu, found in failures.items())
    while last is not None and first - last > tolerance:
        middle = 0.5 * (last + first)
        # The phase that failed last is the likeliest to fail again.
        worst_deg = failure.phase_deg
        ordered = [worst_deg, *(phase_deg for phase_deg in phases_deg if phase_deg != worst_deg)]
        found = _first_failure(cell, ordered, middle)
        if found is None:
            last = middle
        else:
            first, failure = middle, found
    return CriticalFriction(last, first, failure.phase_deg, failure.outcome, reenters)


def _worst(cells: Sequence[Cell]) -> Cell | None:
    """Of paths that do not engage the first that is decided, else the first; None where all engage."""
    failures = [cell for cell in cells if not cell.engages]
    return next((cell for cell in failures if cell.is_decided), failures[0] if failures else None)


def _first_failure(cell: Callable[[float, float], Cell], phases_deg: Sequence[float], mu: float) -> Cell | None:
    """The first path, in the order of the phases, that does not engage; those after it are not computed."""
    return next((found for phase_deg in phases_deg if not (found := cell(phase_deg, mu)).engages), None)
