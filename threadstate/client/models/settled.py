"""Where a bolt comes to rest that a compliant device holds."""

from __future__ import annotations

from threadstate.client.models.answer import Answer, Vector
from threadstate.client.models.states import Pose
from threadstate.device.model import Outcome, SettledFlag
from threadstate.state.model import FeaturePair
from threadstate.units import LengthUnit


class Deviation(Answer):
    """How far a device gives way: the shift of its centre, and a rotation vector in degrees."""

    shift: Vector
    rotation: Vector


class SettledContact(Answer):
    """A contact with the force on the bolt, in N."""

    point: Vector
    normal: Vector
    features: FeaturePair
    force: Vector


class Fall(Answer):
    """A fall on the way: the push in N, how far the origin sank and how far it went, and the potential lost."""

    push: float
    drop: float
    way: float
    energy: float


class SettledMargins(Answer):
    """How far a settled state is from its next event; None where it has none of the kind."""

    force: float | None
    gap: float | None
    stability: float | None
    residual: float | None
    pressure: float | None


class Settled(Answer):
    """A settled state; where it is not settled pose, deviation and energy are None, and there are no contacts."""

    roll: float
    pitch: float
    phase: float
    unit: LengthUnit
    outcome: Outcome
    pose: Pose | None
    deviation: Deviation | None
    contacts: tuple[SettledContact, ...]
    elastic_energy: float | None
    falls: tuple[Fall, ...]
    flags: tuple[SettledFlag, ...]
    margins: SettledMargins


class SettleAnswer(Answer):
    """The settled states of the poses, in their order."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    states: tuple[Settled, ...]
