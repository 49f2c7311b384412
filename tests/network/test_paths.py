from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.network.cell_maps import TICK_DEG, TICKS, UNDECIDED, A, B, C, cell_maps, orientation_cells
from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.network.cells import Cell, CellMap
from threadstate.network.moves import TILTS, Move
from threadstate.network.paths import Path, best_path
from threadstate.network.search import Objective

Value = tuple[float, float]


def value_of(path: Path | None) -> Value | None:
    """What the objective compares, the better the smaller."""
    if path is None:
        return None
    return {
        Objective.TURNING: (path.turning_deg, float(path.transitions)),
        Objective.TRANSITIONS: (float(path.transitions), path.turning_deg),
        Objective.MARGIN: (-path.worst_margin, path.turning_deg),
    }[path.objective]


def value_by_ticks(
    cell_map: CellMap, start: Cell, tick: int, objective: Objective, tilts: frozenset[Move], limit: int = 2 * TICKS
) -> Value | None:
    """The best value, found by going through all orientations tick by tick."""

    def cell_at(number: int, at: int) -> Cell:
        return cell_map.at_phase(number, TICK_DEG * at)

    def cost(before: float, one: Cell, other: Cell) -> float:
        if objective is Objective.MARGIN:
            return max(before, -(other.margin or 0.0))
        return before + (one.formation != other.formation)

    costs = {start.orientation: -(start.margin or 0.0) if objective is Objective.MARGIN else 0.0}
    found: list[Value] = []
    for turned in range(limit + 1):
        at = tick + turned
        if turned:
            costs = {k: cost(c, cell_at(k, at - 1), cell_at(k, at)) for k, c in costs.items()}
        for _ in range(cell_map.orientation_count):
            for number, before in list(costs.items()):
                for move, beside in cell_map.neighbours(number):
                    after = cost(before, cell_at(number, at), cell_at(beside, at))
                    if move in tilts and after < costs.get(beside, math.inf):
                        costs[beside] = after
        for number, c in costs.items():
            if cell_at(number, at).in_window:
                turning = TICK_DEG * turned
                found.append((turning, c) if objective is Objective.TURNING else (c, turning))
    return min(found, default=None)


def is_a_way(cell_map: CellMap, path: Path, tilts: frozenset[Move]) -> bool:
    """Whether each step is a move that is allowed, at a phase that both cells hold."""
    for before, step in pairwise(path.steps):
        turned = step.turning_deg - before.turning_deg
        left_at = before.phase_deg + turned
        assert turned >= 0.0
        assert left_at % 360.0 == step.phase_deg
        beside = dict(cell_map.neighbours(before.cell.orientation))
        if step.move is Move.COUNTER_CLOCKWISE:
            assert step.cell == cell_map.after(before.cell)
            assert (before.cell.end_deg - left_at) % 360.0 == 0.0
        else:
            assert step.move in tilts
            assert step.cell.orientation == beside[step.move]
            assert cell_map.at_phase(before.cell.orientation, left_at) == before.cell
        assert cell_map.at_phase(step.cell.orientation, step.phase_deg) == step.cell
        assert not before.cell.in_window
    return path.steps[-1].cell.in_window


tilt_sets = st.sets(st.sampled_from(sorted(TILTS))).map(frozenset)


@settings(max_examples=150)
@given(cell_maps(), st.data(), st.sampled_from(Objective), tilt_sets)
def test_from_a_pose_no_way_is_better(
    cell_map: CellMap, data: st.DataObject, objective: Objective, tilts: frozenset[Move]
) -> None:
    number = data.draw(st.integers(0, cell_map.orientation_count - 1))
    tick = data.draw(st.integers(0, TICKS - 1))
    limit = data.draw(st.integers(0, 2 * TICKS))
    start = cell_map.at_phase(number, TICK_DEG * tick)
    path = best_path(
        cell_map,
        start.formation,
        objective,
        tilts | {Move.COUNTER_CLOCKWISE},
        orientation=number,
        phase_deg=TICK_DEG * tick,
        limit_deg=TICK_DEG * limit,
    )
    assert value_of(path) == value_by_ticks(cell_map, start, tick, objective, tilts, limit)
    assert path is None or is_a_way(cell_map, path, tilts)


