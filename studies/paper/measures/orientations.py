"""Measurements on all orientations, and beside their grid (sections 7, 7.2 and 8)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable

from studies.paper import statements
from studies.paper.claim import SAME_PLACE, Finding, Outcome, Statement, decided
from studies.paper.measures.approaches import QUASI_STABLE, STABLE, UNSTABLE, approaches
from studies.paper.measures.cases import in_every_reading
from studies.paper.revolution import Revolution
from studies.paper.study import Measure, Study, Survey
from threadstate.state.model import ContactState, FeaturePair, Flag
from threadstate.thread.regions import Region

Kind = tuple[tuple[int, FeaturePair, Region, Region], ...]

PARALLEL_DEG = 1e-6


def kind(state: ContactState) -> Kind:
    """The kind of a state: stage, features and regions of each of its contacts."""
    return tuple((one.stage, one.features, one.bolt_region, one.nut_region) for one in state.contacts)


def _points(revolution: Revolution) -> frozenset[tuple[int, int, int]]:
    """The contacts of a revolution in whole microinches."""
    return frozenset(
        (round(x / SAME_PLACE), round(y / SAME_PLACE), round(z / SAME_PLACE))
        for state in revolution.states
        for x, y, z in (contact.point for contact in state.contacts)
    )


def each_its_own_points(survey: Survey) -> Finding:
    """How many orientations there are, and how many different sets of points."""
    sets = {_points(revolution) for revolution in survey.revolutions.values()}
    cases = len(survey.revolutions)
    return Finding(f"{cases} orientations, {len(sets)} sets", len(sets) == cases == 81)


def ends_not_parallel(survey: Survey) -> Finding:
    """States whose last pose is parallel to the nut's surface."""
    states = [state for revolution in survey.tilted() for state in revolution.states]
    parallel = sum(_last_tilt_deg(state) < PARALLEL_DEG for state in states)
    return Finding(
        f"{parallel:,} of {len(states):,} end parallel to it, lying flush ({parallel / len(states):.1%})", parallel == 0
    )


def _last_tilt_deg(state: ContactState) -> float:
    zx, zy, zz = state.poses[-1].rotation[2]
    return math.degrees(math.atan2(math.hypot(zx, zy), zz))


def _missed(known: Iterable[ContactState], sample: Iterable[ContactState]) -> Finding:
    """Kinds of the sample that are not known, and how many poses are of them; holds if there are none."""
    known_kinds = {kind(state) for state in known}
    sampled = Counter(kind(state) for state in sample)
    missing = {one: count for one, count in sampled.items() if one not in known_kinds}
    return Finding(
        f"{len(known_kinds)} kinds shown; {sum(missing.values()):,} of {sampled.total():,} poses are of {len(missing)} "
        "others",
        not missing,
    )


def approaches_see_all(study: Study) -> Outcome:
    """What the eight approaches miss."""
    thinned = approaches(study.declared)
    known = (state for one in thinned for state in one.states)
    every_degree = (
        state for one in thinned for state in study.declared.revolutions[one.roll_deg, one.pitch_deg].states
    )
    found = _missed(known, every_degree)
    return Outcome(found.measurement, decided(found.holds))


def grid_sees_all(study: Study) -> Outcome:
    """What the whole grid misses."""
    found = _missed(study.declared.states(), study.sample)
    return Outcome(found.measurement, decided(found.holds), _declined(study))


def _declined(study: Study) -> str:
    return f"{study.declined} more poses have no certain state and are left out" if study.declined else ""


def three_types(survey: Survey) -> Finding:
    """Counts of the classes and of what they do not describe."""
    states = list(survey.states())
    classes = Counter(state.state_class for state in states)
    flush = sum(Flag.FLUSH in state.flags for state in states)
    without = sum(Flag.NO_THIRD in state.flags for state in states)
    return Finding(
        f"{classes[UNSTABLE]:,} unstable, of which {without:,} have no third contact; {classes[QUASI_STABLE]:,} "
        f"quasi-stable; {classes[STABLE]:,} stable, of which {flush:,} lie flush",
        all(classes[one] for one in (UNSTABLE, QUASI_STABLE, STABLE)),
    )


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.ENTIRE_GAMUT, approaches_see_all),
    (statements.EIGHTY_ONE, in_every_reading(each_its_own_points)),
    (statements.NOT_PARALLEL, in_every_reading(ends_not_parallel)),
    (statements.EXHAUSTIVE, grid_sees_all),
    (statements.THREE_TYPES, in_every_reading(three_types)),
)
