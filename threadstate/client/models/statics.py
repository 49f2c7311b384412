"""What a load does to a contact state."""

from __future__ import annotations

from typing import Literal

from threadstate.client.models.answer import Answer, Vector
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


class Statics(Answer):
    """What a load does to the state of a pose, at a friction.

    ``mu_hold`` and ``mu_wedge`` are None where no friction is known to hold the load, or to wedge the bolt; an effort
    is None where no torque turns the bolt that way. ``penetrating``: the solids overlap, so that no forces can be real.
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


class StaticsAnswer(Answer):
    """The statics of each pose under each load: the loads of the first pose in their order, then those of the next."""

    designation: str
    library: int | None
    unit: LengthUnit
    statics: tuple[Statics, ...]
