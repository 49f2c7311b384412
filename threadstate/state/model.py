"""What is known of one pose: frozen values, in the field's terms (method, sections 4 and 5)."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from threadstate.thread.regions import Region

Vector = tuple[float, float, float]
Rotation = tuple[Vector, Vector, Vector]


class StateClass(StrEnum):
    """The class of a contact state (method, section 5)."""

    UNSTABLE_TWO_POINT = "unstable_two_point"
    QUASI_STABLE_TWO_POINT = "quasi_stable_two_point"
    STABLE_THREE_POINT = "stable_three_point"


class FeaturePair(StrEnum):
    """The features that touch, the bolt's first (method, section 3)."""

    EDGE_EDGE = "edge-edge"
    EDGE_SURFACE = "edge-surface"
    BASE_EDGE = "base-edge"
    EDGE_THREAD = "edge-thread"
    THREAD_EDGE = "thread-edge"
    THREAD_THREAD = "thread-thread"
    THREAD_SURFACE = "thread-surface"
    FLUSH = "flush"


class Flag(StrEnum):
    """A named special case of a state."""

    FLUSH = "flush"
    """Contact is a patch: zero tilt, threads in phase, or the bolt lying flush after levelling."""
    TIE = "tie"
    """Two or more contacts of one stage appear at the same height or turn."""
    BALANCED = "balanced"
    """The bolt's origin lies on the axis of the third turn; both senses were followed."""
    GRAZING = "grazing"
    """A contact with nearly parallel features: its place is sensitive to the pose."""
    NO_SECOND = "no_second"
    """No second contact within the turn's limit of 45 deg."""
    NO_THIRD = "no_third"
    """No third contact within the turn's limit of 45 deg."""


@dataclass(frozen=True, slots=True)
class StagePose:
    """Bolt to nut: ``x_nut = rotation x_bolt + translation``; translation in the pair's length unit."""

    rotation: Rotation
    translation: Vector


@dataclass(frozen=True, slots=True)
class Contact:
    """One contact in the pose of its stage.

    Points and margins are in the pair's length unit; ``point`` and ``normal`` are in the nut's frame,
    ``point_bolt`` in the bolt's. ``normal`` has unit length and points from the nut into the bolt.
    A margin is the arc length from the contact to the nearest boundary of its region.
    """

    stage: int
    point: Vector
    point_bolt: Vector
    normal: Vector
    bolt_region: Region
    nut_region: Region
    features: FeaturePair
    bolt_margin: float
    nut_margin: float


@dataclass(frozen=True, slots=True)
class ContactState:
    """Everything known of one pose.

    ``poses`` holds one pose per stage reached. ``lambda_deg`` and ``mu_deg`` are the second and third
    turn in degrees, None where that stage was not reached. ``drop``, ``embedment`` and ``pivot_offset``
    (method, section 5) are lengths, None where a stage they need was not reached. The class margins are
    signed distances from the thresholds: ``drop_margin`` is drop - embedment, ``embedment_margin`` is
    tolerance - embedment, ``pivot_margin`` is pivot_offset - q * nominal radius (positive: on the
    stable side), each None where its length is.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    state_class: StateClass
    flags: tuple[Flag, ...]
    poses: tuple[StagePose, ...]
    lambda_deg: float | None
    mu_deg: float | None
    drop: float | None
    embedment: float | None
    pivot_offset: float | None
    drop_margin: float | None
    embedment_margin: float | None
    pivot_margin: float | None
    contacts: tuple[Contact, ...]


@dataclass(frozen=True, slots=True)
class UndecidedPose:
    """A pose (degrees) whose state could not be decided, and why."""

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    reason: str


Answer = ContactState | UndecidedPose
"""The answer of a solver method for a pose."""
