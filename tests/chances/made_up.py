"""Made-up paths and records."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.chances.model import Formation, Leaving, LegName, Reading, Record, Visit
from threadstate.chances.sampling import Approach
from threadstate.device.assembly_model import (
    AssemblyOutcome,
    AssemblyPath,
    AssemblyPoint,
    AssemblyTravel,
    Held,
    PathEvent,
)
from threadstate.device.model import LoadedContact, Outcome, SettledMargins, SettledState
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair, StagePose, Vector

EDGES = Formation(Held.CONTACTS, (FeaturePair.EDGE_EDGE, FeaturePair.EDGE_EDGE))
THREAD = Formation(Held.CONTACTS, (FeaturePair.EDGE_THREAD, FeaturePair.THREAD_EDGE))
FLUSH = Formation(Held.SURFACE, (FeaturePair.FLUSH,))
LEVEL = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def visit(
    formation: Formation,
    from_deg: float,
    to_deg: float,
    left: Leaving,
    *,
    torque: float = 0.1,
    force: Vector = (0.0, 0.0, 10.0),
) -> Visit:
    """A clockwise visit with a reading at its begin and one in its middle."""
    phases = (from_deg, 0.5 * (from_deg + to_deg))
    return Visit(formation, LegName.CW, from_deg, to_deg, left, tuple(Reading(one, torque, force) for one in phases))


def record(index: int, outcome: AssemblyOutcome, *visits: Visit, assembled_deg: float | None = None) -> Record:
    """The record of a path with these visits; without any its start is not settled."""
    one = Approach(index, 0.5, -0.5, 10.0 * index, 0.1)
    if not visits:
        return Record(one, outcome, (), False, None, None, None, None, None, ())
    turned = sum(found.turned_deg for found in visits)
    return Record(one, outcome, (), False, turned, assembled_deg, 0.1, 1.0, 0.01, visits)


def records() -> list[Record]:
    """Two paths that engage by the thread, one that stays on the edges, one undecided, one that does not settle."""
    return [
        record(
            0,
            AssemblyOutcome.ENGAGED,
            visit(EDGES, 0.0, -90.0, Leaving.GAINED),
            visit(THREAD, -90.0, -270.0, Leaving.END, torque=0.3, force=(1.0, -2.0, 10.0)),
            assembled_deg=100.0,
        ),
        record(
            1,
            AssemblyOutcome.ENGAGED,
            visit(EDGES, 0.0, -30.0, Leaving.GAINED),
            visit(THREAD, -30.0, -60.0, Leaving.LOST, torque=0.5),
            visit(EDGES, -60.0, -90.0, Leaving.FALL),
            visit(THREAD, -90.0, -270.0, Leaving.END),
            assembled_deg=200.0,
        ),
        record(2, AssemblyOutcome.IDLE, visit(EDGES, 0.0, -270.0, Leaving.END)),
        record(3, AssemblyOutcome.UNDECIDED, visit(FLUSH, 0.0, -20.0, Leaving.END)),
        record(4, AssemblyOutcome.UNDECIDED),
    ]


def point(
    phase_deg: float, features: Sequence[FeaturePair], held: Held = Held.CONTACTS, z: float = 0.0
) -> AssemblyPoint:
    """A point of a path; each contact has a force of 1 N along x and 2 N along z."""
    contacts = [LoadedContact((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), one, (1.0, 0.0, 2.0)) for one in features]
    pose = StagePose(LEVEL, (0.0, 0.0, z))
    return AssemblyPoint(phase_deg, held, pose, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), tuple(contacts), 0.25, 0.0, 0.0)


def path(
    points: Sequence[AssemblyPoint],
    events: Sequence[PathEvent] = (),
    strategy: Strategy = Strategy.CW,
    outcome: AssemblyOutcome = AssemblyOutcome.IDLE,
) -> AssemblyPath:
    """A path with these points."""
    margins = SettledMargins(None, None, None, None, None)
    settled = Outcome.SETTLED if points else Outcome.UNDECIDED
    start = SettledState(0.0, 0.0, 0.0, settled, (), None, None, None, (), None, (), margins, ())
    travel = AssemblyTravel(0.25, 1.0, 0.01) if points else None
    return AssemblyPath(start, strategy, 0.1, outcome, (), tuple(events), tuple(points), None, None, travel)
