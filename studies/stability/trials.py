"""Perturbed cases: changes of 1e-12 to 1e-3 of a pose and of the dimensions, and cases that should change nothing."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from functools import lru_cache

import numpy as np

from studies.methods import Case, scaled, with_dimensions
from threadstate.errors import ImpossibleThreadError
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

DECADES = tuple(range(-12, -2))
"""Exponents of ten of the changes' sizes."""
POSE_DIRECTIONS = 15
DIMENSION_DIRECTIONS = 3
SEED = 11
SCALES = tuple(10.0**k for k in range(-6, 7) if k)
WHOLE_TURNS = tuple(10**k for k in range(7))
TOLERANCES = (1e-14, 1e-13, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4)


class Kind(StrEnum):
    """What was changed."""

    POSE = "pose"
    DIMENSIONS = "dimensions"
    SCALE = "scale"
    TURNS = "whole turns of phase"
    TOLERANCE = "tolerances"


@dataclass(frozen=True, slots=True)
class Trial:
    """A changed case of the centre with that number; ``decade`` is the exponent of the change's size, or None."""

    centre: int
    case: Case
    kind: Kind
    decade: int | None


def perturbations(centres: list[Case], first: int) -> list[Trial]:
    """Changes of pose and of dimensions about centres of one pair; the first has the number ``first`` in its place.

    Each centre has directions of its own; degrees and thread pitches are multiplied by the size. Changed pairs are the
    same for all, so that many poses are solved with each; dimensions that no thread can have are left out.
    """
    found = []
    for i, centre in enumerate(centres):
        choose = np.random.default_rng([SEED, first + i])
        for decade in DECADES:
            for direction in choose.uniform(-1.0, 1.0, (POSE_DIRECTIONS, 3)):
                change = 10.0**decade * direction / np.abs(direction).max()
                roll, pitch, phase = (np.array(centre.pose_deg) + change).tolist()
                found.append(Trial(i, replace(centre, pose_deg=(roll, pitch, phase)), Kind.POSE, decade))
    for decade in DECADES:
        for direction in range(DIMENSION_DIRECTIONS):
            try:
                pair = changed_pair(centres[0].pair, decade, direction)
            except ImpossibleThreadError:
                continue
            found += [Trial(i, replace(centre, pair=pair), Kind.DIMENSIONS, decade) for i, centre in enumerate(centres)]
    return found


@lru_cache(maxsize=256)
def changed_pair(pair: Pair, decade: int, direction: int) -> Pair:
    """The pair with its diameters and its thread pitch changed by up to 10^decade thread pitches."""
    change = np.random.default_rng([SEED, decade + 100, direction]).uniform(-1.0, 1.0, 7)
    lengths = 10.0**decade * pair.thread_pitch * change / np.abs(change).max()
    return with_dimensions(pair, tuple(lengths.tolist()))


def rescaled(centres: list[Case]) -> list[Trial]:
    """The same pairs smaller and larger: nothing else may change."""
    found = []
    for factor in SCALES:
        pair = scaled(centres[0].pair, factor)
        found += [
            Trial(i, replace(centre, pair=pair, scale=factor), Kind.SCALE, None) for i, centre in enumerate(centres)
        ]
    return found


def with_whole_turns(centres: list[Case]) -> list[Trial]:
    """The same poses after whole turns of phase, up to a million either way: nothing else may change."""
    found = []
    for i, centre in enumerate(centres):
        roll, pitch, phase = centre.pose_deg
        for turns in WHOLE_TURNS:
            for sign in (-1.0, 1.0):
                later = replace(centre, pose_deg=(roll, pitch, phase + sign * 360.0 * turns))
                found.append(Trial(i, later, Kind.TURNS, None))
    return found


def with_tolerances(centres: list[Case]) -> list[Trial]:
    """The same poses with other tolerances: numbers may not change, classes only with the embedment's."""
    options = [SolveOptions(tie_tolerance=size, embedment_tolerance=size) for size in TOLERANCES]
    return [
        Trial(i, replace(centre, options=chosen), Kind.TOLERANCE, None)
        for chosen in options
        for i, centre in enumerate(centres)
    ]
