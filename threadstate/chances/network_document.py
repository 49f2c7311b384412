"""What sampled paths say, as JSON objects."""

from __future__ import annotations

from typing_extensions import TypedDict

from threadstate.chances.model import Formation, Leaving
from threadstate.chances.network import ChancesNetwork, FormationEdge, FormationNode, Turning
from threadstate.chances.proportion import Chance, Proportion
from threadstate.chances.watch import Located
from threadstate.device.assembly_model import AssemblyOutcome, Held
from threadstate.state.model import FeaturePair, Vector


class ProportionDocument(TypedDict):
    """How many of some paths, and Wilson's interval of 95 %."""

    paths: int
    share: float
    low: float
    high: float


class ChanceDocument(TypedDict):
    """How many of some paths engage: all bounds if the undecided ones fail or engage; ``share`` of the decided ones."""

    paths: int
    engaged: int
    undecided: int
    share: float | None
    least: float
    most: float
    low: float
    high: float


class OutcomeShareDocument(ProportionDocument):
    """How many paths end so."""

    outcome: AssemblyOutcome


class TurningDocument(TypedDict):
    """How far a hand turns until the bolt is assembled, in degrees."""

    paths: int
    mean: float
    q10: float
    median: float
    q90: float


class FormationNodeDocument(ProportionDocument):
    """A formation that paths visit."""

    formation: str
    held: Held
    features: list[FeaturePair]
    visits: int
    begins: int
    reached: float
    turned: float
    torque_low: float
    torque_high: float
    force_low: Vector
    force_high: Vector
    chance: ChanceDocument
    difference: float | None
    distinct: bool


FormationMoveDocument = TypedDict(
    "FormationMoveDocument",
    {"from": str, "to": str, "left": Leaving, "count": int, "probability": float, "low": float, "high": float},
)
"""A move that paths make."""


class ChancesDocument(TypedDict):
    """The network of sampled paths; ``telling`` has the formations, those first that change the chance most."""

    chance: ChanceDocument
    outcomes: list[OutcomeShareDocument]
    bounded: int
    unvisited: int
    turning: TurningDocument | None
    formations: list[FormationNodeDocument]
    moves: list[FormationMoveDocument]
    telling: list[str]


class RemainingDocument(TypedDict):
    """A formation that remains after an observation."""

    formation: str
    points: int
    share: float
    chance: ChanceDocument


class WatchDocument(TypedDict):
    """What an observation says."""

    points: int
    matching: int
    chance: ChanceDocument
    remaining: list[RemainingDocument]


def chances_document(network: ChancesNetwork) -> ChancesDocument:
    """The document of a network."""
    return {
        "chance": chance_document(network.chance),
        "outcomes": [{**_proportion(ends), "outcome": outcome} for outcome, ends in network.outcomes],
        "bounded": network.bounded,
        "unvisited": network.unvisited,
        "turning": None if network.turning is None else _turning(network.turning),
        "formations": [_node(node) for node in network.nodes],
        "moves": [_move(edge) for edge in network.edges],
        "telling": [str(node.formation) for node in network.telling],
    }


def watch_document(found: Located) -> WatchDocument:
    """The document of what an observation says."""
    return {
        "points": found.points,
        "matching": found.matching,
        "chance": chance_document(found.chance),
        "remaining": [
            {
                "formation": str(one.formation),
                "points": one.points,
                "share": one.share,
                "chance": chance_document(one.chance),
            }
            for one in found.remaining
        ],
    }


def chance_document(chance: Chance) -> ChanceDocument:
    """The document of a chance."""
    bounds, interval = chance.bounds, chance.interval
    return {
        "paths": chance.of,
        "engaged": chance.engaged,
        "undecided": chance.undecided,
        "share": chance.share,
        "least": bounds.low,
        "most": bounds.high,
        "low": interval.low,
        "high": interval.high,
    }


def target_text(target: Formation | AssemblyOutcome) -> str:
    """What a move leads to."""
    return target.value if isinstance(target, AssemblyOutcome) else str(target)


def _proportion(found: Proportion) -> ProportionDocument:
    interval = found.interval
    return {"paths": found.count, "share": found.share, "low": interval.low, "high": interval.high}


def _turning(turning: Turning) -> TurningDocument:
    q10, median, q90 = turning.quantiles_deg
    return {"paths": turning.paths, "mean": turning.mean_deg, "q10": q10, "median": median, "q90": q90}


def _node(node: FormationNode) -> FormationNodeDocument:
    return {
        **_proportion(node.visited),
        "formation": str(node.formation),
        "held": node.formation.held,
        "features": list(node.formation.features),
        "visits": node.visits,
        "begins": node.begins,
        "reached": node.reached_deg,
        "turned": node.turned_deg,
        "torque_low": node.torque[0],
        "torque_high": node.torque[1],
        "force_low": node.force_low,
        "force_high": node.force_high,
        "chance": chance_document(node.chance),
        "difference": node.difference,
        "distinct": node.is_distinct,
    }


def _move(edge: FormationEdge) -> FormationMoveDocument:
    interval = edge.moves.interval
    return {
        "from": str(edge.source),
        "to": target_text(edge.target),
        "left": edge.left,
        "count": edge.moves.count,
        "probability": edge.moves.share,
        "low": interval.low,
        "high": interval.high,
    }
