"""Every pose of the library's grid with its neighbours: what the maps show."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from studies.methods import Answer, Case, Method, moved
from studies.stability.change import SolvedCase, change_between, is_steady
from studies.stability.laws import broken_laws
from studies.stability.tally import described
from studies.stability.tangent_study import DirectionErrors, direction_errors
from threadstate.library.grid import Grid
from threadstate.state.model import ContactState, StateClass
from threadstate.thread.pair import Pair

DECADES = (-12, -9, -6, -3)
"""Exponents of ten of the neighbours' distances, in degrees of their largest angle."""
DIRECTIONS = np.array([[1.0, 0.61803398875, -0.41421356237]])
SLOPE_DECADE = -6
"""The distance at which slopes are measured."""


@dataclass(frozen=True)
class GridPose:
    """A pose of the grid as the maps show it.

    ``state_class`` is None where the method refuses. ``event_decade`` is the exponent of the smallest change of pose
    after which the contacts are others, or None; ``slope`` the largest change of a turn (times the bolt's reach) or of
    a contact point per change of the pose, None where the contacts are others.
    """

    state_class: StateClass | None
    event_decade: int | None
    slope: float | None
    directions: DirectionErrors


@dataclass(frozen=True)
class GridRow:
    """An orientation of the grid at all phases; how many neighbours were solved and refused, the grid's broken laws."""

    roll_deg: float
    pitch_deg: float
    poses: tuple[GridPose, ...]
    neighbours: int
    refused: int
    broken: tuple[str, ...] = field(default=())


def grid_row(method: Method, pair: Pair, grid: Grid, orientation: int) -> GridRow:
    """One orientation, by its number in the grid."""
    centres = [Case(pair, pose) for pose in grid.poses(orientation)]
    around = [_neighbours(centre) for centre in centres]
    answers = method.answers([case for centre, cases in zip(centres, around, strict=True) for case in (centre, *cases)])
    size = 1 + len(around[0])
    poses, broken, refused = [], [], 0
    for i, (centre, cases) in enumerate(zip(centres, around, strict=True)):
        given, *others = answers[i * size : (i + 1) * size]
        refused += sum(not isinstance(answer, ContactState) for answer in others)
        faults = broken_laws(method, SolvedCase(centre, given)) if isinstance(given, ContactState) else []
        broken += [f"{described(centre)}: {fault}" for fault in faults]
        poses.append(_grid_pose(centre, given, cases, others))
    first = centres[0].pose_deg
    return GridRow(first[0], first[1], tuple(poses), (size - 1) * len(centres), refused, tuple(broken))


def _neighbours(centre: Case) -> list[Case]:
    found = []
    for decade in DECADES:
        for direction in DIRECTIONS:
            roll, pitch, phase = (np.array(centre.pose_deg) + 10.0**decade * direction).tolist()
            found.append(replace(centre, pose_deg=(roll, pitch, phase)))
    return found


def _grid_pose(centre: Case, given: Answer, cases: list[Case], others: list[Answer]) -> GridPose:
    if not isinstance(given, ContactState):
        return GridPose(None, None, None, DirectionErrors(None, None, None))
    here = SolvedCase(centre, given)
    event, slope = None, None
    for i, (case, answer) in enumerate(zip(cases, others, strict=True)):
        decade = DECADES[i // len(DIRECTIONS)]
        if not isinstance(answer, ContactState):
            continue
        there = SolvedCase(case, answer)
        if not is_steady(here, there):
            event = decade if event is None else event
        elif decade == SLOPE_DECADE and centre.tilt > 0.0:
            change = change_between(here, there)
            if change is not None:
                steep = max(change.turn, change.point) / moved(centre, case)
                slope = steep if slope is None else max(slope, steep)
    if event is not None and event <= SLOPE_DECADE:
        slope = None
    return GridPose(given.state_class, event, slope, direction_errors(here))


def logarithm(slope: float | None) -> float | None:
    """The base-10 logarithm of a slope; None where there is none."""
    return None if slope is None or slope <= 0.0 else math.log10(slope)
