from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given

from tests.network.cell_maps import A, B, C, cell_maps, orientation_cells
from threadstate.errors import InvalidValueError
from threadstate.network.cells import Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.moves import Move

LEVEL = orientation_cells(0, [10.0, 100.0], [A, B])


def test_a_pose_is_found_by_roll_pitch_and_any_phase() -> None:
    orientations = [orientation_cells(k, [10.0 + k, 100.0], [A, B]) for k in range(4)]
    cell_map = CellMap((-1.0, 1.0), tuple(orientations))
    assert cell_map.tilt_deg(2) == (1.0, -1.0)
    assert cell_map.at(1.0, -1.0, 12.0) is cell_map.cells[2][0]
    assert cell_map.at(1.0, -1.0, 11.999) is cell_map.cells[2][1]
    assert cell_map.at(-1.0, -1.0, 0.0) is cell_map.at(-1.0, -1.0, 720.0) is cell_map.cells[0][1]
    with pytest.raises(InvalidValueError, match=r"roll is 0\.0; valid: one of -1, 1 deg"):
        cell_map.at(0.0, 1.0, 0.0)


def test_the_last_cell_is_followed_by_the_first() -> None:
    cell_map = CellMap((0.0,), (LEVEL,))
    assert cell_map.after(cell_map.cells[0][1]) is cell_map.cells[0][0]


def test_ends_are_made_the_starts_of_the_next_cells() -> None:
    rounded = (LEVEL[0], replace(LEVEL[1], end_deg=370.0 + 6e-14))
    assert rounded != LEVEL
    assert CellMap((0.0,), (rounded,)).cells == (LEVEL,)


@pytest.mark.parametrize(
    "cells",
    [
        (),
        (replace(LEVEL[0], end_deg=99.0), LEVEL[1]),
        (LEVEL[0], replace(LEVEL[1], end_deg=360.0)),
        (LEVEL[0],),
        LEVEL[::-1],
        (replace(LEVEL[0], start_deg=-1.0), replace(LEVEL[1], end_deg=359.0)),
        (replace(LEVEL[0], orientation=1), LEVEL[1]),
        orientation_cells(0, [10.0, 10.0], [A, B]),
        orientation_cells(0, [math.nan], [A]),
    ],
)
def test_cells_that_do_not_make_a_circle_are_refused(cells: tuple[Cell, ...]) -> None:
    with pytest.raises(InvalidValueError):
        CellMap((0.0,), (cells,))


def test_tilts_are_those_of_a_grid() -> None:
    with pytest.raises(InvalidValueError, match="tilts"):
        CellMap((), ())
    with pytest.raises(InvalidValueError, match="tilts"):
        CellMap((1.0, 1.0), (LEVEL,) * 4)
    with pytest.raises(InvalidValueError, match="number of orientations is 1; valid: 4"):
        CellMap((0.0, 1.0), (LEVEL,))


def test_formations_that_share_a_key_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Formation, "key", "0000000000")
    fresh = [Formation(one.state_class, one.contacts) for one in (A, B)]
    with pytest.raises(InvalidValueError, match="key of a formation"):
        _ = CellMap((0.0,), (orientation_cells(0, [10.0, 100.0], fresh),)).formations


def test_neighbours_are_one_step_of_one_angle_away() -> None:
    cells = tuple(orientation_cells(k, [0.0], [C]) for k in range(9))
    cell_map = CellMap((-1.0, 0.0, 1.0), cells)
    assert dict(cell_map.neighbours(4)) == {
        Move.ROLL_UP: cell_map.orientation(1.0, 0.0),
        Move.ROLL_DOWN: cell_map.orientation(-1.0, 0.0),
        Move.PITCH_UP: cell_map.orientation(0.0, 1.0),
        Move.PITCH_DOWN: cell_map.orientation(0.0, -1.0),
    }
    assert dict(cell_map.neighbours(2)) == {Move.ROLL_UP: 5, Move.PITCH_DOWN: 1}
    for number in range(9):
        for move, beside in cell_map.neighbours(number):
            assert (move.reverse, number) in cell_map.neighbours(beside)


@given(cell_maps())
def test_crossings_cover_a_cell_by_the_cells_that_hold_its_phases(cell_map: CellMap) -> None:
    for number, cell in enumerate(cell_map.all_cells):
        assert cell_map.number(cell) == number
        for move, beside in cell_map.neighbours(cell.orientation):
            found = [one for one in cell_map.crossings[number] if one.move is move]
            edges = [cell.start_deg, *(one.high_deg for one in found)]
            assert edges[-1] == cell.end_deg
            assert [one.low_deg for one in found] == edges[:-1]
            for one in found:
                target = cell_map.all_cells[one.target]
                assert target is cell_map.at_phase(beside, 0.5 * (one.low_deg + one.high_deg))
                assert target.start_deg <= one.low_deg - 360.0 * one.lap
                assert one.high_deg - 360.0 * one.lap <= target.end_deg
