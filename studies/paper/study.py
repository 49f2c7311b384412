"""The data of the measurements: states of the paper's orientations by reading, and a sample off the grid."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from studies.paper.claim import Outcome
from studies.paper.readings import TURNING, Angles, Reading, declared_angles, other_geometries
from studies.paper.revolution import Revolution
from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair


@dataclass(frozen=True)
class Scale:
    """The grid of poses and the sample beside it.

    ``tilts_deg`` are the values of roll and of pitch, symmetric, 0 and 4 among them; ``phase_step_deg`` is a whole
    number of degrees that divides 360; ``sampled`` poses are drawn off the grid.
    """

    tilts_deg: tuple[int, ...]
    phase_step_deg: int
    sampled: int

    @property
    def phases_deg(self) -> range:
        """The phases of a revolution."""
        return range(0, 360, self.phase_step_deg)


FULL = Scale(tilts_deg=tuple(range(-4, 5)), phase_step_deg=1, sampled=20_000)
"""The paper's 81 orientations at every degree of phase."""


SEED = 20060117

Advance = Callable[[int], None]
"""Told how many more poses have been solved."""

Named = tuple[int, int, int]
"""A pose by whole degrees: roll, pitch, phase."""

FIG_19, FIG_20, FIG_21 = NAMED = ((4, 0, 185), (4, 4, 235), (-4, 0, 131))
"""The three poses that the paper names."""


@dataclass(frozen=True)
class Survey:
    """The states of orientations in one reading; ``revolutions`` by roll and pitch in degrees."""

    revolutions: Mapping[tuple[int, int], Revolution]

    def states(self) -> Iterator[ContactState]:
        """Every state of the grid, orientation by orientation."""
        for revolution in self.revolutions.values():
            yield from revolution.states

    def tilted(self) -> Iterator[Revolution]:
        """Every revolution but the level one."""
        return (turn for turn in self.revolutions.values() if turn.roll_deg or turn.pitch_deg)


@dataclass(frozen=True)
class Study:
    """Everything that was solved.

    ``geometries`` holds the four cases alone, as declared, on other geometries. ``named`` holds, by named pose and
    reading, its states with the phase counted from every ``phase_step_deg`` of the declared datum, the declared one
    first. ``sample`` are states off the grid; ``declined`` poses of it had none.
    """

    pair: Pair
    scale: Scale
    declared: Survey
    turned_first: Survey
    geometries: Mapping[str, Survey]
    named: Mapping[tuple[Named, Reading], tuple[ContactState, ...]]
    sample: tuple[ContactState, ...]
    declined: int


Measure = Callable[[Study], Outcome]
"""A measurement: the outcome of one statement."""


def poses_to_solve(scale: Scale) -> int:
    """How many poses :func:`solved_study` solves."""
    revolutions = len(TURNING) * len(scale.tilts_deg) ** 2 + len(Reading) * len(NAMED)
    revolutions += len(other_geometries()) * len(_cases(scale))
    return revolutions * len(scale.phases_deg) + scale.sampled


def solved_study(scale: Scale, advance: Advance) -> Study:
    """Solve everything of that scale."""
    pair = quarter_twenty_unc()

    def solved(threads: Pair, reading: Reading, poses: Sequence[Angles]) -> tuple[ContactState, ...]:
        states = tuple(solve_poses(threads, [declared_angles(reading, *pose) for pose in poses]))
        advance(len(states))
        return states

    def survey(threads: Pair, reading: Reading, orientations: Sequence[tuple[int, int]]) -> Survey:
        revolutions = {}
        for roll, pitch in orientations:
            states = solved(threads, reading, [(roll, pitch, phase) for phase in scale.phases_deg])
            goes_round = reading is Reading.DECLARED
            revolutions[roll, pitch] = Revolution(threads, roll, pitch, scale.phase_step_deg, states, goes_round)
        return Survey(revolutions)

    every = [(roll, pitch) for roll in scale.tilts_deg for pitch in scale.tilts_deg]
    declared, turned_first = (survey(pair, reading, every) for reading in TURNING)
    geometries = {
        name: survey(threads, Reading.DECLARED, _cases(scale)) for name, threads in other_geometries().items()
    }
    named = {
        (pose, reading): solved(pair, reading, [(pose[0], pose[1], pose[2] + datum) for datum in scale.phases_deg])
        for pose in NAMED
        for reading in Reading
    }
    sample = _sample(pair, scale, advance)
    return Study(pair, scale, declared, turned_first, geometries, named, sample, scale.sampled - len(sample))


def _cases(scale: Scale) -> list[tuple[int, int]]:
    """The orientations of the paper's four cases: rolled or pitched alone."""
    tilts = [tilt for tilt in scale.tilts_deg if tilt]
    return [(tilt, 0) for tilt in tilts] + [(0, tilt) for tilt in tilts]


def _sample(pair: Pair, scale: Scale, advance: Advance) -> tuple[ContactState, ...]:
    """States of seeded poses within 4 deg of roll and pitch; a pose that the solver declines is left out."""
    states = []
    poses = np.random.default_rng(SEED).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (scale.sampled, 3))
    for roll, pitch, phase in poses.tolist():
        try:
            states.append(solve_pose(pair, roll, pitch, phase))
        except UnresolvedPoseError:
            continue
        finally:
            advance(1)
    return tuple(states)
