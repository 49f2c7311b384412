"""The falls of an orientation: its descents, its steepest fall and its snap (method, section 8)."""

from __future__ import annotations

from dataclasses import dataclass

SPAN_DEG = 3.0
"""The span of phase within which the steepest fall is searched for."""

SNAP_PITCHES = 0.05
"""A steepest fall of more than so many thread pitches is a snap's."""


@dataclass(frozen=True, slots=True)
class Jump:
    """A fall of the height at one phase, which is certain to half of ``width_deg``.

    Heights, in the pair's unit, are the limits from both sides; ``height_error`` estimates by how much either may be
    wrong.
    """

    phase_deg: float
    width_deg: float
    height_before: float
    height_after: float
    height_error: float

    @property
    def fall(self) -> float:
        """How far the bolt falls."""
        return self.height_before - self.height_after


@dataclass(frozen=True, slots=True)
class Descent:
    """A longest stretch of phase over which the height does not rise, from where it first falls to where it last does.

    ``start_deg`` is in [0, 360), ``end_deg`` not before it, above 360 where phase 0 lies between; heights are in the
    pair's unit. ``fall_error`` estimates by how much the fall may be wrong; ``undecided_deg`` is how much of the
    phase is undecided. ``jumps`` are in order of phase.
    """

    start_deg: float
    end_deg: float
    start_height: float
    end_height: float
    fall_error: float
    undecided_deg: float
    jumps: tuple[Jump, ...]

    @property
    def fall(self) -> float:
        """How far the bolt goes down."""
        return self.start_height - self.end_height

    @property
    def largest_jump(self) -> Jump | None:
        """The jump by which it falls farthest, the first of equal ones; None where the height does not jump."""
        return max(self.jumps, key=lambda jump: jump.fall, default=None)


@dataclass(frozen=True, slots=True)
class SteepestFall:
    """The largest fall within a span of phase, from ``start_deg`` in [0, 360) on; ``descent`` is the one that has it.

    ``fall`` is in the pair's unit; ``descent`` is a place among the orientation's descents.
    """

    fall: float
    start_deg: float
    descent: int


@dataclass(frozen=True, slots=True)
class Falls:
    """The descents of an orientation in order of phase, and its steepest fall; None where it never goes down."""

    descents: tuple[Descent, ...]
    steepest: SteepestFall | None

    def snap(self, least_fall: float) -> Descent | None:
        """The descent that holds the steepest fall where that is more than ``least_fall``, in the pair's unit."""
        if self.steepest is None or self.steepest.fall <= least_fall:
            return None
        return self.descents[self.steepest.descent]
