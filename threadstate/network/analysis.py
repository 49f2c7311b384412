"""What follows from a network: what comes next, what leads to the window, where it ends, what holds it together."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import networkx as nx
import numpy as np
from numpy.typing import NDArray

from threadstate.network.cells import CIRCLE_DEG, Cell, CellMap
from threadstate.network.formation import Formation
from threadstate.network.graph import ConstraintNetwork
from threadstate.network.moves import ALL_MOVES, SNAP_SEARCH, Move, in_order
from threadstate.statics.verdict import Verdict


@dataclass(frozen=True, slots=True)
class Following:
    """A formation that comes next under a move.

    ``cover_deg`` is the phase of the formation that is left for which it does, ``share`` that as a part of all its
    phase.
    """

    move: Move
    formation: Formation
    cover_deg: float
    share: float


@dataclass(frozen=True, slots=True)
class WindowReach:
    """How far the bolt is turned counter-clockwise, its tilt held, from a formation to the window.

    ``count`` is how many cells of the formation lie outside the window, ``reaching`` how many of them have a window at
    their orientation. ``least_deg`` is the turning from the end of the nearest of these, ``most_deg`` that from the
    start of the farthest; None where there is none.
    """

    formation: Formation
    count: int
    reaching: int
    least_deg: float | None
    most_deg: float | None

    @property
    def share(self) -> float:
        """The part of the cells outside the window from which it is reached; 0 where there are none."""
        return self.reaching / self.count if self.count else 0.0


@dataclass(frozen=True, slots=True)
class IdentifyingFormation:
    """A formation that occurs at one orientation alone: observing it determines the tilt."""

    formation: Formation
    orientation: int
    cover_deg: float


def following(network: ConstraintNetwork, key: str, moves: Collection[Move] = ALL_MOVES) -> tuple[Following, ...]:
    """What can follow a formation: by move, then by falling cover.

    The shares of a turn add up to 1, less the part of the formation that fills the circle of an orientation. Those of
    a tilt lack what lies at the border of the grid and what has the same formation beside it.

    Raises:
        NotFoundError: no formation has that key.
        InvalidValueError: no moves.
    """
    cover = network.node(key).cover_deg
    wanted = in_order(moves)
    edges = sorted(
        (edge for edge in network.edges_from(key) if edge.move in wanted),
        key=lambda edge: (wanted.index(edge.move), -edge.cover_deg, edge.target.key),
    )
    return tuple(Following(edge.move, edge.target, edge.cover_deg, edge.cover_deg / cover) for edge in edges)


def window_reach(network: ConstraintNetwork) -> tuple[WindowReach, ...]:
    """For every formation, in the network's order, how far it is to the window by turning counter-clockwise."""
    turnings = [_turning_to_window(cells) for cells in network.cell_map.cells]
    reaches = []
    for node in network.nodes:
        outside = [cell for cell in node.cells if not cell.in_window]
        known = [
            (turning, turning + cell.width_deg)
            for cell in outside
            if (turning := turnings[cell.orientation][cell.position]) is not None
        ]
        least = min((low for low, _ in known), default=None)
        most = max((high for _, high in known), default=None)
        reaches.append(WindowReach(node.formation, len(outside), len(known), least, most))
    return tuple(reaches)


def _turning_to_window(cells: tuple[Cell, ...]) -> list[float | None]:
    """For every cell of an orientation the turning from its end to the start of the next cell in the window."""
    starts = [cell.start_deg for cell in cells if cell.in_window]
    if not starts:
        return [None] * len(cells)
    found: list[float | None] = [None] * len(cells)
    entry = starts[0] + CIRCLE_DEG
    for cell in reversed(cells):
        found[cell.position] = entry - cell.end_deg
        if cell.in_window:
            entry = cell.start_deg
    return found


