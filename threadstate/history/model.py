"""A history: the intervals of an orientation's phase circle and the boundaries between them."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.history.labels import ContactLabels, Labels
from threadstate.state.model import ContactState

POINT_DEG = 1e-6
"""Labels that hold over less phase than this belong to a boundary: they are those of a point, a tie for instance."""

CIRCLE_DEG = 360.0


@dataclass(frozen=True, slots=True)
class ContactChange:
    """How one contact differs across a boundary.

    ``stage`` and ``place`` say which: the ``place``-th (from 0) of its stage. ``before`` is None where the contact
    appears, ``after`` where it vanishes. ``moved`` is the distance between the contact's points on both sides, a
    length in the pair's unit, None if one side has no contact.
    """

    stage: int
    place: int
    before: ContactLabels | None
    after: ContactLabels | None
    moved: float | None

    @property
    def labels_differ(self) -> bool:
        """Whether a label changes, or the contact jumps elsewhere with the same labels."""
        return self.before != self.after


@dataclass(frozen=True, slots=True)
class Boundary:
    """Where an interval ends and the next one begins, in the direction of growing phase.

    The change lies between ``low_deg`` and ``high_deg``, two phases in [0, 360] that were solved. ``before`` and
    ``after`` are their states, None where undecided. ``through`` are labels that hold at single phases in between,
    as those of a tie do.
    """

    low_deg: float
    high_deg: float
    before: ContactState | None
    after: ContactState | None
    through: tuple[Labels, ...]
    changes: tuple[ContactChange, ...]

    @property
    def phase_deg(self) -> float:
        """The middle of the bracket, in [0, 360)."""
        return 0.5 * (self.low_deg + self.high_deg) % CIRCLE_DEG

    @property
    def width_deg(self) -> float:
        """Width of the bracket: the phase is certain to half of it."""
        return self.high_deg - self.low_deg

    @property
    def decided(self) -> bool:
        """Whether the states on both sides are known."""
        return self.before is not None and self.after is not None

    @property
    def first_height_jump(self) -> float | None:
        """Change of the height of first contact across the bracket, a length; None where a side is undecided."""
        if self.before is None or self.after is None:
            return None
        return _height(self.after, 0) - _height(self.before, 0)

    @property
    def last_height_jump(self) -> float | None:
        """Change of the height of the bolt's origin in its last pose, a length; None where a side is undecided."""
        if self.before is None or self.after is None:
            return None
        return _height(self.after, -1) - _height(self.before, -1)


@dataclass(frozen=True, slots=True)
class Interval:
    """Phases over which every label is constant and no height jumps.

    From ``start_deg`` in [0, 360) to ``end_deg``, which is larger and, of the interval that phase 0 lies in, above 360.
    ``state`` is that of ``middle_deg``, None where undecided: there the solver does not decide every phase.
    """

    start_deg: float
    end_deg: float
    labels: Labels
    state: ContactState | None

    @property
    def width_deg(self) -> float:
        """How much phase the interval covers."""
        return self.end_deg - self.start_deg

    @property
    def middle_deg(self) -> float:
        """The phase half way, in [0, 360)."""
        return 0.5 * (self.start_deg + self.end_deg) % CIRCLE_DEG


@dataclass(frozen=True, slots=True)
class SolvedHistory:
    """The computed history of an orientation: all intervals in order of phase; ``boundaries[i]`` is where
    ``intervals[i]`` begins.

    An orientation without any boundary has one interval, from 0 to 360. ``solve_count`` is how many poses were solved.
    """

    roll_deg: float
    pitch_deg: float
    intervals: tuple[Interval, ...]
    boundaries: tuple[Boundary, ...]
    solve_count: int


def _height(state: ContactState, stage: int) -> float:
    return state.poses[stage].translation[2]
