"""The search of an orientation's map, on outcomes that are given: which paths it computes, and what it finds."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag
from threadstate.success.model import Cell
from threadstate.success.search import mapped_cells

ENGAGED, NO_SNAP, IDLE, UNDECIDED = (
    AssemblyOutcome.ENGAGED,
    AssemblyOutcome.NO_SNAP,
    AssemblyOutcome.IDLE,
    AssemblyOutcome.UNDECIDED,
)
PHASES = (0.0, 90.0, 180.0, 270.0)


class Paths:
    """Paths whose outcomes a function gives, and which of them were asked for."""

    def __init__(self, outcome: Callable[[float, float], AssemblyOutcome]) -> None:
        self._outcome = outcome
        self.asked: list[tuple[float, float]] = []

    def __call__(self, phase_deg: float, mu: float) -> Cell:
        """The path from a phase at a friction."""
        self.asked.append((phase_deg, mu))
        return Cell(phase_deg, mu, self._outcome(phase_deg, mu), (), False, None, None, None, None)


def always(cell: Cell) -> bool:
    """Every path ends alike with half the step."""
    return cell.is_decided


def test_where_all_engage_there_is_neither_a_boundary_nor_an_upper_end() -> None:
    paths = Paths(lambda *_: ENGAGED)
    cells, boundaries, critical = mapped_cells(paths, always, PHASES, (0.1, 0.2), 1.0, 0.01)
    assert sorted(paths.asked) == sorted((phase, mu) for mu in (0.0, 0.1, 0.2) for phase in PHASES)
    assert [(cell.mu, cell.phase_deg) for cell in cells] == [(mu, phase) for mu in (0.0, 0.1, 0.2) for phase in PHASES]
    assert boundaries == ()
    assert (critical.last, critical.first, critical.phase_deg, critical.outcome) == (0.2, None, None, None)


def test_a_window_of_phases_has_two_boundaries_narrowed_to_the_tolerance() -> None:
    window = (250.3, 371.7)
    paths = Paths(
        lambda phase, _: NO_SNAP if any(window[0] < one < window[1] for one in (phase, phase + 360)) else IDLE
    )
    _, boundaries, critical = mapped_cells(paths, always, PHASES, (0.0,), 0.5, 0.01)
    assert len(paths.asked) == len(set(paths.asked))
    assert [(one.outcome_before, one.outcome_after) for one in boundaries] == [(NO_SNAP, IDLE), (IDLE, NO_SNAP)]
    for boundary, edge in zip(boundaries, (window[1] - 360.0, window[0]), strict=True):
        assert boundary.from_deg < edge < boundary.to_deg
        assert boundary.to_deg - boundary.from_deg <= 0.5
    assert (critical.last, critical.first, critical.phase_deg, critical.outcome) == (None, 0.0, 0.0, NO_SNAP)


def test_a_third_outcome_between_two_has_both_its_boundaries() -> None:
    paths = Paths(lambda phase, _: ENGAGED if phase < 100 else IDLE if phase < 140 else NO_SNAP)
    _, boundaries, _ = mapped_cells(paths, always, PHASES, (0.0,), 1.0, 0.01)
    inner = [(one.from_deg, one.to_deg) for one in boundaries if one.to_deg <= 180.0]
    assert [low < edge <= high for (low, high), edge in zip(inner, (100.0, 140.0), strict=True)] == [True, True]
    assert boundaries[-1].to_deg == 360.0


def test_a_gap_beside_an_undecided_path_is_not_narrowed() -> None:
    paths = Paths(lambda phase, _: UNDECIDED if phase == 90.0 else ENGAGED)
    _, boundaries, critical = mapped_cells(paths, always, PHASES, (0.0,), 1.0, 0.01)
    assert len(paths.asked) == len(PHASES)
    assert [(one.from_deg, one.to_deg) for one in boundaries] == [(0.0, 90.0), (90.0, 180.0)]
    assert (critical.last, critical.first, critical.phase_deg, critical.outcome) == (None, 0.0, 90.0, UNDECIDED)


def test_paths_beside_a_boundary_that_half_the_step_ends_otherwise_are_undecided() -> None:
    """A window of three grid phases: half the step does not confirm its last path."""
    paths = Paths(lambda phase, mu: ENGAGED if 90.0 <= phase <= 200.0 or mu == 0.0 else IDLE)
    asked = []

    def ends_alike(cell: Cell) -> bool:
        asked.append(cell.phase_deg)
        return cell.phase_deg != 180.0

    cells, boundaries, critical = mapped_cells(paths, ends_alike, (0.0, 60.0, 120.0, 180.0, 240.0), (0.1,), 60.0, 1.0)
    assert sorted(asked) == [60.0, 120.0, 180.0, 240.0]
    doubtful = next(cell for cell in cells if (cell.mu, cell.phase_deg) == (0.1, 180.0))
    assert (doubtful.outcome, doubtful.flags) == (UNDECIDED, (SettledFlag.STEP_DEPENDENT,))
    assert [(one.from_deg, one.to_deg, one.outcome_before, one.outcome_after) for one in boundaries] == [
        (60.0, 120.0, IDLE, ENGAGED),
        (120.0, 180.0, ENGAGED, UNDECIDED),
        (180.0, 240.0, UNDECIDED, IDLE),
    ]
    assert (critical.first, critical.phase_deg, critical.outcome) == (0.1, 0.0, IDLE)


def test_a_critical_friction_that_a_path_of_half_the_step_does_not_confirm_is_undecided() -> None:
    paths = Paths(lambda phase, mu: IDLE if phase == 180.0 and mu == 0.2 else ENGAGED)
    _, _, critical = mapped_cells(paths, lambda cell: cell.engages, PHASES, (0.1, 0.2), 90.0, 0.1)
    assert (critical.last, critical.first, critical.phase_deg, critical.outcome) == (0.1, 0.2, 180.0, UNDECIDED)


def test_one_phase_has_no_boundary() -> None:
    _, boundaries, _ = mapped_cells(Paths(lambda *_: IDLE), always, (0.0,), (0.1,), 1.0, 0.01)
    assert boundaries == ()


@pytest.mark.parametrize("limit", [0.013, 0.137, 0.2])
def test_the_critical_friction_is_enclosed(limit: float) -> None:
    """From one phase the bolt engages at all frictions, from another one up to a limit."""
    paths = Paths(lambda phase, mu: IDLE if phase == 180.0 and mu > limit else ENGAGED)
    cells, _, critical = mapped_cells(paths, always, PHASES, (0.1, 0.2, 0.3), 1.0, 0.004)
    assert critical.last is not None
    assert critical.first is not None
    assert critical.last <= limit < critical.first
    assert critical.first - critical.last <= 0.004
    assert (critical.phase_deg, critical.outcome, critical.reenters) == (180.0, IDLE, False)
    computed = {(cell.mu, cell.phase_deg): cell for cell in cells}
    assert all(computed[critical.last, phase].engages for phase in PHASES)
    assert not computed[critical.first, 180.0].engages
    # Once a phase has failed, a friction that fails takes one path.
    failing = [mu for mu in {cell.mu for cell in cells} - {0.1, 0.2, 0.3} if mu > limit]
    assert all(sum(cell.mu == mu for cell in cells) == 1 for mu in failing)


def test_a_certain_failure_ends_the_interval_rather_than_an_undecided_path() -> None:
    paths = Paths(lambda phase, mu: ENGAGED if mu < 0.1 else {0.0: UNDECIDED, 180.0: IDLE}.get(phase, ENGAGED))
    _, _, critical = mapped_cells(paths, always, PHASES, (0.1,), 360.0, 0.2)
    assert (critical.last, critical.first, critical.phase_deg, critical.outcome) == (0.0, 0.1, 180.0, IDLE)


def test_frictions_above_the_first_failure_that_engage_are_named() -> None:
    paths = Paths(lambda _, mu: IDLE if mu < 0.2 else ENGAGED)
    _, _, critical = mapped_cells(paths, always, PHASES, (0.1, 0.2), 1.0, 0.01)
    assert (critical.last, critical.first, critical.reenters) == (None, 0.0, True)
