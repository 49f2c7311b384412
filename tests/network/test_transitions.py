from __future__ import annotations

from math import fsum

from hypothesis import given

from tests.network.cell_maps import A, B, C, cell_maps, orientation_cells
from threadstate.network import transitions as tr
from threadstate.network.cells import CellMap
from threadstate.network.changes import ChangeKind
from threadstate.network.moves import Move

# Of four orientations the last three are alike, so that only tilts from and to the first one change something.
FIRST = orientation_cells(0, [10.0, 100.0, 200.0], [A, B, B])
OTHERS = tuple(orientation_cells(k, [50.0, 300.0], [B, C]) for k in (1, 2, 3))
CELL_MAP = CellMap((0.0, 1.0), (FIRST, *OTHERS))
ALL = tr.transitions(CELL_MAP)


def test_every_boundary_is_a_transition_in_both_senses() -> None:
    turns = [one for one in tr.from_orientation(ALL, 0) if one.move.turns]
    assert [(one.move, one.source.position, one.target.position, one.start_deg, one.cover_deg) for one in turns] == [
        (Move.COUNTER_CLOCKWISE, 2, 0, 10.0, 270.0),
        (Move.CLOCKWISE, 0, 2, 10.0, 90.0),
        (Move.COUNTER_CLOCKWISE, 0, 1, 100.0, 90.0),
        (Move.CLOCKWISE, 1, 0, 100.0, 270.0),
        (Move.COUNTER_CLOCKWISE, 1, 2, 200.0, 0.0),
        (Move.CLOCKWISE, 2, 1, 200.0, 0.0),
    ]
    assert all(one.start_deg == one.end_deg for one in turns)


def test_tilts_change_the_formation_where_stretches_of_different_ones_overlap() -> None:
    found = tr.with_move(tr.from_orientation(ALL, 0), Move.ROLL_UP)
    assert [(one.source.position, one.target.position, one.start_deg, one.end_deg) for one in found] == [
        (0, 1, 10.0, 50.0),
        (0, 0, 50.0, 100.0),
        (2, 1, 300.0, 370.0),
    ]
    back = tr.with_move(tr.from_orientation(ALL, 2), Move.ROLL_DOWN)
    assert sorted((one.target.position, one.start_deg, one.end_deg) for one in back) == [
        (0, 10.0, 50.0),
        (0, 50.0, 100.0),
        (2, 300.0, 370.0),
    ]


def test_orientations_without_a_boundary_have_no_turns() -> None:
    level = CellMap((0.0,), (orientation_cells(0, [0.0], [A]),))
    assert tr.transitions(level) == ()


def test_filters() -> None:
    assert {one.start_deg for one in ALL} > {one.start_deg for one in tr.changing_formation(ALL)}
    from_a = tr.from_formation(ALL, A)
    assert {one.source.formation for one in from_a} == {A}
    assert {one.target.formation for one in tr.to_formation(from_a, C)} == {C}
    assert len(tr.with_change(ALL, ChangeKind.GAINED)) == len(tr.with_change(ALL, ChangeKind.LOST)) > 0
    assert all(one.target.formation != A for one in tr.with_change(ALL, ChangeKind.GAINED))


def test_phase_ranges_may_hold_phase_0() -> None:
    tilts = tr.with_move(tr.from_orientation(ALL, 0), Move.ROLL_UP)

    def starts(start_deg: float, end_deg: float) -> list[float]:
        return [one.start_deg for one in tr.within_phases(tilts, start_deg, end_deg)]

    assert starts(60.0, 70.0) == [50.0]
    assert starts(350.0, 355.0) == starts(-10.0, -5.0) == [300.0]
    assert starts(350.0, 9.0) == [300.0]
    assert starts(350.0, 10.0) == [10.0, 300.0]
    assert starts(110.0, 290.0) == []
    assert starts(0.0, 360.0) == starts(110.0, 470.0) == [10.0, 50.0, 300.0]


@given(cell_maps())
def test_each_transition_has_its_reverse(cell_map: CellMap) -> None:
    found = {(one.move, one.source, one.target, one.start_deg % 360.0) for one in tr.transitions(cell_map)}
    assert found == {(move.reverse, target, source, phase) for move, source, target, phase in found}


@given(cell_maps())
def test_tilts_and_equal_neighbours_cover_the_circle(cell_map: CellMap) -> None:
    found = tr.transitions(cell_map)
    for number in range(cell_map.orientation_count):
        for move, _ in cell_map.neighbours(number):
            tilted = tr.with_move(tr.from_orientation(found, number), move)
            alike = fsum(
                one.high_deg - one.low_deg
                for cell in cell_map.cells[number]
                for one in cell_map.crossings[cell_map.number(cell)]
                if one.move is move and cell_map.all_cells[one.target].formation == cell.formation
            )
            assert fsum(one.cover_deg for one in tilted) + alike == 360.0
