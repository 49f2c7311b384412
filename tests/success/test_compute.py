"""Maps of orientations: their paths are those of single assemblies, and a limit of points ends a path by name."""

from __future__ import annotations

from threading import Event
from typing import Any

import pytest

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, PathEvent
from threadstate.device.model import SettledFlag, default_device
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathStoppedError
from threadstate.library.grid import Grid
from threadstate.success import orientation_paths
from threadstate.success.bounded import BoundedWatch, bounded_cell, cell_of
from threadstate.success.compute import computed_orientation
from threadstate.success.model import Cell
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR, DEVICE = quarter_twenty_unc(), default_device()
GRID = Grid(4.0, 4.0, 120.0)


class Leg:
    """A leg that gains points as it is told, and ends when it is stopped."""

    def __init__(self) -> None:
        self.points = 0
        self.stopped = Event()

    def reached(self) -> tuple[int, float | None]:
        """How many points it has."""
        return self.points, None

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """None."""
        _ = phase_deg
        return []

    def stop(self) -> None:
        """Have it end."""
        self.stopped.set()


def test_a_leg_beyond_the_limit_is_stopped_and_one_at_it_is_not() -> None:
    watch, leg = BoundedWatch(10), Leg()
    with watch.looking():
        watch.begin_leg(leg)
        leg.points = 10
        watch.end_leg()
        longer = Leg()
        watch.begin_leg(longer)
        longer.points = 11
        assert longer.stopped.wait(60.0)
    assert not leg.stopped.is_set()
    with pytest.raises(PathStoppedError):
        watch.end_leg()


def test_a_leg_that_nobody_looked_at_in_time_ends_alike() -> None:
    watch, leg = BoundedWatch(10), Leg()
    watch.begin_leg(leg)
    leg.points = 11
    with pytest.raises(PathStoppedError, match="more points than its limit"):
        watch.end_leg()


@pytest.mark.slow
def test_the_limit_decides_between_a_path_and_an_undecided_one() -> None:
    path = assemble_pose(PAIR, 0.0, -4.0, 300.0, DEVICE, Strategy.CW)
    assert path.outcome is not AssemblyOutcome.UNDECIDED
    arguments = (PAIR, DEVICE, Strategy.CW, (0.0, -4.0, 300.0), 0.0)
    assert bounded_cell(*arguments, len(path.points)) == cell_of(path)
    stopped = bounded_cell(*arguments, len(path.points) - 1)
    assert (stopped.outcome, stopped.flags, stopped.is_bounded) == (AssemblyOutcome.UNDECIDED, (), True)
    assert (stopped.torque, stopped.tilt_deg, stopped.shift, stopped.end_deg) == (None, None, None, None)


@pytest.mark.slow
@pytest.mark.parametrize("strategy", Strategy)
def test_the_paths_of_a_map_are_those_of_single_assemblies(strategy: Strategy) -> None:
    index = GRID.orientation_index(0.0, -4.0)
    assert index is not None
    found = computed_orientation(PAIR, DEVICE, strategy, GRID, (0.0,), 120.0, 0.01, 2500, index)
    assert (found.roll_deg, found.pitch_deg) == (0.0, -4.0)
    assert [(cell.mu, cell.phase_deg) for cell in found.cells] == [(0.0, phase) for phase in GRID.phases_deg]
    for cell in found.cells:
        assert cell == cell_of(assemble_pose(PAIR, 0.0, -4.0, cell.phase_deg, DEVICE, strategy))
    outcomes = [cell.outcome for cell in found.cells]
    changes = sum(one is not other for one, other in zip(outcomes, [*outcomes[1:], outcomes[0]], strict=True))
    assert len(found.boundaries) == changes


def test_paths_beside_a_boundary_are_followed_again_alone_with_half_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of them ends otherwise: with friction and without it."""
    asked: list[tuple[float, float, int, float | None, bool]] = []

    def followed(*given: Any) -> Cell:
        (_, _, phase_deg), mu, point_limit, longest_step_deg, known, _ = given[3:]
        asked.append((phase_deg, mu, point_limit, longest_step_deg, known is not None))
        engages = phase_deg < 200.0 or (phase_deg > 200.0 and longest_step_deg is not None)
        outcome = AssemblyOutcome.ENGAGED if engages else AssemblyOutcome.IDLE
        return Cell(phase_deg, mu, outcome, (), False, None, None, None, None)

    monkeypatch.setattr(orientation_paths, "bounded_cell", followed)
    found = computed_orientation(PAIR, DEVICE, Strategy.CW, GRID, (0.0, 0.3), 120.0, 1.0, 900, 0)
    again = [one for one in asked if one[3] is not None]
    assert again == [
        (phase, mu, 1800, step, False) for mu, step in ((0.0, 1.0), (0.3, 0.5)) for phase in (120.0, 240.0, 0.0)
    ]
    assert [cell.phase_deg for cell in found.cells if cell.flags == (SettledFlag.STEP_DEPENDENT,)] == [240.0, 240.0]
