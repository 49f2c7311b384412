"""Cells under a load: what is cut, what is marked, what no move leaves."""

from __future__ import annotations

from tests.network.cell_maps import A, B, C, orientation_cells
from threadstate.network.analysis import dead_ends
from threadstate.network.cells import CellMap
from threadstate.network.graph import constraint_network
from threadstate.network.loaded import Mark, Part, loaded_cells, transition_mark
from threadstate.network.locate import Observation, locate
from threadstate.network.moves import Move
from threadstate.network.paths import best_path
from threadstate.network.transitions import transitions
from threadstate.statics.verdict import Verdict

MOVES, STAYS, WEDGES = Verdict.MOVES, Verdict.CAN_STAY, Verdict.CAN_WEDGE

CELLS = CellMap(
    (0.0, 1.0),
    (
        orientation_cells(0, [10.0, 100.0, 300.0], [A, B, C], window=[False, False, True]),
        orientation_cells(1, [0.0], [C]),
        orientation_cells(2, [50.0, 200.0], [B, C], window=[False, True]),
        orientation_cells(3, [0.0], [C]),
    ),
)
PARTS: list[list[list[Part]]] = [
    [
        [(10.0, 40.0, MOVES), (40.0, 100.0, STAYS)],
        [(100.0, 300.0, WEDGES)],
        [(300.0, 365.0, MOVES), (365.0, 370.0, STAYS)],
    ],
    [[(0.0, 360.0, STAYS)]],
    [[(50.0, 200.0, MOVES)], [(200.0, 380.0, MOVES), (380.0, 410.0, STAYS)]],
    [[(0.0, 360.0, MOVES)]],
]
LOADED = loaded_cells(CELLS, PARTS)
NETWORK = constraint_network(CELLS)
AVOIDED = frozenset({WEDGES})


def test_cells_are_cut_and_ordered_by_phase() -> None:
    assert [(one.start_deg, one.end_deg, one.formation, one.verdict) for one in LOADED.cells[0]] == [
        (5.0, 10.0, C, STAYS),
        (10.0, 40.0, A, MOVES),
        (40.0, 100.0, A, STAYS),
        (100.0, 300.0, B, WEDGES),
        (300.0, 365.0, C, MOVES),
    ]
    assert [one.position for one in LOADED.cells[0]] == [0, 1, 2, 3, 4]
    assert LOADED.cells[0][0].in_window


def test_a_turn_is_marked_where_it_leaves_and_a_tilt_by_the_severest_of_its_stretch() -> None:
    marks = {
        (one.move, one.source.formation, one.start_deg): transition_mark(
            one, PARTS[one.source.orientation][one.source.position]
        )
        for one in transitions(CELLS)
        if one.source.orientation == 0
    }
    assert marks[Move.COUNTER_CLOCKWISE, A, 100.0] is Mark.HELD
    assert marks[Move.CLOCKWISE, A, 10.0] is Mark.FREE
    assert marks[Move.COUNTER_CLOCKWISE, B, 300.0] is Mark.WEDGED
    assert marks[Move.CLOCKWISE, C, 300.0] is Mark.FREE
    assert marks[Move.COUNTER_CLOCKWISE, C, 10.0] is Mark.HELD
    tilts = {one: mark for one, mark in marks.items() if one[0] is Move.ROLL_UP}
    assert tilts[Move.ROLL_UP, A, 10.0] is Mark.HELD
    assert tilts[Move.ROLL_UP, A, 50.0] is Mark.HELD
    assert tilts[Move.ROLL_UP, B, 200.0] is Mark.WEDGED


def test_no_path_leaves_what_is_avoided() -> None:
    assert best_path(CELLS, A, orientation=0) is not None
    assert best_path(LOADED, A, orientation=0) is not None
    assert best_path(LOADED, A, orientation=0, avoid=AVOIDED) is None
    around = best_path(LOADED, A, moves={Move.COUNTER_CLOCKWISE, Move.ROLL_UP}, orientation=0, avoid=AVOIDED)
    assert around is not None
    assert [(one.cell.orientation, one.cell.formation) for one in around.steps if one.cell.orientation == 2][-1] == (
        2,
        C,
    )
    assert all(one.cell.verdict not in AVOIDED for one in around.steps)


def test_dead_ends_under_a_load() -> None:
    assert dead_ends(NETWORK) == ()
    assert dead_ends(NETWORK, loaded=LOADED) == ()
    assert dead_ends(NETWORK, loaded=LOADED, avoid=AVOIDED) == (A,)
    assert dead_ends(NETWORK, [Move.COUNTER_CLOCKWISE, Move.ROLL_UP], loaded=LOADED, avoid=AVOIDED) == ()


def test_a_verdict_can_be_observed() -> None:
    assert locate(LOADED, Observation(verdict=WEDGES)).share == 200.0 / LOADED.total_deg
    assert locate(LOADED, Observation(verdict=STAYS)).share == (60.0 + 5.0 + 360.0 + 30.0) / LOADED.total_deg
    assert locate(CELLS, Observation(verdict=STAYS)).share == 0.0
