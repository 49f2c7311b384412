"""The path of a bolt that a device pushes and turns, and how it ends: frozen values (docs/device.md)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from threadstate.device.model import LoadedContact, SettledFlag, SettledState
from threadstate.device.strategy import Strategy
from threadstate.state.model import FeaturePair, StagePose, Vector


class AssemblyOutcome(StrEnum):
    """How a path ends (forces, section 5)."""

    ENGAGED = "engaged"
    """The threads are in phase, and the bolt goes down by the lead."""
    CROSS_THREADED = "cross_threaded"
    """The bolt goes down by the lead, but not in phase."""
    JAMMED = "jammed"
    """No equilibrium goes on, or the torque has passed its limit, or the device's."""
    NO_SNAP = "no_snap"
    """The counter-clockwise turn, by default a whole one, ends without a snap."""
    IDLE = "idle"
    """None of these: the bolt turns on the nut without following the thread."""
    SLIPPED = "slipped"
    """The bolt has left the nut sideways by more than half its major diameter."""
    OVER_TRAVEL = "over_travel"
    """The device has passed its limit of tilt or shift."""
    UNDECIDED = "undecided"
    """No certain answer; a flag says why."""


class Held(StrEnum):
    """What holds the bolt at a point of a path."""

    CONTACTS = "contacts"
    """Contacts at points."""
    SURFACE = "surface"
    """The nut's surface, on which the base lies flush; the contact is the resultant of the pressure."""
    STRIP = "strip"
    """A strip of flank, level and in phase; the contacts are points of it whose forces balance the push."""


class PathEventKind(StrEnum):
    """What happens on a path between two of its points."""

    GAINED = "gained"
    """A contact begins to carry a force."""
    LOST = "lost"
    """A contact carries no force any more."""
    MOVED = "moved"
    """A contact moves to other features."""
    FALL = "fall"
    """The minimum that the bolt followed ends, and it falls to another one."""
    FRICTIONLESS_FALL = "frictionless_fall"
    """With friction no step of the fall went on: the bolt fell as one without friction."""
    SNAP = "snap"
    """The counter-clockwise turn ends: the origin has gone down onto a thread."""
    ON_SURFACE = "on_surface"
    """The base comes to lie flush on the nut's surface."""
    OFF_SURFACE = "off_surface"
    """The base leaves the surface."""
    ON_STRIP = "on_strip"
    """The bolt comes to lie level on a strip of flank."""
    OFF_STRIP = "off_strip"
    """The bolt leaves the strip."""
    AMBIGUOUS = "ambiguous"
    """With friction the step has several solutions."""
    BRIDGED = "bridged"
    """No shorter step had a certain end: within this one the path is not resolved."""


class ContactMotion(StrEnum):
    """What a contact with friction does in the step before a point."""

    STICKS = "sticks"
    """The bolt's point there stays on the nut's."""
    SLIDES = "slides"
    """It slides, and friction opposes that."""


@dataclass(frozen=True, slots=True)
class PathEvent:
    """An event of a path: it happens between ``from_deg`` and ``phase_deg``.

    Features are those of a contact before and after, its point is in the nut's frame (of a fall, the compliance centre
    after it). A fall has a drop of the origin, the way it went (lengths) and the potential lost (N times the unit).
    """

    kind: PathEventKind
    phase_deg: float
    from_deg: float
    features_before: FeaturePair | None = None
    features: FeaturePair | None = None
    point: Vector | None = None
    drop: float | None = None
    way: float | None = None
    energy: float | None = None


@dataclass(frozen=True, slots=True)
class AssemblyPoint:
    """An equilibrium on a path: the command's phase, the bolt's pose, and what device and contacts do.

    ``shift`` and ``rotation_deg`` are the device's deviation as of a settled state. ``torque`` is the hand's work a
    radian of counter-clockwise phase, energies are in N times the pair's unit. ``motions`` are those of the contacts in
    the step that ends here, and ``solutions`` how many it had: none and 1 without friction, 0 after a fall with it.
    """

    phase_deg: float
    held: Held
    pose: StagePose
    shift: Vector
    rotation_deg: Vector
    contacts: tuple[LoadedContact, ...]
    torque: float
    elastic_energy: float
    potential: float
    motions: tuple[ContactMotion, ...] = ()
    solutions: int = 1


@dataclass(frozen=True, slots=True)
class AssemblyEnergy:
    """Where the energy of a path went, in N times the pair's unit.

    ``work`` is the hand's, the torque summed over the phase; ``push`` that of the push; ``elastic`` the change of the
    elastic energy; ``friction`` and ``falls`` are losses. ``balance`` is what the sum leaves: work and push less all
    others.
    """

    work: float
    push: float
    elastic: float
    friction: float
    falls: float
    balance: float


@dataclass(frozen=True, slots=True)
class AssemblyMargins:
    """How far a path's outcome is from another one; positive where a rule holds, None where it was not asked.

    ``lead`` is by how much the height follows the lead better than within 5 %, over the last 90 deg of the clockwise
    turn; ``play`` how far inside the play in phase the last height is (a length); ``tilt_deg`` by how much the last
    tilt is below what the play allows; ``torque`` by how much the largest torque is below its limit, or the device's,
    over push times nominal radius; ``offset`` how far the origin stayed from slipping (a length); ``snap`` by how much
    the snap is deeper than it has to be (a length).
    """

    lead: float | None
    play: float | None
    tilt_deg: float | None
    torque: float
    offset: float
    snap: float | None


@dataclass(frozen=True, slots=True)
class AssemblyTravel:
    """What a path asks of the device: the largest torque (N times the unit), tilt and shift of its centre."""

    torque: float
    tilt_deg: float
    shift: float


@dataclass(frozen=True, slots=True)
class AssemblyPath:
    """A bolt settled at a pose and turned (forces, section 5).

    ``start`` is the settled state. Where it is not settled there are no points, and energy, margins and travel are
    None. Lengths are in the pair's unit.
    """

    start: SettledState
    strategy: Strategy
    mu: float
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    events: tuple[PathEvent, ...]
    points: tuple[AssemblyPoint, ...]
    energy: AssemblyEnergy | None
    margins: AssemblyMargins | None
    travel: AssemblyTravel | None
