"""One revolution of a bolt of one orientation, counter-clockwise, as arrays over phase."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from studies.paper.claim import ON_SURFACE
from threadstate.history.descents import falls_of
from threadstate.history.falls import SPAN_DEG, Descent, Falls
from threadstate.history.height_curve import ROUND_OFF, Gap, HeightCurve, Segment, height_curve
from threadstate.history.model import CIRCLE_DEG
from threadstate.state.model import Contact, ContactState
from threadstate.thread.pair import Pair
from threadstate.thread.regions import Region

Array = NDArray[np.float64]


def sampled_curve(heights: Array, step_deg: float, thread_pitch: float) -> HeightCurve:
    """The curve that is straight between heights, shape (n,), from phase 0 on in steps that make up a turn.

    What falls and rises again between two samples is not in it.
    """
    round_off = ROUND_OFF * thread_pitch
    closed = np.append(heights, heights[0])
    rises = np.diff(closed)
    signs = np.where(np.abs(rises) <= round_off, 0.0, np.sign(rises))
    ends = [0, *(np.flatnonzero(np.diff(signs)) + 1).tolist(), len(heights)]
    segments = tuple(
        Segment(low * step_deg, high * step_deg, float(closed[low]), float(closed[high]))
        for low, high in pairwise(ends)
    )
    gaps = tuple(Gap(one.start_deg, one.start_deg, one.start_height, one.start_height) for one in segments)
    phases = np.arange(len(closed)) * step_deg

    def height(at_deg: Array) -> Array:
        found: Array = np.interp(at_deg % CIRCLE_DEG, phases, closed)
        return found

    def slope(at_deg: Array) -> Array:
        steps = (at_deg % CIRCLE_DEG // step_deg).astype(np.intp)
        found: Array = rises[steps] / step_deg
        return found

    return HeightCurve(segments, gaps, height, slope, round_off)


def first_contact(state: ContactState) -> Contact:
    """The first contact; of simultaneous ones the first listed."""
    return state.contacts[0]


def first_height(state: ContactState) -> float:
    """Height of the bolt's origin at the first contact, in inches."""
    return state.poses[0].translation[2]


@dataclass(frozen=True)
class Revolution:
    """The states of an orientation, phase by phase from 0 in steps of ``step_deg``; positions count cyclically.

    ``tilt_goes_round`` is whether the tilt goes round with the phase, as declared: then falls are those of the exact
    curve of height, else those of its steps, joined by straight lines.
    """

    pair: Pair
    roll_deg: int
    pitch_deg: int
    step_deg: int
    states: tuple[ContactState, ...]
    tilt_goes_round: bool = True

    @cached_property
    def heights(self) -> Array:
        """Heights of first contact in inches, shape (n,)."""
        return np.array([first_height(state) for state in self.states])

    @cached_property
    def points(self) -> Array:
        """First contacts in the nut's frame, in inches, shape (n, 3)."""
        return np.array([first_contact(state).point for state in self.states])

    @cached_property
    def normals(self) -> Array:
        """Unit normals of the first contacts, nut into bolt, shape (n, 3)."""
        return np.array([first_contact(state).normal for state in self.states])

    @cached_property
    def bolt_regions(self) -> tuple[Region, ...]:
        """The bolt's regions of the first contacts."""
        return tuple(first_contact(state).bolt_region for state in self.states)

    @cached_property
    def nut_regions(self) -> tuple[Region, ...]:
        """The nut's regions of the first contacts."""
        return tuple(first_contact(state).nut_region for state in self.states)

    @cached_property
    def below(self) -> NDArray[np.bool_]:
        """Where the first contact is below the nut's surface, shape (n,)."""
        return self.points[:, 2] < -ON_SURFACE

    @cached_property
    def _curve(self) -> HeightCurve:
        if self.tilt_goes_round:
            return height_curve(self.pair, self.roll_deg, self.pitch_deg)
        return sampled_curve(self.heights, self.step_deg, self.pair.thread_pitch)

    def falls(self, span_deg: float = SPAN_DEG) -> Falls:
        """Its descents, and its steepest fall within so many degrees of phase; heights in inches."""
        return falls_of(self._curve, self.pair.thread_pitch, span_deg)

    @cached_property
    def steepest_fall(self) -> float:
        """The steepest fall, in inches; 0 where the bolt never goes down."""
        steepest = self.falls().steepest
        return 0.0 if steepest is None else steepest.fall

    @cached_property
    def main_descent(self) -> Descent | None:
        """The descent that holds the steepest fall; None where the bolt never goes down."""
        falls = self.falls()
        return None if falls.steepest is None else falls.descents[falls.steepest.descent]

    @cached_property
    def before_fall(self) -> int:
        """The position after which the height falls most in one step."""
        return int(np.argmax(self.heights - np.roll(self.heights, -1)))

    @property
    def after_fall(self) -> int:
        """The position after the steepest step."""
        return (self.before_fall + 1) % len(self.states)

    @cached_property
    def from_fall(self) -> NDArray[np.intp]:
        """All positions in the order of turning, from just after the steepest step to just before it."""
        return (self.after_fall + np.arange(len(self.states))) % len(self.states)

    @cached_property
    def beyond_fall_deg(self) -> Array:
        """How far each phase is from the middle of the steepest step, either way round, in degrees, shape (n,)."""
        phases = np.arange(len(self.states)) * self.step_deg
        apart = np.abs(phases - (self.before_fall + 0.5) * self.step_deg)
        nearest: Array = np.minimum(apart, 360.0 - apart)
        return nearest

    def degrees(self, chosen: NDArray[np.bool_]) -> int:
        """The phase that the chosen positions stand for, in degrees."""
        return int(np.count_nonzero(chosen)) * self.step_deg
