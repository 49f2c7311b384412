"""First contacts along the phase of bolts with and without a chamfer, by the brute force of :mod:`oracle.chamfer`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import median

from oracle.chamfer import ChamferedHeight, Samples, chamfered_height
from threadstate.history.falls import SNAP_PITCHES, SPAN_DEG
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.pair import Pair

PAIRS = ("1/4-20 UNC", "M6x1-6g/6H")
TILTS_DEG = (-4.0, -2.0, 0.0, 2.0, 4.0)
LEVEL = (0.0, 0.0)
ENDS = (0.0, 0.25, 0.5, 0.75, 1.0, 1.1, 1.25)
"""End diameters as shares of the way from the bolt's major to its minor diameter; 0 is a bolt that is cut flat."""
ANGLE_DEG = 45.0
STEP_DEG = 1.0
HALVINGS = 6
"""Of a step, at the ends of a window."""
SAMPLES = Samples(edge=240, around=72, along=16, steps=32)
"""On 75 random poses they give the contacts, and heights to 1e-6 of the pitch, of samples 5 times as dense."""


@dataclass(frozen=True)
class Course:
    """Heights of first contact of an orientation along the phase, in thread pitches, and what touched there.

    ``window_deg`` is how much phase the first contact is within the thread.
    """

    heights: tuple[float, ...]
    touching: tuple[str, ...]
    window_deg: float

    @property
    def steepest(self) -> float:
        """The largest fall within 3 deg of phase, in thread pitches; of the sampled heights."""
        span = round(SPAN_DEG / 360.0 * len(self.heights))
        return max(
            self.heights[i] - min(self.heights[(i + k) % len(self.heights)] for k in range(span + 1))
            for i in range(len(self.heights))
        )


@dataclass(frozen=True)
class Found:
    """A pair with one end diameter, over the orientations."""

    designation: str
    end: float
    courses: tuple[Course, ...]

    @property
    def window_deg(self) -> float:
        """The median window."""
        return median(one.window_deg for one in self.courses)

    @property
    def steepest(self) -> float:
        """The median of the steepest falls."""
        return median(one.steepest for one in self.courses)

    @property
    def snaps(self) -> int:
        """Orientations whose steepest fall is that of a snap."""
        return sum(one.steepest > SNAP_PITCHES for one in self.courses)

    @property
    def highest(self) -> float:
        """The median of the greatest heights."""
        return median(max(one.heights) for one in self.courses)

    @property
    def lowest(self) -> float:
        """The median of the least heights."""
        return median(min(one.heights) for one in self.courses)

    def share(self, touching: str) -> float:
        """The share of all phases at which the bolt's part first touches the nut's, as ``cone-edge``."""
        counts = Counter(kind for one in self.courses for kind in one.touching)
        return counts[touching] / sum(counts.values())


def chamfered(pair: Pair, end: float) -> Pair:
    """The pair with a chamfer of 45 deg at that share of the way from the major to the minor diameter."""
    major, minor = pair.fit.bolt_major_diameter, pair.fit.bolt_minor_diameter
    return replace(pair, chamfer=Chamfer(major - end * (major - minor), ANGLE_DEG))


def is_within_thread(first: ChamferedHeight) -> bool:
    """Whether the bolt's end has passed the nut's mouth: it touches the nut's thread, or with its thread the edge."""
    return first.nut == "thread" or (first.nut == "edge" and first.bolt == "thread")


def orientations(tilts_deg: Sequence[float] = TILTS_DEG) -> list[tuple[float, float]]:
    """Roll and pitch of all but the level one."""
    return [(roll, pitch) for roll in tilts_deg for pitch in tilts_deg if (roll, pitch) != LEVEL]


def course(pair: Pair, roll: float, pitch: float, step_deg: float = STEP_DEG, samples: Samples = SAMPLES) -> Course:
    """The first contacts of an orientation."""
    count = round(360.0 / step_deg)

    def first(phase: float) -> ChamferedHeight:
        return chamfered_height(pair, roll, pitch, phase, samples)

    found = [first(360.0 * i / count) for i in range(count)]
    inside = [is_within_thread(one) for one in found]
    window = 0.0
    for i in range(count):
        here, after = inside[i], inside[(i + 1) % count]
        low, high = 0.0, 1.0
        if here == after:
            window += float(here)
            continue
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if is_within_thread(first(360.0 * (i + middle) / count)) == here:
                low = middle
            else:
                high = middle
        share = 0.5 * (low + high)
        window += share if here else 1.0 - share
    return Course(
        heights=tuple(one.height / pair.thread_pitch for one in found),
        touching=tuple(f"{one.bolt}-{one.nut}" for one in found),
        window_deg=window * 360.0 / count,
    )


Task = tuple[str, float, tuple[float, float], float]


def tasks(tilts_deg: Sequence[float] = TILTS_DEG, step_deg: float = STEP_DEG) -> list[Task]:
    """Every pair, end diameter and orientation."""
    return [(name, end, tilt, step_deg) for name in PAIRS for end in ENDS for tilt in orientations(tilts_deg)]


def done(task: Task) -> Course:
    """The course of a task."""
    name, end, (roll, pitch), step_deg = task
    return course(chamfered(pair_by_designation(name), end), roll, pitch, step_deg)


def gathered(to_do: Sequence[Task], courses: Sequence[Course]) -> list[Found]:
    """What was found, by pair and end diameter in their order."""
    found: dict[tuple[str, float], list[Course]] = {}
    for (name, end, _, _), one in zip(to_do, courses, strict=True):
        found.setdefault((name, end), []).append(one)
    return [Found(name, end, tuple(of)) for (name, end), of in found.items()]
