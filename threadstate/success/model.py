"""Success maps as frozen values: paths by their outcomes, boundaries of outcome, critical frictions (docs/success.md).

Angles are in degrees, lengths in the pair's unit, torques in N times that unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag


@dataclass(frozen=True, slots=True)
class Cell:
    """A path of a map: where it starts, the friction, how it ends and what it asks of the device.

    ``torque``, ``tilt_deg`` and ``shift`` are the largest ones on the path, ``end_deg`` is the hand's phase at its end:
    None where the start is not settled, and of a bounded path. ``is_bounded`` says that the path was not followed to
    its end, as it passed the limit of points; its outcome is ``undecided``.
    """

    phase_deg: float
    mu: float
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    is_bounded: bool
    torque: float | None
    tilt_deg: float | None
    shift: float | None
    end_deg: float | None

    @property
    def engages(self) -> bool:
        """Whether the path ends engaged."""
        return self.outcome is AssemblyOutcome.ENGAGED

    @property
    def is_decided(self) -> bool:
        """Whether the outcome is certain."""
        return self.outcome is not AssemblyOutcome.UNDECIDED

    def step_dependent(self) -> Cell:
        """What is left of it where the path ends otherwise with half the step."""
        return replace(self, outcome=AssemblyOutcome.UNDECIDED, flags=(*self.flags, SettledFlag.STEP_DEPENDENT))


@dataclass(frozen=True, slots=True)
class PhaseBoundary:
    """Two starting phases of unlike outcomes at one friction, between which no other was computed.

    ``to_deg`` is the larger one, 360 deg or more beyond the last phase of the grid. The two are as near to each other
    as the map's tolerance, and both end so with half the step, unless the outcome of one is ``undecided``: such a gap
    is not narrowed.
    """

    mu: float
    from_deg: float
    to_deg: float
    outcome_before: AssemblyOutcome
    outcome_after: AssemblyOutcome


@dataclass(frozen=True, slots=True)
class CriticalFriction:
    """The least friction at which a path does not end engaged, as an interval.

    At ``last`` and all smaller frictions that were computed every starting phase of the grid engages; None where
    frictionless ones do not. At ``first`` one does not: that from ``phase_deg``, which has the given outcome; all three
    are None where every friction of the map engages. Where the outcome is ``undecided``, the bolt may engage there: the
    critical friction is at least ``last``, and nothing else is known. ``reenters``: from all phases the bolt engages at
    a friction of the map above ``first``.
    """

    last: float | None
    first: float | None
    phase_deg: float | None
    outcome: AssemblyOutcome | None
    reenters: bool


@dataclass(frozen=True)
class OrientationMap:
    """What was computed of an orientation: every path once, by friction and phase; boundaries; the critical friction.

    ``index`` is the orientation's number in the grid.
    """

    index: int
    roll_deg: float
    pitch_deg: float
    cells: tuple[Cell, ...]
    boundaries: tuple[PhaseBoundary, ...]
    critical: CriticalFriction

    @cached_property
    def cell_at(self) -> Mapping[tuple[float, float], Cell]:
        """The cells by friction and phase."""
        return {(cell.mu, cell.phase_deg): cell for cell in self.cells}
