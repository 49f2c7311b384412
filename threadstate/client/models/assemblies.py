"""Paths of bolts that a compliant device settles and turns."""

from __future__ import annotations

from threadstate.client.models.answer import Answer, Vector
from threadstate.client.models.settled import Deviation, Settled, SettledContact
from threadstate.client.models.states import Pose
from threadstate.device.assembly_model import AssemblyOutcome, ContactMotion, Held, PathEventKind
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair
from threadstate.units import LengthUnit


class AssemblyEvent(Answer):
    """An event of a path, between two phases in degrees; None where it has none of a kind."""

    kind: PathEventKind
    phase: float
    from_phase: float
    features_before: FeaturePair | None
    features: FeaturePair | None
    point: Vector | None
    drop: float | None
    way: float | None
    energy: float | None


class AssemblyPath(Answer):
    """The points of a path, as many of each kind of number."""

    phase: tuple[float, ...]
    held: tuple[Held, ...]
    pose: tuple[Pose, ...]
    deviation: tuple[Deviation, ...]
    contacts: tuple[tuple[SettledContact, ...], ...]
    motions: tuple[tuple[ContactMotion, ...], ...]
    torque: tuple[float, ...]
    elastic_energy: tuple[float, ...]
    potential: tuple[float, ...]


class AssemblyEnergy(Answer):
    """Where the energy of a path went, in N times the unit."""

    work: float
    push: float
    elastic: float
    friction: float
    falls: float
    balance: float


class AssemblyMargins(Answer):
    """How far an outcome is from another one; None where a rule was not asked."""

    lead: float | None
    play: float | None
    tilt: float | None
    torque: float
    offset: float
    snap: float | None


class AssemblyTravel(Answer):
    """What a path asks of the device: torque in N times the unit, tilt in degrees, shift."""

    torque: float
    tilt: float
    shift: float


class Assembly(Answer):
    """The path of a bolt that is settled and turned; energy, margins and travel are None where it does not settle."""

    roll: float
    pitch: float
    phase: float
    unit: LengthUnit
    strategy: Strategy
    mu: float
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    start: Settled
    events: tuple[AssemblyEvent, ...]
    path: AssemblyPath
    energy: AssemblyEnergy | None
    margins: AssemblyMargins | None
    travel: AssemblyTravel | None


class AssemblyProgress(Answer):
    """How far a path is: the number of its turn (0 while the bolt settles), its points, the phase of the last one
    in degrees, and events that are new.
    """

    leg: int
    points: int
    phase: float | None
    events: tuple[AssemblyEvent, ...]
