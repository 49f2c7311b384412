"""What is kept of a sampled path: how it ends, and the formations of contacts it visits, as frozen values.

Angles are in degrees, lengths in the pair's unit, forces in N, torques in N times that unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from threadstate.chances.sampling import Approach
from threadstate.device.assembly_model import AssemblyOutcome, Held
from threadstate.device.model import SettledFlag
from threadstate.state.model import FeaturePair, Vector


class LegName(StrEnum):
    """A turn of a strategy. A left-hand bolt is turned the other way round."""

    CCW = "ccw"
    """Counter-clockwise, until the snap."""
    CW = "cw"
    """Clockwise."""


class Leaving(StrEnum):
    """How a path leaves a formation."""

    GAINED = "gained"
    """It has more contacts then."""
    LOST = "lost"
    """It has fewer."""
    MOVED = "moved"
    """It has as many, of other features."""
    FALL = "fall"
    """The bolt falls."""
    SNAP = "snap"
    """The counter-clockwise turn ends by the snap; the bolt may be held alike after it."""
    ON_SURFACE = "on_surface"
    """The base comes to lie flush on the nut's surface."""
    OFF_SURFACE = "off_surface"
    """The base leaves the surface."""
    ON_STRIP = "on_strip"
    """The bolt comes to lie level on a strip of flank."""
    OFF_STRIP = "off_strip"
    """The bolt leaves the strip."""
    END = "end"
    """The path ends."""


@dataclass(frozen=True, slots=True, order=True)
class Formation:
    """What holds a bolt, and the features of its contacts, sorted; a pair of features is there once a contact."""

    held: Held
    features: tuple[FeaturePair, ...]

    def __str__(self) -> str:
        listed = ", ".join(self.features)
        return listed if self.held is Held.CONTACTS else f"{self.held}: {listed}"


@dataclass(frozen=True, slots=True)
class Reading:
    """What is measured at a point of a path.

    ``phase_deg`` is the hand's phase, ``torque`` its torque, ``force`` the resultant of the contact forces: what the
    bolt exerts on the hand, in the nut's frame.
    """

    phase_deg: float
    torque: float
    force: Vector


@dataclass(frozen=True, slots=True)
class Visit:
    """A stretch of a path with one formation, in one leg.

    It lasts until the first point of the next one. ``readings`` are those of its points, at least one.
    """

    formation: Formation
    leg: LegName
    from_deg: float
    to_deg: float
    left: Leaving
    readings: tuple[Reading, ...]

    @property
    def turned_deg(self) -> float:
        """How far the hand turns in it."""
        return abs(self.to_deg - self.from_deg)


@dataclass(frozen=True, slots=True)
class Record:
    """A sampled path.

    ``turned_deg`` is how far the hand turns in all; ``assembled_deg`` how far until the height follows the lead to the
    end, None unless the path engages. ``torque``, ``tilt_deg`` and ``shift`` are the largest ones on the path. They are
    None, and there are no visits, where the start is not settled and of a bounded path: one that was not followed to
    its end, as it passed the limit of points. Its outcome is ``undecided``.
    """

    approach: Approach
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    is_bounded: bool
    turned_deg: float | None
    assembled_deg: float | None
    torque: float | None
    tilt_deg: float | None
    shift: float | None
    visits: tuple[Visit, ...]

    @property
    def engages(self) -> bool:
        """Whether the path ends engaged."""
        return self.outcome is AssemblyOutcome.ENGAGED

    @property
    def is_decided(self) -> bool:
        """Whether the outcome is certain."""
        return self.outcome is not AssemblyOutcome.UNDECIDED
