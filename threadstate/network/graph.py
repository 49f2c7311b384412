"""The constraint network: formations as nodes, what leads from one to another as edges."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from math import fsum

import networkx as nx

from threadstate.errors import NotFoundError
from threadstate.network.cells import Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.moves import ALL_MOVES, Move, in_order
from threadstate.network.transitions import Transition, changing_formation, transitions


@dataclass(frozen=True, slots=True)
class Node:
    """A formation and all that occurs of it.

    ``cells`` are its occurrences, by orientation and phase; ``cover_deg`` is their phase, ``share`` that as a part of
    all orientations' phase, ``window_share`` the part of ``cover_deg`` that lies in the clearance window.
    """

    formation: Formation
    cells: tuple[Cell, ...]
    cover_deg: float
    share: float
    window_share: float

    @property
    def orientations(self) -> tuple[int, ...]:
        """The orientations at which the formation occurs, ascending."""
        return tuple(sorted({cell.orientation for cell in self.cells}))


@dataclass(frozen=True, slots=True)
class Edge:
    """All transitions from one formation to another by one move.

    ``cover_deg`` is the phase, over all orientations, in which ``move`` makes ``target`` the next formation.
    """

    source: Formation
    target: Formation
    move: Move
    occurrences: tuple[Transition, ...]
    cover_deg: float

    @property
    def orientations(self) -> tuple[int, ...]:
        """The orientations from which the edge leads, ascending."""
        return tuple(sorted({one.source.orientation for one in self.occurrences}))


@dataclass(frozen=True)
class ConstraintNetwork:
    """Nodes in the order of their keys; edges in that of their source's key, their target's and their move."""

    cell_map: CellMap
    nodes: tuple[Node, ...]
    edges: tuple[Edge, ...]

    @cached_property
    def graph(self) -> nx.MultiDiGraph[str]:
        """The network for networkx: nodes are the formations' keys, edges have the move as their key.

        Numbers are attributes: ``cover_deg`` and ``share`` of nodes, ``cover_deg`` of edges.
        """
        graph: nx.MultiDiGraph[str] = nx.MultiDiGraph()
        for node in self.nodes:
            graph.add_node(node.formation.key, cover_deg=node.cover_deg, share=node.share)
        for edge in self.edges:
            graph.add_edge(edge.source.key, edge.target.key, key=edge.move, cover_deg=edge.cover_deg)
        return nx.freeze(graph)

    def by_moves(self, moves: Collection[Move] = ALL_MOVES) -> nx.DiGraph[str]:
        """The formations' keys, with one edge where any of the moves leads from one to the other."""
        wanted = in_order(moves)
        graph: nx.DiGraph[str] = nx.DiGraph()
        graph.add_nodes_from(node.formation.key for node in self.nodes)
        graph.add_edges_from((edge.source.key, edge.target.key) for edge in self.edges if edge.move in wanted)
        return graph

    def node(self, key: str) -> Node:
        """The node of a formation's key.

        Raises:
            NotFoundError: no formation has that key.
        """
        if key not in self._nodes:
            raise NotFoundError(f"no formation {key} among the {len(self.nodes)} of this network")
        return self._nodes[key]

    def edges_from(self, key: str) -> tuple[Edge, ...]:
        """The edges that leave a formation.

        Raises:
            NotFoundError: no formation has that key.
        """
        return self._edges_from.get(self.node(key).formation.key, ())

    def edges_to(self, key: str) -> tuple[Edge, ...]:
        """The edges that lead to a formation.

        Raises:
            NotFoundError: no formation has that key.
        """
        return self._edges_to.get(self.node(key).formation.key, ())

    @cached_property
    def _nodes(self) -> dict[str, Node]:
        return {node.formation.key: node for node in self.nodes}

    @cached_property
    def _edges_from(self) -> dict[str, tuple[Edge, ...]]:
        found = defaultdict(list)
        for edge in self.edges:
            found[edge.source.key].append(edge)
        return {key: tuple(edges) for key, edges in found.items()}

    @cached_property
    def _edges_to(self) -> dict[str, tuple[Edge, ...]]:
        found = defaultdict(list)
        for edge in self.edges:
            found[edge.target.key].append(edge)
        return {key: tuple(edges) for key, edges in found.items()}


def constraint_network(cell_map: CellMap) -> ConstraintNetwork:
    """The network of all transitions between the formations of the cells.

    Raises:
        InvalidValueError: two formations have the same key.
    """
    cells = defaultdict(list)
    for cell in cell_map.all_cells:
        cells[cell.formation].append(cell)
    nodes = tuple(_node(formation, tuple(cells[formation]), cell_map.total_deg) for formation in cell_map.formations)

    moves = {move: i for i, move in enumerate(Move)}
    found = defaultdict(list)
    for one in changing_formation(transitions(cell_map)):
        found[one.source.formation.key, one.target.formation.key, moves[one.move]].append(one)
    return ConstraintNetwork(cell_map, nodes, tuple(_edge(tuple(found[ends])) for ends in sorted(found)))


def _node(formation: Formation, cells: tuple[Cell, ...], total_deg: float) -> Node:
    cover = fsum(cell.width_deg for cell in cells)
    window = fsum(cell.width_deg for cell in cells if cell.in_window)
    return Node(formation, cells, cover, cover / total_deg, window / cover)


def _edge(occurrences: tuple[Transition, ...]) -> Edge:
    first = occurrences[0]
    cover = fsum(one.cover_deg for one in occurrences)
    return Edge(first.source.formation, first.target.formation, first.move, occurrences, cover)
