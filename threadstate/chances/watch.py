"""What a measured force and torque say: in which formations sampled paths have such readings, and how those end."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from threadstate.chances.model import Formation, Reading, Record, Visit
from threadstate.chances.proportion import Chance, chance_of
from threadstate.errors import InvalidValueError
from threadstate.numbers import number
from threadstate.state.model import Vector

SEPARATOR = "+-"
VALID = "force=X,Y,Z+-N or force=Z+-N, torque=T+-N, phase=DEG+-DEG, with spaces, each at most once"


@dataclass(frozen=True)
class Observation:
    """A reading of a sensor: what was measured, each with its tolerance; None where it was not.

    ``force`` is that on the hand in the nut's frame, in N, or ``axial`` its component along z; ``torque`` that of the
    hand in N times the pair's unit; ``phase_deg`` the hand's phase, in any turn. A force is within its tolerance where
    the length of the difference is.

    Raises:
        InvalidValueError: nothing was measured, both forces were, or a tolerance is negative.
    """

    force: tuple[Vector, float] | None = None
    axial: tuple[float, float] | None = None
    torque: tuple[float, float] | None = None
    phase_deg: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        measured = {"force": self.force or self.axial, "torque": self.torque, "phase": self.phase_deg}
        if self.force is not None and self.axial is not None:
            raise InvalidValueError("watch", "two forces", "three components or the axial one")
        if all(one is None for one in measured.values()):
            raise InvalidValueError("watch", "nothing", VALID)
        for name, one in measured.items():
            if one is not None and not one[1] >= 0.0:
                raise InvalidValueError(f"watch: tolerance of {name}", one[1], "a number >= 0")

    def holds(self, reading: Reading) -> bool:
        """Whether a reading is within all tolerances."""
        if self.force is not None and math.dist(reading.force, self.force[0]) > self.force[1]:
            return False
        if self.axial is not None and abs(reading.force[2] - self.axial[0]) > self.axial[1]:
            return False
        if self.torque is not None and abs(reading.torque - self.torque[0]) > self.torque[1]:
            return False
        if self.phase_deg is None:
            return True
        apart = math.remainder(reading.phase_deg - self.phase_deg[0], 360.0)
        return abs(apart) <= self.phase_deg[1]


@dataclass(frozen=True, slots=True)
class Remaining:
    """A formation in which such a reading occurs.

    ``points`` are the points of paths that have it, ``share`` their part of the turning at all points that have it, in
    whatever formation; ``chance`` is that of the paths they are of.
    """

    formation: Formation
    points: int
    share: float
    chance: Chance


@dataclass(frozen=True)
class Located:
    """What an observation says.

    ``points`` are how many points all paths have, ``matching`` how many of them have such a reading; ``chance`` is that
    of the paths with one. ``remaining`` has the formations, the one with the largest share first; none where no path
    has such a reading.
    """

    points: int
    matching: int
    chance: Chance
    remaining: tuple[Remaining, ...]


def located(records: Sequence[Record], observation: Observation) -> Located:
    """The formations of sampled paths that remain after an observation."""
    found: dict[Formation, list[tuple[Record, float]]] = {}
    points = 0
    for record in records:
        for visit in record.visits:
            points += len(visit.readings)
            for reading, turned_deg in weighted(visit):
                if observation.holds(reading):
                    found.setdefault(visit.formation, []).append((record, turned_deg))
    matching = [match for matches in found.values() for match in matches]
    total = math.fsum(turned_deg for _, turned_deg in matching)
    remaining = []
    for formation, matches in found.items():
        turned = math.fsum(turned_deg for _, turned_deg in matches)
        share = turned / total if total > 0.0 else len(matches) / len(matching)
        remaining.append(Remaining(formation, len(matches), share, _chance(matches)))
    remaining.sort(key=lambda one: (-one.share, -one.points, one.formation))
    return Located(points, len(matching), _chance(matching), tuple(remaining))


def weighted(visit: Visit) -> Iterator[tuple[Reading, float]]:
    """The readings of a visit, each with the turning (deg) that it stands for; their sum is the visit's."""
    phases = [reading.phase_deg for reading in visit.readings]
    edges = [visit.from_deg, *(0.5 * (before + after) for before, after in pairwise(phases)), visit.to_deg]
    for reading, (begin, end) in zip(visit.readings, pairwise(edges), strict=True):
        yield reading, abs(end - begin)


def parse_observation(text: str) -> Observation:
    """The observation of a text as ``force=0.5,-1,10+-0.5 torque=0.2+-0.05 phase=120+-10``.

    Raises:
        InvalidValueError: it is anything else.
    """
    given: dict[str, tuple[list[float], float]] = {}
    for part in text.split():
        name, is_given, rest = part.partition("=")
        value, has_tolerance, spread = rest.rpartition(SEPARATOR)
        if name not in ("force", "torque", "phase") or name in given or not (is_given and has_tolerance):
            raise InvalidValueError("watch", part, VALID)
        try:
            numbers = [number(one) for one in value.split(",")]
            given[name] = numbers, number(spread)
        except ValueError:
            raise InvalidValueError("watch", part, VALID) from None
        if len(numbers) != 1 and (name != "force" or len(numbers) != 3):
            raise InvalidValueError("watch", part, VALID)
    single = {name: (numbers[0], tolerance) for name, (numbers, tolerance) in given.items() if len(numbers) == 1}
    force = None
    if "force" in given and "force" not in single:
        (x, y, z), tolerance = given["force"]
        force = (x, y, z), tolerance
    return Observation(force, single.get("force"), single.get("torque"), single.get("phase"))


def _chance(matches: Sequence[tuple[Record, float]]) -> Chance:
    return chance_of({record.approach.index: record for record, _ in matches}.values())
