"""What a load does to a contact state."""

from __future__ import annotations

from typing import Literal

from threadstate.client.models.answer import Answer, Vector
from threadstate.responses.documents import HeldDocument
from threadstate.statics.verdict import Verdict
from threadstate.units import LengthUnit


class Load(Answer):
    """A load on the bolt in the nut's frame: force in N, moment in N times the unit of length about ``point``."""

    force: Vector
    moment: Vector
    point: Vector
    frame: Literal["nut"]


class ContactForce(Answer):
    """The force on the bolt at a contact, in N: its normal part, and its tangential one in the nut's frame.

    ``contact`` counts from 1: the state's contacts, then the hull of its patch.
    """

    contact: int
    normal: float
    tangential: Vector


class Reaction(Answer):
    """The least wrench on the bolt that must be added to a load so that the contacts balance it, in the nut's frame.

    The moment is about ``point``, the bolt's origin; ``size`` is its norm in N with moments over the nominal radius,
    and no wrench of a smaller size than ``least_size`` will do.
    """

    force: Vector
    moment: Vector
    point: Vector
    frame: Literal["nut"]
    size: float
    least_size: float


class NormalRange(Answer):
    """The least and the largest normal force of a contact among all balancing forces, in N.

    The largest is None where contacts wedge; the true ends may lie beyond these by ``uncertainty``.
    """

    contact: int
    normal_min: float
    normal_max: float | None
    uncertainty: float


class Twist(Answer):
    """A velocity of the bolt in the nut's frame, for a medium in which 1 N on its origin gives it the velocity 1."""

    angular: Vector
    linear: Vector
    point: Vector
    frame: Literal["nut"]


class ContactWrench(Answer):
    """A contact that carries forces in the last pose, with the wrench of 1 N along its normal, in the nut's frame.

    The moment is about the load's point; ``contact`` counts as that of a force.
    """

    contact: int
    point: Vector
    normal: Vector
    moment: Vector


class ContactMode(Answer):
    """A way in which contacts can open, stick or slide under the load; of an undecided one nothing else is known."""

    contacts: tuple[Literal["sticks", "slides", "opens"], ...]
    status: Literal["consistent", "marginal", "undecided"]
    twist: Twist | None
    forces: tuple[ContactForce, ...]
    margin: float | None


class Statics(Answer):
    """What a load does to the state of a pose, at a friction.

    ``mu_hold`` and ``mu_wedge`` are None where no friction is known to hold the load, or to wedge the bolt; an effort
    is None where no torque turns the bolt that way. ``penetrating``: the solids overlap, so that no forces can be real.
    What was not requested is None: ``reaction``, ``forces_range`` with ``internal_dimension``, ``wrenches`` with
    ``hull_gap``, and ``modes``, which are None of a patch as well.
    """

    roll: float
    pitch: float
    phase: float
    load: Load
    mu: float
    penetrating: bool
    supported: bool
    support_margin: float
    mu_hold: float | None
    mu_wedge: float | None
    turn_effort_ccw: float | None
    turn_effort_cw: float | None
    forces: tuple[ContactForce, ...]
    verdict: Verdict
    reaction: Reaction | None = None
    forces_range: tuple[NormalRange, ...] | None = None
    internal_dimension: int | None = None
    modes: tuple[ContactMode, ...] | None = None
    wrenches: tuple[ContactWrench, ...] | None = None
    hull_gap: float | None = None


class StaticsAnswer(Answer):
    """The statics of each pose under each load: the loads of the first pose in their order, then those of the next."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    statics: tuple[Statics, ...]


Axis = Literal["fx", "fy", "mx", "my", "mz"]
PlanePoint = tuple[float, float]


class LoadedContact(Answer):
    """A contact that carries a force on a piece of the boundary of a jamming diagram."""

    contact: int
    mode: Literal["sticks", "slides"]
    side: Literal["up", "down", "out", "in", "ccw", "cw"] | None
    friction_start: Vector | None
    friction_end: Vector | None


class Piece(Answer):
    """A piece of the boundary of a jamming diagram: from vertex ``first`` to vertex ``last``, counter-clockwise."""

    first: int
    last: int
    straight: bool
    window: bool
    contacts: tuple[LoadedContact, ...]


class Jamming(Answer):
    """The loads over their push that the contacts of a state can balance, in a plane of loads.

    Moments are over the nominal radius as well. ``rays`` are extreme directions in which the diagram has no end; it
    reaches beyond ``vertices`` by no more than ``gap``.
    """

    roll: float
    pitch: float
    phase: float
    mu: float
    axes: tuple[Axis, Axis]
    load: Load
    load_at: PlanePoint
    contacts: tuple[int, ...]
    kind: Literal["empty", "point", "segment", "bounded", "unbounded", "plane"]
    dimension: int | None
    vertices: tuple[PlanePoint, ...]
    pieces: tuple[Piece, ...]
    rays: tuple[PlanePoint, ...]
    window: PlanePoint | None
    gap: float
    hull_gap: float
    wedged: tuple[int, ...]
    penetrating: bool


class ComputedJamming(Jamming):
    """The same of any pose, computed on request."""

    designation: str
    source: str | None
    library: int | None


class HeldAnswer(Answer):
    """What a load does along the phase of an orientation, at each friction."""

    library: int
    held: tuple[HeldDocument, ...]


class ComputedHeld(Answer):
    """The same of any orientation, computed on request."""

    designation: str
    source: str | None
    library: int | None
    held: tuple[HeldDocument, ...]
