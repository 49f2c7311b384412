"""What a push does to the states of the default library: numbers for every state, and what holds before the snap."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.history.descents import falls_of
from threadstate.history.falls import SNAP_PITCHES
from threadstate.history.height_curve import height_curve
from threadstate.library.grid import Grid
from threadstate.state.decode import decoded_answers
from threadstate.state.model import ContactState, Flag, StateClass
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.state.solve import solve_pose
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics.load import Load
from threadstate.statics.rows import statics_rows
from threadstate.statics.solve import Statics, statics_of
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

BEFORE_SNAP_DEG = 1e-3
"""So far before the phase at which the steepest fall begins a state counts as the one just before the snap."""
SIDEWAYS = 12
"""Directions, evenly about the axis, in which a force sideways is tried."""
SIDEWAYS_MOST = 2.0
"""The largest force sideways that is tried, over the push."""
SIDEWAYS_CERTAIN = 1e-4


@dataclass(frozen=True)
class PushedState:
    """A state of the grid under the push: its row of numbers, as ``_numbers_kernel`` lays it out."""

    state: ContactState
    numbers: Floats

    @property
    def margin(self) -> float:
        """The support margin."""
        return float(self.numbers[nk.N_MARGIN])

    @property
    def hold(self) -> float:
        """The least friction that holds, from above; infinite where none does."""
        return float(self.numbers[nk.N_HOLD + 1])

    @property
    def wedge(self) -> float:
        """The least friction that wedges, from above; infinite where none does."""
        return float(self.numbers[nk.N_WEDGE + 1])

    @property
    def kind(self) -> str:
        """Its class; flush states apart."""
        return "flush" if Flag.FLUSH in self.state.flags else self.state.state_class.value

    @property
    def penetrating(self) -> bool:
        """Whether the solids overlap in the last pose."""
        return self.state.embedment_margin is not None and self.state.embedment_margin < 0.0


KINDS = ("flush", *(name.value for name in reversed(StateClass)))


def pushed_states(pair: Pair, grid: Grid) -> list[PushedState]:
    """All decided states of a grid under a push along -z through the bolt's origin, in the order of the grid."""
    poses = np.array([pose for index in range(grid.orientation_count) for pose in grid.poses(index)])
    records = solve_records(pair, SolveOptions(), poses)
    answers = decoded_answers(pair, SolveOptions(), poses, records)
    known = np.flatnonzero(records[:, rk.O_STATUS] == 0.0)
    rows = statics_rows(pair, records[known])
    states = (one for one in answers if isinstance(one, ContactState))
    return [PushedState(state, row) for state, row in zip(states, rows, strict=True)]


@dataclass(frozen=True)
class VerdictCounts:
    """How many states do what at a friction."""

    mu: float
    moves: int
    can_stay: int
    can_wedge: int
    undecided: int


def verdict_counts(states: Sequence[PushedState], mu: float) -> VerdictCounts:
    """How many states do what at a friction."""
    rows = np.array([one.numbers for one in states])
    hold, wedge = rows[:, nk.N_HOLD :], rows[:, nk.N_WEDGE :]
    moves, held = mu < hold[:, 0], mu >= hold[:, 1]
    stays, wedges = held & (mu < wedge[:, 0]), held & (mu >= wedge[:, 1])
    decided = moves | stays | wedges
    return VerdictCounts(mu, int(moves.sum()), int(stays.sum()), int(wedges.sum()), int((~decided).sum()))


@dataclass(frozen=True)
class BeforeSnap:
    """An orientation that snaps, just before it does.

    ``freed_by`` is the least force sideways, over the push and through the bolt's origin, after which the contacts no
    longer hold the load, and ``freed_towards_deg`` the azimuth it points to; None where they do not hold it, or hold it
    under every force that was tried.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    statics: Statics
    state_class: str
    freed_by: float | None
    freed_towards_deg: float | None


def before_snaps(pair: Pair, grid: Grid, load: Load, mu: float) -> list[BeforeSnap]:
    """The orientations that snap, in order, each just before it does, under a load at a friction."""
    found = []
    options = SolveOptions()
    for index in range(grid.orientation_count):
        tilt = grid.orientation(index)
        curve = height_curve(pair, tilt.roll_deg, tilt.pitch_deg, options)
        steepest = falls_of(curve, pair.thread_pitch).steepest
        if steepest is None or not steepest.fall > SNAP_PITCHES * pair.thread_pitch:
            continue
        phase = (steepest.start_deg - BEFORE_SNAP_DEG) % 360.0
        state = solve_pose(pair, tilt.roll_deg, tilt.pitch_deg, phase)
        statics = statics_of(pair, state, load, mu)
        by, towards = _freed(pair, state, load, mu) if mu >= statics.hold.upper else (None, None)
        kind = "flush" if Flag.FLUSH in state.flags else state.state_class.value
        found.append(BeforeSnap(tilt.roll_deg, tilt.pitch_deg, phase, statics, kind, by, towards))
    return found


def _freed(pair: Pair, state: ContactState, load: Load, mu: float) -> tuple[float | None, float | None]:
    """The least force sideways that frees a held state: halved in each direction, since what is held is convex."""
    push = -load.force[2]
    best, towards = math.inf, 0.0
    for azimuth in np.linspace(0.0, 360.0, SIDEWAYS, endpoint=False).tolist():
        x, y = math.cos(math.radians(azimuth)), math.sin(math.radians(azimuth))

        def held(share: float, x: float = x, y: float = y) -> bool:
            pushed = replace(load, force=(share * push * x, share * push * y, -push))
            return statics_of(pair, state, pushed).hold.upper <= mu

        low, high = 0.0, min(best, SIDEWAYS_MOST)
        if held(high):
            continue
        while high - low > SIDEWAYS_CERTAIN:
            middle = 0.5 * (low + high)
            low, high = (middle, high) if held(middle) else (low, middle)
        best, towards = high, azimuth
    return (best, towards) if best < math.inf else (None, None)
