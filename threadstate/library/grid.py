"""The grid of a library: its poses and their order."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal
from functools import cached_property

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.state.options import TILT_LIMIT_DEG

SMALLEST_STEP_DEG = 0.01
LARGEST_POSE_COUNT = 50_000_000


@dataclass(frozen=True)
class Orientation:
    """Roll and pitch of a chunk, in degrees, and its number ``i_roll * n_pitch + i_pitch``."""

    index: int
    roll_deg: float
    pitch_deg: float


@dataclass(frozen=True)
class Grid:
    """Roll and pitch from -``tilt_max_deg`` to +``tilt_max_deg``, phase from 0 up to but without 360, in degrees.

    Each angle is the decimal number that a person would write (three steps of 0.1 deg are 0.3, not
    0.30000000000000004), so that a pose written in decimals finds its state.

    Raises:
        InvalidValueError: the tilt is outside 0 to 10 deg, a step is not positive, is finer than 0.01 deg or does not
            divide its range evenly, or the grid would have more than 50 million poses.
    """

    tilt_max_deg: float = 4.0
    tilt_step_deg: float = 1.0
    phase_step_deg: float = 1.0

    def __post_init__(self) -> None:
        _require(self.tilt_max_deg, "tilt_max", 0.0, TILT_LIMIT_DEG)
        _require(self.tilt_step_deg, "tilt_step", SMALLEST_STEP_DEG, TILT_LIMIT_DEG)
        _require(self.phase_step_deg, "phase_step", SMALLEST_STEP_DEG, 360.0)
        for name in ("tilt_max_deg", "tilt_step_deg", "phase_step_deg"):
            object.__setattr__(self, name, float(getattr(self, name)))
        if _decimal(self.tilt_max_deg) % _decimal(self.tilt_step_deg):
            raise InvalidValueError(
                "tilt_step", self.tilt_step_deg, f"a step that divides {self.tilt_max_deg} deg evenly"
            )
        if _decimal(360.0) % _decimal(self.phase_step_deg):
            raise InvalidValueError("phase_step", self.phase_step_deg, "a step that divides 360 deg evenly")
        if self.pose_count > LARGEST_POSE_COUNT:
            raise InvalidValueError("pose count of the grid", self.pose_count, f"at most {LARGEST_POSE_COUNT}")

    def __str__(self) -> str:
        """The grid as text: "+-4 by 1, phase by 1 deg"."""
        tilt_max, tilt_step, phase_step = map(number_text, (self.tilt_max_deg, self.tilt_step_deg, self.phase_step_deg))
        return f"+-{tilt_max} by {tilt_step}, phase by {phase_step} deg"

    @cached_property
    def tilts_deg(self) -> tuple[float, ...]:
        """The values of roll, and of pitch, in degrees, ascending."""
        steps = int(_decimal(self.tilt_max_deg) / _decimal(self.tilt_step_deg))
        return tuple(_multiple(i, self.tilt_step_deg) for i in range(-steps, steps + 1))

    @cached_property
    def phases_deg(self) -> tuple[float, ...]:
        """The values of phase in degrees, ascending."""
        return tuple(_multiple(i, self.phase_step_deg) for i in range(self.phase_count))

    @property
    def tilt_count(self) -> int:
        """Number of values of roll, and of pitch."""
        return 2 * int(_decimal(self.tilt_max_deg) / _decimal(self.tilt_step_deg)) + 1

    @property
    def phase_count(self) -> int:
        """Number of values of phase: the poses of one orientation."""
        return int(_decimal(360.0) / _decimal(self.phase_step_deg))

    @property
    def orientation_count(self) -> int:
        """Number of pairs of roll and pitch."""
        return self.tilt_count**2

    @property
    def pose_count(self) -> int:
        """Number of poses."""
        return self.orientation_count * self.phase_count

    def orientation(self, index: int) -> Orientation:
        """The orientation with an index, 0 <= index < ``orientation_count``."""
        i_roll, i_pitch = divmod(index, self.tilt_count)
        return Orientation(index, self.tilts_deg[i_roll], self.tilts_deg[i_pitch])

    def orientation_index(self, roll_deg: float, pitch_deg: float) -> int | None:
        """The index of an orientation; None if the grid does not contain it."""
        i_roll, i_pitch = self._tilt_indices.get(roll_deg), self._tilt_indices.get(pitch_deg)
        return None if i_roll is None or i_pitch is None else i_roll * self.tilt_count + i_pitch

    @cached_property
    def _tilt_indices(self) -> dict[float, int]:
        return {tilt_deg: index for index, tilt_deg in enumerate(self.tilts_deg)}

    def poses(self, index: int) -> tuple[tuple[float, float, float], ...]:
        """(roll, pitch, phase) in degrees of every state of an orientation, in the order of their ordinals."""
        orientation = self.orientation(index)
        return tuple((orientation.roll_deg, orientation.pitch_deg, phase) for phase in self.phases_deg)

    def first_ordinal(self, index: int) -> int:
        """The ordinal of an orientation's first state."""
        return index * self.phase_count


def _require(value: float, name: str, low: float, high: float) -> None:
    if not (math.isfinite(value) and low <= value <= high):
        raise InvalidValueError(name, value, f"{number_text(low)} to {number_text(high)} deg")


def _decimal(value: float) -> Decimal:
    return Decimal(repr(value))


def _multiple(count: int, step: float) -> float:
    return float(count * _decimal(step)) + 0.0
