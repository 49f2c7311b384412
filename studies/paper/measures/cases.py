"""What the four cases' measurements share: the revolutions of a case, and a test of them in every reading."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Iterable, Sequence
from dataclasses import replace
from enum import Enum
from itertools import groupby
from typing import TypeVar

from studies.paper.claim import NARROW, Finding, Outcome, Read, settled
from studies.paper.readings import Reading
from studies.paper.revolution import Revolution
from studies.paper.study import Measure, Study, Survey
from threadstate.thread.regions import Region

Item = TypeVar("Item", bound=Hashable)


class Case(Enum):
    """The paper's four cases: the signs of roll and pitch."""

    ONE = (1, 0)
    TWO = (-1, 0)
    THREE = (0, 1)
    FOUR = (0, -1)


def revolutions(survey: Survey, case: Case) -> list[Revolution]:
    """The case's revolutions by growing tilt."""
    roll, pitch = case.value
    tilts = sorted({abs(tilt) for tilt, _ in survey.revolutions} - {0})
    return [survey.revolutions[roll * tilt, pitch * tilt] for tilt in tilts]


def tilt_of(revolution: Revolution) -> int:
    """Size of the roll or pitch, in degrees."""
    return abs(revolution.roll_deg or revolution.pitch_deg)


def in_every_reading(test: Callable[[Survey], Finding], note: str = "") -> Measure:
    """The measurement that puts every reading to the test."""

    def measure(study: Study) -> Outcome:
        declared, turned_first = test(study.declared), test(study.turned_first)
        outcome = settled(declared, [Read(Reading.TURN_FIRST.value, turned_first)], note)
        return replace(outcome, holds_by_order=(declared.holds, turned_first.holds))

    return measure


def in_every_geometry(test: Callable[[Survey], Finding], note: str = "") -> Measure:
    """The measurement that puts every reading to the test, and the declared one on every other geometry."""

    def measure(study: Study) -> Outcome:
        declared, turned_first = test(study.declared), test(study.turned_first)
        others = [Read(Reading.TURN_FIRST.value, turned_first)]
        others += [Read(name, test(survey)) for name, survey in study.geometries.items()]
        return replace(settled(declared, others, note), holds_by_order=(declared.holds, turned_first.holds))

    return measure


def by_tilt(found: Iterable[tuple[Revolution, str]]) -> str:
    """What was found for each tilt, tilts with the same finding together."""
    listed = []
    for text, group in groupby(found, key=lambda pair: pair[1]):
        tilts = [f"{tilt_of(revolution)}" for revolution, _ in group]
        listed.append(f"{tilts[0]}{' to ' + tilts[-1] if len(tilts) > 1 else ''} deg: {text}")
    return "; ".join(listed)


def runs(items: Sequence[Item]) -> tuple[Item, ...]:
    """The items without immediate repetitions."""
    return tuple(item for item, _ in groupby(items))


def words(regions: Iterable[Region]) -> str:
    """Regions as the paper says them."""
    return ", ".join(word(region) for region in regions)


def word(region: Region) -> str:
    """A region as the paper says it: positive flank, negative crest fillet."""
    name = region.value.replace("_", " ")
    for suffix, sign in ((" pos", "positive"), (" neg", "negative")):
        if name.endswith(suffix):
            return f"{sign} {name.removesuffix(suffix)}"
    return name


def region_before_fall(survey: Survey, case: Case, region: Region) -> Finding:
    """The nut's regions over the last 30 deg before the fall; holds if most of each is ``region``."""
    found, holds = [], True
    for revolution in revolutions(survey, case):
        steps = max(1, round(NARROW / revolution.step_deg))
        counts = Counter(revolution.nut_regions[i] for i in revolution.from_fall[-steps:])
        listed = ", ".join(f"{word(one)} {count * revolution.step_deg} deg" for one, count in counts.items())
        found.append((revolution, listed))
        holds &= counts.most_common(1)[0][0] is region
    return Finding(by_tilt(found), holds)
