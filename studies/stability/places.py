"""The hard places: what each is, how its centres are made, and the chunks of work that they come to."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from studies.methods import Case
from studies.stability.events import Event, EventKind
from studies.stability.place_study import Chunk
from studies.stability.trials import Trial, perturbations, rescaled, with_tolerances, with_whole_turns
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_play

SEED = 7
CENTRES_A_CHUNK = 8
LINE_TILT_DEG = 4.0


@dataclass(frozen=True)
class Place:
    """A hard place; ``how`` says how its centres are made, ``trials_of`` what is done to them."""

    name: str
    how: str
    centres: tuple[Case, ...]
    trials_of: Callable[[list[Case], int], list[Trial]] = perturbations

    def chunks(self) -> list[Chunk]:
        """The work, a few centres at a time."""
        found = []
        for start in range(0, len(self.centres), CENTRES_A_CHUNK):
            centres = list(self.centres[start : start + CENTRES_A_CHUNK])
            found.append(Chunk(self.name, start, tuple(centres), tuple(self.trials_of(centres, start))))
        return found


_HOW = {
    EventKind.TIE: "two first contacts far apart at one height; the phase halved to the last digit",
    EventKind.JUMP: "the highest contact vanishes and the bolt falls; halved until the method refuses or digits end",
    EventKind.LATER_TIE: "two second or third contacts at one turn; halved to the last digit",
    EventKind.DOUBLE_ROOT: "a second or third contact appears in, or merges with, another overlap; halved likewise",
    EventKind.FLUSH: "the turn ends flush on one side (coplanar faces) and in a contact on the other; halved likewise",
    EventKind.GRAZING: "poses of all these events whose state is flagged for nearly parallel edges",
    EventKind.REGION: "a contact moves over the boundary of a region; halved to the last digit",
    EventKind.FEATURE: "a contact moves from one pair of features to another; halved to 1e-7 deg",
    EventKind.BALANCED: "the bolt's origin passes over the pivot axis; halved to the last digit",
    EventKind.TANGENT_X: "the tangent of the second turn is along +x or -x; halved to the last digit",
    EventKind.TANGENT_Y: "the tangent of the second turn is along +y or -y; halved to the last digit",
    EventKind.PIVOT: "the pivot offset is at the threshold of the quasi-stable class; halved to the last digit",
    EventKind.DROP: "drop equals embedment: material rolls in at the pivot axis; halved to the last digit",
}


_SLOW = {EventKind.JUMP: 3, EventKind.FLUSH: 2, EventKind.GRAZING: 2}
"""A centre in so many is taken where poses take long, or the search for each takes long."""


def lines(pair: Pair, count: int) -> list[Case]:
    """Orientations whose phases are searched for events: half within 4 deg, half of all sizes down to 0.03 deg."""
    choose = np.random.default_rng([SEED, 0])
    found = []
    for i in range(count):
        largest = LINE_TILT_DEG if i % 2 else LINE_TILT_DEG * 10.0 ** choose.uniform(-2.0, 0.0)
        roll, pitch = choose.uniform(-largest, largest, 2)
        found.append(Case(pair, (float(roll), float(pitch), 0.0)))
    return found


def places(pair: Pair, events: list[Event], each: int) -> list[Place]:
    """All hard places with up to ``each`` centres."""
    found = []
    for kind in EventKind:
        cases = [event.case for event in events if event.kind is kind]
        found.append(Place(kind.value, _HOW[kind], tuple(spread(cases, -(-each // _SLOW.get(kind, 1))))))
    window = math.degrees(2.0 * math.pi * axial_play(pair) / pair.thread_pitch)
    ordinary = _random(pair, 1, each, (LINE_TILT_DEG, LINE_TILT_DEG), 180.0)
    found += [
        Place(
            "near-phase window",
            f"phase within {window:.3f} deg, where a level bolt drops through, tilt 0.01 to 4 deg",
            _random(pair, 2, each, (1e-2, LINE_TILT_DEG), window),
        ),
        Place(
            "edges of the near-phase window",
            "phase within 1e-3 deg of either end of that window, tilt 0.01 to 4 deg",
            _at_window(pair, each, window),
        ),
        Place("nearly level", "tilt 1e-9 to 1e-2 deg, any phase", _random(pair, 3, each, (1e-9, 1e-2), 180.0)),
        Place(
            "nearly level and in phase",
            "tilt 1e-9 to 1e-2 deg within that window",
            _random(pair, 4, each // 2, (1e-9, 1e-2), window),
        ),
        Place("level (coplanar from the start)", "no tilt, any phase", _random(pair, 5, each // 2, (0.0, 0.0), 180.0)),
        Place(
            "whole degrees",
            "poses of the 81 x 360 grid, where symmetric values meet",
            _whole_degrees(pair, each),
        ),
        Place(
            "tiny and huge threads",
            "random poses; every length times 1e-6 to 1e6",
            ordinary[: each // 2],
            lambda centres, _: rescaled(centres),
        ),
        Place(
            "large coordinates",
            "random poses; whole turns of phase added, up to a million either way",
            ordinary,
            lambda centres, _: with_whole_turns(centres),
        ),
        Place(
            "tolerances",
            "random poses; the tolerances of ties and of embedment 1e-14 to 1e-4",
            ordinary,
            lambda centres, _: with_tolerances(centres),
        ),
    ]
    return [place for place in found if place.centres]


def spread(cases: list[Case], count: int) -> list[Case]:
    """Up to ``count`` of the cases, evenly from first to last."""
    if len(cases) <= count:
        return cases
    return [cases[i * len(cases) // count] for i in range(count)]


def _random(
    pair: Pair, seed: int, count: int, tilts_deg: tuple[float, float], largest_phase_deg: float
) -> tuple[Case, ...]:
    """Poses of random direction of tilt, the tilt's logarithm even between two bounds."""
    choose = np.random.default_rng([SEED, seed])
    low, high = (math.log10(tilt) if tilt > 0.0 else -math.inf for tilt in tilts_deg)
    found = []
    for _ in range(count):
        tilt = 10.0 ** choose.uniform(low, high) if high > low else 10.0**high
        direction = choose.uniform(0.0, 2.0 * math.pi)
        phase = float(choose.uniform(-largest_phase_deg, largest_phase_deg))
        found.append(Case(pair, (float(tilt * math.cos(direction)), float(tilt * math.sin(direction)), phase)))
    return tuple(found)


def _at_window(pair: Pair, count: int, window: float) -> tuple[Case, ...]:
    choose = np.random.default_rng([SEED, 6])
    found = []
    for i, case in enumerate(_random(pair, 7, count, (1e-2, LINE_TILT_DEG), 0.0)):
        off = float(choose.uniform(-1e-3, 1e-3))
        roll, pitch, _ = case.pose_deg
        found.append(Case(pair, (roll, pitch, (window if i % 2 else -window) + off)))
    return tuple(found)


def _whole_degrees(pair: Pair, count: int) -> tuple[Case, ...]:
    choose = np.random.default_rng([SEED, 8])
    poses = np.column_stack([choose.integers(-4, 5, (count, 2)), choose.integers(0, 360, count)])
    return tuple(Case(pair, (float(roll), float(pitch), float(phase))) for roll, pitch, phase in poses.tolist())
