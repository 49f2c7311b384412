"""The search of an orientation's map: a grid of paths, bisected where outcomes differ, confirmed on both sides.

It knows neither device nor kernels: how a path ends is asked of a function of phase and friction, and whether a path
of half the step ends alike of another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

from threadstate.success.model import Cell, CriticalFriction, PhaseBoundary

TURN_DEG = 360.0


def mapped_cells(
    compute: Callable[[float, float], Cell],
    ends_alike: Callable[[Cell], bool],
    phases_deg: Sequence[float],
    frictions: Sequence[float],
    phase_tolerance_deg: float,
    mu_tolerance: float,
) -> tuple[tuple[Cell, ...], tuple[PhaseBoundary, ...], CriticalFriction]:
    """All paths of an orientation, by friction and phase, its boundaries of outcome and its critical friction.

    At each of ``frictions`` (ascending) a path starts from each phase (ascending, evenly over the turn). ``compute``
    gives the path from a phase at a friction; each is asked for once. Where two neighbours have unlike certain
    outcomes, ``ends_alike`` says of each whether it ends so with half the step: one that does not becomes undecided.
    Which paths are computed depends on outcomes alone.
    """
    cells: dict[tuple[float, float], Cell] = {}

    def cell(phase_deg: float, mu: float) -> Cell:
        if (mu, phase_deg) not in cells:
            cells[mu, phase_deg] = compute(phase_deg, mu)
        return cells[mu, phase_deg]

    for mu in frictions:
        for phase_deg in phases_deg:
            cell(phase_deg, mu)
    boundaries: list[PhaseBoundary] = []
    for mu in frictions:
        _narrow(cell, phases_deg, mu, phase_tolerance_deg)
        along = [cells[key] for key in sorted(cells) if key[0] == mu]
        for one in _beside_boundaries(along):
            if not ends_alike(one):
                cells[mu, one.phase_deg] = one.step_dependent()
        boundaries += _boundaries([cells[mu, one.phase_deg] for one in along])
    critical = _critical_friction(cell, phases_deg, frictions, mu_tolerance)
    return tuple(cells[key] for key in sorted(cells)), tuple(boundaries), critical


def _narrow(cell: Callable[[float, float], Cell], phases_deg: Sequence[float], mu: float, tolerance_deg: float) -> None:
    """Asks for paths between those of unlike certain outcomes, until they are as near as the tolerance."""
    gaps = list(pairwise([*phases_deg, phases_deg[0] + TURN_DEG]))
    while gaps:
        start_deg, end_deg = gaps.pop()
        before, after = cell(start_deg % TURN_DEG, mu), cell(end_deg % TURN_DEG, mu)
        if end_deg - start_deg > tolerance_deg and _differ_certainly(before, after):
            middle_deg = 0.5 * (start_deg + end_deg)
            gaps += [(middle_deg, end_deg), (start_deg, middle_deg)]


def _beside_boundaries(along: Sequence[Cell]) -> list[Cell]:
    """Of all paths at one friction, by phase, those beside one of another certain outcome, each once."""
    pairs = [(before, after) for before, after in _neighbours(along) if _differ_certainly(before, after)]
    return list({one.phase_deg: one for pair in pairs for one in pair}.values())


def _boundaries(along: Sequence[Cell]) -> list[PhaseBoundary]:
    """The boundaries between all paths at one friction, ascending; the last gap of the turn leads to the first path."""
    found = []
    for before, after in _neighbours(along):
        if before.outcome is not after.outcome:
            end_deg = after.phase_deg + (0.0 if after.phase_deg > before.phase_deg else TURN_DEG)
            found.append(PhaseBoundary(before.mu, before.phase_deg, end_deg, before.outcome, after.outcome))
    return found


def _neighbours(along: Sequence[Cell]) -> list[tuple[Cell, Cell]]:
    return list(pairwise([*along, along[0]]))


def _differ_certainly(before: Cell, after: Cell) -> bool:
    return before.outcome is not after.outcome and before.is_decided and after.is_decided


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
