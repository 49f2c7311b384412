"""Where a bolt comes to rest that a compliant device holds."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from typing import Literal

from threadstate.client.models.answer import Answer, Vector
from threadstate.client.models.libraries import GridDocument
from threadstate.client.models.states import Pose
from threadstate.device.model import About, Outcome, SettledFlag
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


class Device(Answer):
    """The device of a library of settled states, lengths in its own unit: four stiffnesses, or all as a matrix."""

    unit: LengthUnit
    k_lateral: float | None = None
    k_axial: float | None = None
    k_tilt: float | None = None
    k_twist: float | Literal["rigid"] | None = None
    stiffness: tuple[tuple[float, ...], ...] | None = None
    centre: float | None = None
    push: float | None = None
    about: About | None = None
    ccw_turn: float | None = None
    tilt_limit: float | None = None
    shift_limit: float | None = None
    torque_limit: float | None = None


class SettledLibrary(Answer):
    """A published library of settled states."""

    id: int
    designation: str
    source: str | None
    device: Device
    grid: GridDocument
    stored_unit: LengthUnit
    state_count: int
    code_version: str
    input_sha256: str
    content_sha256: str
    created_at: datetime
    published_at: datetime


class SettledCounts(Answer):
    """How many settled states have each outcome, each flag, so many contacts, and so many falls."""

    outcomes: dict[Outcome, int]
    flags: dict[SettledFlag, int]
    contacts: dict[int, int]
    falls: dict[int, int]


class SettledLibraryDetail(SettledLibrary):
    """A published library of settled states with the counts of its states."""

    counts: SettledCounts


class SettledLibraryList(Answer):
    """All published libraries of settled states, the latest first."""

    settled: tuple[SettledLibrary, ...]


class SettledPage(Answer):
    """One page of settled states, in the order of roll, pitch and phase."""

    settled_library: int
    unit: LengthUnit
    states: tuple[Settled, ...]
    next: str | None

    @property
    def items(self) -> Sequence[Settled]:
        """The settled states."""
        return self.states