def dead_ends(
    network: ConstraintNetwork,
    moves: Collection[Move] = SNAP_SEARCH,
    loaded: CellMap | None = None,
    avoid: frozenset[Verdict] = frozenset(),
) -> tuple[Formation, ...]:
    """The formations from which the window is not reached: from no phase of any occurrence, by any number of the moves.

    A turn passes every phase of its orientation, a tilt leads to the orientation beside it at the same phase. With
    ``loaded``, the network's cells under a load, no move leaves a cell whose verdict is in ``avoid``.

    Raises:
        InvalidValueError: no moves.
    """
    cell_map = loaded or network.cell_map
    numbers = _cells_by_phase(cell_map)
    in_window = np.array([cell.in_window for cell in cell_map.all_cells])
    left = np.array([cell.verdict not in avoid for cell in cell_map.all_cells])
    reaching = _reaching(in_window[numbers], left[numbers], len(cell_map.tilts_deg), in_order(moves))
    found = set(np.unique(numbers[reaching]).tolist())
    escaping = {cell.formation.key for number, cell in enumerate(cell_map.all_cells) if number in found}
    return tuple(formation for formation in cell_map.formations if formation.key not in escaping)


def _cells_by_phase(cell_map: CellMap) -> NDArray[np.intp]:
    """Numbers of cells, counted through all orientations, of shape (orientations, stretches).

    No cell of any orientation begins within a stretch of phase.
    """
    starts = np.unique([cell.start_deg for cell in cell_map.all_cells])
    first, rows = 0, []
    for cells in cell_map.cells:
        places = np.searchsorted([cell.start_deg for cell in cells], starts, side="right") - 1
        rows.append(first + places % len(cells))
        first += len(cells)
    return np.array(rows)


def _reaching(
    window: NDArray[np.bool_], left: NDArray[np.bool_], tilt_count: int, moves: tuple[Move, ...]
) -> NDArray[np.bool_]:
    """Where the window is reached from: ``window`` is of shape (orientations, stretches), and so is the result.

    ``left``, of the same shape, says what a move can leave.
    """
    reaching = window.reshape(tilt_count, tilt_count, -1).copy()
    can_leave = left.reshape(reaching.shape)
    every, low, high = slice(None), slice(None, -1), slice(1, None)
    target_and_source = {
        Move.ROLL_UP: ((high, every), (low, every)),
        Move.ROLL_DOWN: ((low, every), (high, every)),
        Move.PITCH_UP: ((every, high), (every, low)),
        Move.PITCH_DOWN: ((every, low), (every, high)),
    }
    count = -1
    while count != (count := int(reaching.sum())):
        for move in moves:
            if move.turns:
                _turned(reaching, can_leave, 1 if move is Move.COUNTER_CLOCKWISE else -1)
            else:
                target, source = target_and_source[move]
                reaching[source] |= reaching[target] & can_leave[source]
    return reaching.reshape(window.shape)


def _turned(reaching: NDArray[np.bool_], can_leave: NDArray[np.bool_], ahead: int) -> None:
    """Adds the stretches from which a turn leads to one that reaches; ``ahead`` is where the next one is."""
    stretches = reaching.shape[2]
    # Twice round: past phase 0 the turn goes on.
    for i in range(2 * stretches):
        here = (-i if ahead > 0 else i) % stretches
        reaching[:, :, here] |= can_leave[:, :, here] & reaching[:, :, (here + ahead) % stretches]


def strong_parts(network: ConstraintNetwork, moves: Collection[Move] = ALL_MOVES) -> tuple[tuple[Formation, ...], ...]:
    """The strongly connected parts under the moves, the largest first; within a part each formation leads to each.

    Raises:
        InvalidValueError: no moves.
    """
    parts = [tuple(sorted(part)) for part in nx.strongly_connected_components(network.by_moves(moves))]
    parts.sort(key=lambda part: (-len(part), part))
    return tuple(tuple(network.node(key).formation for key in part) for part in parts)


def cut_formations(network: ConstraintNetwork, moves: Collection[Move] = ALL_MOVES) -> tuple[Formation, ...]:
    """The formations without which the network falls into more parts, direction left aside: its articulation points.

    Raises:
        InvalidValueError: no moves.
    """
    keys = nx.articulation_points(network.by_moves(moves).to_undirected(as_view=True))
    return tuple(network.node(key).formation for key in sorted(keys))


def identifying_formations(network: ConstraintNetwork) -> tuple[IdentifyingFormation, ...]:
    """The formations that identify an orientation, by orientation and then by falling cover."""
    found = [
        IdentifyingFormation(node.formation, node.orientations[0], node.cover_deg)
        for node in network.nodes
        if len(node.orientations) == 1
    ]
    return tuple(sorted(found, key=lambda one: (one.orientation, -one.cover_deg, one.formation.key)))