@settings(max_examples=60)
@given(cell_maps(), st.data(), st.sampled_from(Objective), tilt_sets)
def test_from_a_formation_no_way_from_any_of_its_occurrences_is_better(
    cell_map: CellMap, data: st.DataObject, objective: Objective, tilts: frozenset[Move]
) -> None:
    formation = data.draw(st.sampled_from(cell_map.formations))
    path = best_path(cell_map, formation, objective, tilts | {Move.COUNTER_CLOCKWISE})
    occurrences = [cell for cell in cell_map.all_cells if cell.formation == formation]
    values = [
        value_by_ticks(cell_map, cell, round(cell.start_deg / TICK_DEG), objective, tilts)
        for cell in occurrences
        if not cell.in_window or all(one.in_window for one in occurrences)
    ]
    assert value_of(path) == min((value for value in values if value is not None), default=None)
    assert path is None or is_a_way(cell_map, path, tilts)
    assert path is None or path.steps[0].cell.formation == formation


def test_it_may_be_best_to_come_back_to_a_cell_for_a_tilt_that_was_passed() -> None:
    ways = (
        orientation_cells(0, [0.0, 180.0], [A, B]),
        orientation_cells(1, [0.0, 45.0, 200.0], [A, C, UNDECIDED], window=[True, False, False]),
        orientation_cells(2, [0.0], [UNDECIDED]),
        orientation_cells(3, [0.0], [UNDECIDED]),
    )
    moves = [Move.COUNTER_CLOCKWISE, Move.PITCH_UP]
    path = best_path(CellMap((0.0, 1.0), ways), A, Objective.TRANSITIONS, moves, orientation=0, phase_deg=100.0)
    assert path is not None
    assert [(s.move, s.cell.orientation, s.phase_deg, s.turning_deg) for s in path.steps] == [
        (None, 0, 100.0, 0.0),
        (Move.COUNTER_CLOCKWISE, 0, 180.0, 80.0),
        (Move.COUNTER_CLOCKWISE, 0, 0.0, 260.0),
        (Move.PITCH_UP, 1, 0.0, 260.0),
    ]
    assert path.transitions == 2


TURN = CellMap(
    (0.0,),
    (
        orientation_cells(
            0,
            [10.0, 100.0, 200.0, 300.0],
            [A, B, A, C],
            window=[False, False, False, True],
            margins=[1.0, None, 3.0, 4.0],
        ),
    ),
)


def test_turning_counts_from_the_phase_or_from_the_start_of_the_occurrence() -> None:
    def turning(phase_deg: float | None, limit_deg: float = 720.0) -> float | None:
        path = best_path(TURN, A, phase_deg=phase_deg, limit_deg=limit_deg)
        return None if path is None else path.turning_deg

    assert turning(30.0) == turning(390.0) == 270.0
    assert turning(None) == 100.0
    assert turning(30.0, 270.0) == 270.0
    assert turning(30.0, 269.0) is None


def test_an_undecided_margin_counts_as_nothing() -> None:
    path = best_path(TURN, A, Objective.MARGIN, phase_deg=30.0)
    assert path is not None
    assert path.worst_margin == 0.0
    short = best_path(TURN, A, Objective.MARGIN)
    assert short is not None
    assert short.worst_margin == 3.0


def test_a_path_from_the_window_is_no_way() -> None:
    path = best_path(TURN, C, phase_deg=0.0)
    assert path is not None
    assert (len(path.steps), path.turning_deg, path.transitions) == (1, 0.0, 0)


def test_what_cannot_be_asked_is_refused() -> None:
    with pytest.raises(InvalidValueError, match="moves"):
        best_path(TURN, A, moves=TILTS)
    with pytest.raises(InvalidValueError, match="moves"):
        best_path(TURN, A, moves=[Move.CLOCKWISE, Move.COUNTER_CLOCKWISE])
    with pytest.raises(InvalidValueError, match="a formation that occurs"):
        best_path(TURN, A, phase_deg=150.0)
    with pytest.raises(InvalidValueError, match="phase"):
        best_path(TURN, A, phase_deg=math.inf)
    with pytest.raises(InvalidValueError, match="orientation is 1; valid: 0 to 0"):
        best_path(TURN, A, orientation=1)
    with pytest.raises(InvalidValueError, match="limit"):
        best_path(TURN, A, limit_deg=math.inf)
    with pytest.raises(NotFoundError, match=UNDECIDED.key):
        best_path(TURN, UNDECIDED)
