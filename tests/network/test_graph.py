from __future__ import annotations

from math import fsum, isclose

import networkx as nx
import pytest
from hypothesis import given

from tests.network.cell_maps import A, B, C, cell_maps, orientation_cells
from threadstate.errors import InvalidValueError, NotFoundError
from threadstate.network.cells import CellMap
from threadstate.network.formation import Formation
from threadstate.network.graph import ConstraintNetwork, constraint_network
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition

CELL_MAP = CellMap(
    (0.0,), (orientation_cells(0, [10.0, 100.0, 200.0, 250.0], [A, B, B, C], window=[False, False, True, True]),)
)


def test_a_network_of_one_orientation() -> None:
    network = constraint_network(CELL_MAP)
    assert {node.formation: (len(node.cells), node.cover_deg, node.window_share) for node in network.nodes} == {
        A: (1, 90.0, 0.0),
        B: (2, 150.0, 1.0 / 3.0),
        C: (1, 120.0, 1.0),
    }
    assert network.node(A.key).share == 0.25
    assert network.node(A.key).orientations == (0,)
    ccw = {(edge.source, edge.target): edge for edge in network.edges if edge.move is Move.COUNTER_CLOCKWISE}
    assert {ends: edge.cover_deg for ends, edge in ccw.items()} == {(A, B): 90.0, (B, C): 150.0, (C, A): 120.0}
    assert [one.start_deg for one in ccw[B, C].occurrences] == [250.0]
    assert ccw[B, C].orientations == (0,)
    assert {edge.target for edge in network.edges_from(A.key)} == {B, C}
    assert {edge.source for edge in network.edges_to(A.key)} == {B, C}


def test_what_is_not_there_is_not_found() -> None:
    network = constraint_network(CELL_MAP)
    for ask in (network.node, network.edges_from, network.edges_to):
        with pytest.raises(NotFoundError, match="no formation 0123456789 among the 3"):
            ask("0123456789")
    with pytest.raises(InvalidValueError, match="moves"):
        network.by_moves(())


def test_a_formation_without_edges_has_none() -> None:
    network = constraint_network(CellMap((0.0,), (orientation_cells(0, [0.0], [A]),)))
    assert network.edges_from(A.key) == network.edges_to(A.key) == ()


def walked(network: ConstraintNetwork, orientation: int) -> list[tuple[Formation, float]]:
    """One turn counter-clockwise along edges alone: each formation with the phase at which it begins."""
    edges = [
        (one.start_deg, edge)
        for edge in network.edges
        if edge.move is Move.COUNTER_CLOCKWISE
        for one in edge.occurrences
        if one.source.orientation == orientation
    ]
    if not edges:
        return []
    phase, edge = min(edges, key=lambda found: found[0])
    walk = [(edge.target, phase)]
    while True:
        onward = [(at, edge) for at, edge in edges if at > phase and edge.source == walk[-1][0]]
        if not onward:
            return walk
        phase, edge = min(onward, key=lambda found: found[0])
        walk.append((edge.target, phase))


@given(cell_maps())
def test_walking_the_network_along_phase_reproduces_each_history(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    for number, cells in enumerate(cell_map.cells):
        begun = [
            (cell.formation, cell.start_deg)
            for before, cell in zip(cells[-1:] + cells[:-1], cells, strict=True)
            if cell.formation != before.formation
        ]
        assert walked(network, number) == begun


def happens(cell_map: CellMap, one: Transition) -> bool:
    """Whether the cells of the map are those of a transition, right before and right after it."""
    source, target = one.source.orientation, one.target.orientation
    if one.move.turns:
        before = cell_map.at_phase(source, one.start_deg - 1.0)
        after = cell_map.at_phase(target, one.start_deg + 1.0)
        cells = (before, after) if one.move is Move.COUNTER_CLOCKWISE else (after, before)
        return source == target and cells == (one.source, one.target)
    return (one.move, target) in cell_map.neighbours(source) and all(
        (cell_map.at_phase(source, phase), cell_map.at_phase(target, phase)) == (one.source, one.target)
        for phase in (one.start_deg, 0.5 * (one.start_deg + one.end_deg), one.end_deg - 1.0)
    )


@given(cell_maps())
def test_every_boundary_is_an_edge_and_every_edge_occurs(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    edges = {(edge.source, edge.target, edge.move): edge for edge in network.edges}
    assert len(edges) == len(network.edges)
    for cell in cell_map.all_cells:
        after = cell_map.after(cell)
        if after.formation != cell.formation:
            there = edges[cell.formation, after.formation, Move.COUNTER_CLOCKWISE].occurrences
            back = edges[after.formation, cell.formation, Move.CLOCKWISE].occurrences
            assert any((one.source, one.start_deg) == (cell, after.start_deg) for one in there)
            assert any((one.target, one.start_deg) == (cell, after.start_deg) for one in back)
    for edge in network.edges:
        assert edge.occurrences
        assert edge.source != edge.target
        for one in edge.occurrences:
            assert (one.source.formation, one.target.formation, one.move) == (edge.source, edge.target, edge.move)
            assert happens(cell_map, one)


@given(cell_maps())
def test_shares_add_up(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    assert isclose(fsum(node.share for node in network.nodes), 1.0)
    assert sum(len(node.cells) for node in network.nodes) == len(cell_map.all_cells)
    for move in (Move.COUNTER_CLOCKWISE, Move.CLOCKWISE):
        for node in network.nodes:
            alone = [k for k, cells in enumerate(cell_map.cells) if {c.formation for c in cells} == {node.formation}]
            left = fsum(edge.cover_deg for edge in network.edges_from(node.formation.key) if edge.move is move)
            assert left == node.cover_deg - 360.0 * len(alone)


@given(cell_maps())
def test_networkx_has_the_same_nodes_and_edges(cell_map: CellMap) -> None:
    network = constraint_network(cell_map)
    covers = {key: data["cover_deg"] for key, data in network.graph.nodes(data=True)}
    assert covers == {node.formation.key: node.cover_deg for node in network.nodes}
    assert set(network.graph.edges(keys=True, data="cover_deg")) == {
        (edge.source.key, edge.target.key, edge.move, edge.cover_deg) for edge in network.edges
    }
    with pytest.raises(nx.NetworkXError, match="Frozen"):
        network.graph.clear()
