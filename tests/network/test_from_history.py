"""The network of one real orientation."""

from __future__ import annotations

import pytest

from tests.network.test_graph import walked
from threadstate.history.build import history_of
from threadstate.history.model import SolvedHistory
from threadstate.history.window import Window, windows_of
from threadstate.network.analysis import dead_ends, window_reach
from threadstate.network.cells import CellMap
from threadstate.network.formation import formation_of
from threadstate.network.from_history import cells_of
from threadstate.network.graph import ConstraintNetwork, constraint_network
from threadstate.network.paths import best_path
from threadstate.thread.catalogue import quarter_twenty_unc

TILT_DEG = -4.0


@pytest.fixture(scope="module")
def history() -> SolvedHistory:
    return history_of(quarter_twenty_unc(), TILT_DEG, TILT_DEG)


@pytest.fixture(scope="module")
def window(history: SolvedHistory) -> Window:
    (window,) = windows_of(quarter_twenty_unc(), history)
    return window


@pytest.fixture(scope="module")
def network(history: SolvedHistory, window: Window) -> ConstraintNetwork:
    cells = cells_of(0, history, [(window.enter_deg, window.leave_deg)])
    return constraint_network(CellMap((TILT_DEG,), (cells,)))


def test_walking_the_network_reproduces_the_history(history: SolvedHistory, network: ConstraintNetwork) -> None:
    expected = [
        (formation_of(interval.labels), interval.start_deg)
        for before, interval in zip(history.intervals[-1:] + history.intervals[:-1], history.intervals, strict=True)
        if formation_of(interval.labels) != formation_of(before.labels)
    ]
    assert len(expected) > 20
    assert walked(network, 0) == expected


def test_the_cells_of_the_window_are_those_between_its_ends(window: Window, network: ConstraintNetwork) -> None:
    inside = [cell for cell in network.cell_map.all_cells if cell.in_window]
    assert sum(cell.width_deg for cell in inside) == pytest.approx(window.width_deg, abs=1e-9)


def test_turning_ends_where_the_bolt_enters_the_window(window: Window, network: ConstraintNetwork) -> None:
    start = network.cell_map.at(TILT_DEG, TILT_DEG, window.enter_deg - 100.0)
    path = best_path(network.cell_map, start.formation, orientation=0, phase_deg=window.enter_deg - 100.0)
    assert path is not None
    assert path.turning_deg == pytest.approx(100.0, abs=1e-9)
    assert path.steps[-1].phase_deg == pytest.approx(window.enter_deg, abs=1e-9)
    assert dead_ends(network) == ()
    assert all(reach.share == 1.0 for reach in window_reach(network) if reach.count)


def test_margins_are_those_of_the_states(network: ConstraintNetwork) -> None:
    margins = [cell.margin for cell in network.cell_map.all_cells if cell.formation.state_class is not None]
    assert all(margin is not None and margin >= 0.0 for margin in margins)
