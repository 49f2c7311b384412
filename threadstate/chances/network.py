"""The network of formations that sampled paths visit: how likely each is, where it leads, and what it tells.

Angles are in degrees, forces in N, torques in N times the pair's unit.
"""

from __future__ import annotations

import itertools
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.chances.model import Formation, Leaving, Record, Visit
from threadstate.chances.proportion import Chance, Proportion, chance_of
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.errors import InvalidValueError
from threadstate.state.model import Vector

QUANTILES = (0.1, 0.5, 0.9)


@dataclass(frozen=True)
class FormationNode:
    """A formation that paths visit.

    Attributes:
        formation: what holds the bolt.
        visited: the paths that visit it, of all.
        visits: how often they do.
        begins: how many paths begin with it.
        reached_deg: mean turning until the first visit, of the paths that visit it.
        turned_deg: mean turning in it, of the paths that visit it.
        torque: least and largest torque of the hand.
        force_low, force_high: least and largest components of the force on the hand, in the nut's frame.
        chance: how many of the paths that visit it engage.
        difference: the share of them that engages less that of all paths; None where one has no decided path.
        is_distinct: whether the share of all paths is outside the interval of ``chance``.
    """

    formation: Formation
    visited: Proportion
    visits: int
    begins: int
    reached_deg: float
    turned_deg: float
    torque: tuple[float, float]
    force_low: Vector
    force_high: Vector
    chance: Chance
    difference: float | None
    is_distinct: bool


@dataclass(frozen=True, slots=True)
class FormationEdge:
    """A move that paths make: from a formation to another one, or to the outcome of a path that ends there.

    ``moves`` are how many of the visits of ``source`` are left so.
    """

    source: Formation
    target: Formation | AssemblyOutcome
    left: Leaving
    moves: Proportion


@dataclass(frozen=True, slots=True)
class Turning:
    """How far a hand turns until the bolt is assembled, over the paths that engage; ``quantiles`` as ``QUANTILES``."""

    paths: int
    mean_deg: float
    quantiles_deg: tuple[float, ...]


@dataclass(frozen=True)
class ChancesNetwork:
    """What sampled paths say.

    Attributes:
        chance: how many paths engage.
        outcomes: how many paths end with each outcome that occurs, the most frequent one first.
        bounded: how many were not followed to their end.
        unvisited: how many have no visits: those and the ones whose start is not settled.
        nodes: the formations, those first that more paths visit.
        edges: the moves, by their source as nodes are, the most frequent one first.
        turning: how far a hand turns until the bolt is assembled; None where no path engages.
    """

    chance: Chance
    outcomes: tuple[tuple[AssemblyOutcome, Proportion], ...]
    bounded: int
    unvisited: int
    nodes: tuple[FormationNode, ...]
    edges: tuple[FormationEdge, ...]
    turning: Turning | None

    @property
    def telling(self) -> tuple[FormationNode, ...]:
        """The formations by how much they change the chance to engage: what a sensor should watch for.

        Of equal differences the one first that more paths visit. Those of which nothing is decided are left out.
        """
        found = [node for node in self.nodes if node.difference is not None]
        return tuple(sorted(found, key=lambda node: (-abs(node.difference or 0.0), -node.visited.count)))


def network_of(records: Sequence[Record]) -> ChancesNetwork:
    """The network of sampled paths.

    Raises:
        InvalidValueError: there are none.
    """
    if not records:
        raise InvalidValueError("samples", 0, "one or more")
    overall = chance_of(records)
    ends = Counter(record.outcome for record in records)
    ranked = sorted(ends, key=lambda outcome: (-ends[outcome], outcome))
    visits = _by_formation(records)
    begins = Counter(record.visits[0].formation for record in records if record.visits)
    nodes = [_node(one, found, begins[one], len(records), overall) for one, found in visits.items()]
    nodes.sort(key=lambda node: (-node.visited.count, node.formation))
    moves = _moves(records)
    return ChancesNetwork(
        overall,
        tuple((outcome, Proportion(ends[outcome], len(records))) for outcome in ranked),
        sum(record.is_bounded for record in records),
        sum(not record.visits for record in records),
        tuple(nodes),
        tuple(edge for node in nodes for edge in _edges(node, moves)),
        _turning([record.assembled_deg for record in records if record.assembled_deg is not None]),
    )


def quantile(values: Sequence[float], fraction: float) -> float:
    """The value below which a part of the values lies, on straight lines between them; at least one value."""
    ordered = sorted(values)
    place = fraction * (len(ordered) - 1)
    before = math.floor(place)
    after = min(before + 1, len(ordered) - 1)
    return ordered[before] + (place - before) * (ordered[after] - ordered[before])


def reached_deg(record: Record, formation: Formation) -> float:
    """How far the hand has turned when a path first has a formation, which it visits."""
    before = itertools.takewhile(lambda visit: visit.formation != formation, record.visits)
    return math.fsum(visit.turned_deg for visit in before)


Move = tuple[Formation, Formation | AssemblyOutcome, Leaving]


def _by_formation(records: Sequence[Record]) -> dict[Formation, list[tuple[Record, Visit]]]:
    found: dict[Formation, list[tuple[Record, Visit]]] = {}
    for record in records:
        for visit in record.visits:
            found.setdefault(visit.formation, []).append((record, visit))
    return found


def _node(
    formation: Formation, visits: Sequence[tuple[Record, Visit]], begins: int, paths: int, overall: Chance
) -> FormationNode:
    visiting = {record.approach.index: record for record, _ in visits}
    readings = [reading for _, visit in visits for reading in visit.readings]
    torques = [reading.torque for reading in readings]
    axes = tuple(zip(*(reading.force for reading in readings), strict=True))
    low_x, low_y, low_z = map(min, axes)
    high_x, high_y, high_z = map(max, axes)
    chance = chance_of(visiting.values())
    ours, of_all = chance.share, overall.share
    interval = chance.interval
    return FormationNode(
        formation,
        Proportion(len(visiting), paths),
        len(visits),
        begins,
        math.fsum(reached_deg(record, formation) for record in visiting.values()) / len(visiting),
        math.fsum(visit.turned_deg for _, visit in visits) / len(visiting),
        (min(torques), max(torques)),
        (low_x, low_y, low_z),
        (high_x, high_y, high_z),
        chance,
        None if ours is None or of_all is None else ours - of_all,
        of_all is not None and not interval.low <= of_all <= interval.high,
    )


def _moves(records: Sequence[Record]) -> Counter[Move]:
    moves: Counter[Move] = Counter()
    for record in records:
        later: list[Formation | AssemblyOutcome] = [visit.formation for visit in record.visits[1:]]
        for visit, target in zip(record.visits, [*later, record.outcome], strict=False):
            moves[visit.formation, target, visit.left] += 1
    return moves


def _edges(node: FormationNode, moves: Counter[Move]) -> list[FormationEdge]:
    out = [(count, move) for move, count in moves.items() if move[0] == node.formation]
    out.sort(key=lambda one: (-one[0], str(one[1][1]), one[1][2]))
    return [FormationEdge(*move, Proportion(count, node.visits)) for count, move in out]


def _turning(assembled_deg: Sequence[float]) -> Turning | None:
    if not assembled_deg:
        return None
    mean = math.fsum(assembled_deg) / len(assembled_deg)
    return Turning(len(assembled_deg), mean, tuple(quantile(assembled_deg, one) for one in QUANTILES))
