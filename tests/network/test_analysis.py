from __future__ import annotations

from math import fsum

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.network.cell_maps import TICK_DEG, TICKS, UNDECIDED, A, B, C, cell_maps, orientation_cells
from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.network import analysis
from threadstate.network.cells import CellMap
from threadstate.network.formation import Formation
from threadstate.network.graph import constraint_network
from threadstate.network.moves import ALL_MOVES, SNAP_SEARCH, TILTS, Move

CELLS = (
    orientation_cells(0, [10.0, 100.0, 200.0, 300.0], [A, B, A, C], window=[False, False, False, True]),
    orientation_cells(1, [10.0, 180.0], [A, B]),
    orientation_cells(2, [0.0], [UNDECIDED]),
    orientation_cells(3, [0.0, 90.0], [B, A]),
)
NETWORK = constraint_network(CellMap((0.0, 1.0), CELLS))


def test_what_can_follow_a_formation() -> None:
    found = analysis.following(NETWORK, B.key, [Move.COUNTER_CLOCKWISE, Move.ROLL_UP])
    assert [(one.move, one.formation, one.cover_deg, one.share) for one in found] == [
        (Move.COUNTER_CLOCKWISE, A, 380.0, 1.0),
        (Move.ROLL_UP, A, 180.0, 180.0 / 380.0),
        (Move.ROLL_UP, UNDECIDED, 100.0, 100.0 / 380.0),
    ]
    with pytest.raises(NotFoundError):
        analysis.following(NETWORK, "0123456789")


def test_how_far_it_is_to_the_window() -> None:
    found = {reach.formation: reach for reach in analysis.window_reach(NETWORK)}
    assert found[A] == analysis.WindowReach(A, 4, 2, 0.0, 290.0)
    assert found[A].share == 0.5
    assert found[B] == analysis.WindowReach(B, 3, 1, 100.0, 200.0)
    assert found[C] == analysis.WindowReach(C, 0, 0, None, None)
    assert found[C].share == 0.0
    assert found[UNDECIDED] == analysis.WindowReach(UNDECIDED, 1, 0, None, None)


def test_past_the_window_the_way_leads_around() -> None:
    cells = orientation_cells(0, [10.0, 100.0, 200.0], [A, B, C], window=[False, True, False])
    network = constraint_network(CellMap((0.0,), (cells,)))
    found = {reach.formation: (reach.least_deg, reach.most_deg) for reach in analysis.window_reach(network)}
    assert found == {A: (0.0, 90.0), B: (None, None), C: (90.0, 260.0)}


def test_dead_ends() -> None:
    assert analysis.dead_ends(NETWORK) == (UNDECIDED,)
    assert analysis.dead_ends(NETWORK, SNAP_SEARCH | TILTS) == ()
    # Without turning, tilting down, the window is reached from its own phases: from B at orientation 1, but not
    # from A, which is only elsewhere at these phases.
    assert set(analysis.dead_ends(NETWORK, [Move.PITCH_DOWN])) == {UNDECIDED, A}
    with pytest.raises(InvalidValueError):
        analysis.dead_ends(NETWORK, [])


@given(cell_maps(), st.sets(st.sampled_from(Move), min_size=1))
def test_dead_ends_are_those_from_which_no_pose_of_a_fine_grid_leads_to_the_window(
    cell_map: CellMap, moves: set[Move]
) -> None:
    poses: nx.DiGraph[tuple[int, int]] = nx.DiGraph()
    for number in range(cell_map.orientation_count):
        for tick in range(TICKS):
            steps = {
                **{move: (beside, tick) for move, beside in cell_map.neighbours(number)},
                Move.COUNTER_CLOCKWISE: (number, (tick + 1) % TICKS),
                Move.CLOCKWISE: (number, (tick - 1) % TICKS),
            }
            poses.add_node((number, tick))
            poses.add_edges_from(((number, tick), steps[move]) for move in moves if move in steps)
    cell_at = {pose: cell_map.at_phase(pose[0], TICK_DEG * pose[1]) for pose in poses}
    targets = {pose for pose, cell in cell_at.items() if cell.in_window}
    escaping = targets | {pose for target in targets for pose in nx.ancestors(poses, target)}
    network = constraint_network(cell_map)
    expected = set(cell_map.formations) - {cell_at[pose].formation for pose in escaping}
    assert set(analysis.dead_ends(network, moves)) == expected


def test_parts_and_cuts() -> None:
    ring = constraint_network(CellMap((0.0,), (orientation_cells(0, [0.0, 90.0, 180.0, 270.0], [A, B, C, B]),)))
    assert [set(part) for part in analysis.strong_parts(ring)] == [{A, B, C}]
    assert analysis.cut_formations(ring) == (B,)
    apart = analysis.strong_parts(NETWORK, SNAP_SEARCH)
    assert [set(part) for part in apart] == [{A, B, C}, {UNDECIDED}]


@given(cell_maps())
def test_without_a_cut_formation_there_are_more_parts(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    graph = network.by_moves(ALL_MOVES).to_undirected()
    count = nx.number_connected_components(graph)
    cuts: set[Formation] = set()
    for formation in cell_map.formations:
        rest = graph.copy()
        rest.remove_node(formation.key)
        if len(rest) and nx.number_connected_components(rest) > count:
            cuts.add(formation)
    assert set(analysis.cut_formations(network)) == cuts


def test_formations_that_tell_an_orientation_apart() -> None:
    assert analysis.identifying_formations(NETWORK) == (
        analysis.IdentifyingFormation(C, 0, 70.0),
        analysis.IdentifyingFormation(UNDECIDED, 2, 360.0),
    )


@given(cell_maps(), st.sampled_from(Move))
def test_shares_of_what_follows_are_at_most_1(cell_map: CellMap, move: Move) -> None:
    network = constraint_network(cell_map)
    for formation in cell_map.formations:
        assert fsum(one.share for one in analysis.following(network, formation.key, [move])) <= 1.0 + 1e-12
