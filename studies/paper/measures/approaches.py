"""Measurements on the eight approaches (section 7 and 7.1)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import replace

from studies.paper import statements
from studies.paper.claim import MAJORITY, NEAR_IN_PHASE, Finding, Outcome, Read, Statement, decided, settled
from studies.paper.measures.cases import in_every_reading
from studies.paper.readings import Reading
from studies.paper.revolution import Revolution
from studies.paper.study import Measure, Study, Survey
from threadstate.history.falls import SNAP_PITCHES
from threadstate.history.model import CIRCLE_DEG
from threadstate.state.model import ContactState, Flag, StateClass

OUTERMOST_DEG = 4
STEP_DEG = 5
UNSTABLE, QUASI_STABLE, STABLE = (
    StateClass.UNSTABLE_TWO_POINT,
    StateClass.QUASI_STABLE_TWO_POINT,
    StateClass.STABLE_THREE_POINT,
)

Classify = Callable[[ContactState], StateClass]


def approaches(survey: Survey) -> list[Revolution]:
    """The eight approaches, in steps of 5 deg of phase."""
    tilts = (-OUTERMOST_DEG, 0, OUTERMOST_DEG)
    chosen = (survey.revolutions[roll, pitch] for roll in tilts for pitch in tilts if roll or pitch)
    return [_thinned(revolution) for revolution in chosen]


def _thinned(revolution: Revolution) -> Revolution:
    every = max(1, STEP_DEG // revolution.step_deg)
    return replace(revolution, step_deg=revolution.step_deg * every, states=revolution.states[::every])


def declared_class(state: ContactState) -> StateClass:
    """The class by the method: a bolt that comes to lie flush is stable."""
    return state.state_class


def flush_is_unstable(state: ContactState) -> StateClass:
    """The class where a bolt that comes to lie flush counts as a third contact not found."""
    return UNSTABLE if Flag.FLUSH in state.flags else state.state_class


def in_both_treatments(test: Callable[[Survey, Classify], Finding]) -> Measure:
    """The measurement that puts both readings to the test, flush states counted as stable and as unstable."""

    def measure(study: Study) -> Outcome:
        first = study.turned_first
        others = [
            Read("lying flush counts as unstable", test(study.declared, flush_is_unstable)),
            Read(Reading.TURN_FIRST.value, test(first, declared_class)),
            Read(f"{Reading.TURN_FIRST.value} and lying flush counts as unstable", test(first, flush_is_unstable)),
        ]
        return settled(test(study.declared, declared_class), others)

    return measure


def eight_approaches(study: Study) -> Outcome:
    """How many approaches there are."""
    count = len(approaches(study.declared))
    return Outcome(f"{count}", decided(count == 8))


def snaps(survey: Survey) -> Finding:
    """Orientations with a snap near in phase, and those without."""
    tilted = list(survey.tilted())
    falls = {(one.roll_deg, one.pitch_deg): _snap_in_phase(one) for one in tilted}
    largest = max((fall for fall in falls.values() if fall is not None), default=0.0)
    without = [tilt for tilt, fall in falls.items() if fall is None]
    pitched = sum(pitch > 0 for _, pitch in without)
    return Finding(
        f"{len(tilted) - len(without)} of {len(tilted)} orientations snap, by up to {largest:.6f} in; of the "
        f"{len(without)} that do not, {pitched} have a positive pitch",
        not without,
    )


def _snap_in_phase(one: Revolution) -> float | None:
    """The whole fall of the orientation's snap; None where there is none near phase 0."""
    falls = one.falls()
    snap = falls.snap(SNAP_PITCHES * one.pair.thread_pitch)
    if snap is None or falls.steepest is None:
        return None
    off_phase = min(falls.steepest.start_deg, CIRCLE_DEG - falls.steepest.start_deg)
    return snap.fall if off_phase <= NEAR_IN_PHASE else None


def _counts(survey: Survey, classify: Classify) -> Counter[StateClass]:
    return Counter(classify(state) for one in approaches(survey) for state in one.states)


def _counted(counts: Counter[StateClass]) -> str:
    return f"{counts[UNSTABLE]} unstable, {counts[QUASI_STABLE]} quasi-stable, {counts[STABLE]} stable"


def mostly_embedded(survey: Survey, classify: Classify) -> Finding:
    """The share of unstable states."""
    counts = _counts(survey, classify)
    return Finding(_counted(counts), counts[UNSTABLE] > MAJORITY * counts.total())


def stable_in_each(survey: Survey, classify: Classify) -> Finding:
    """Stable states of every approach."""
    counts = [sum(classify(state) is STABLE for state in one.states) for one in approaches(survey)]
    return Finding(f"{min(counts)} to {max(counts)} of {len(approaches(survey)[0].states)}", min(counts) > 0)


def stable_is_rarest(survey: Survey, classify: Classify) -> Finding:
    """Counts of the classes."""
    counts = _counts(survey, classify)
    return Finding(_counted(counts), counts[STABLE] < min(counts[UNSTABLE], counts[QUASI_STABLE]))


def quasi_stable_occurs(survey: Survey) -> Finding:
    """Quasi-stable states of roll 4, pitch 4."""
    states = next(one.states for one in approaches(survey) if one.roll_deg > 0 and one.pitch_deg > 0)
    count = sum(state.state_class is QUASI_STABLE for state in states)
    return Finding(f"{count} of {len(states)}", count > 0)


MEASURED_OVER_ALL: tuple[tuple[Statement, Measure], ...] = (
    (statements.EIGHT, eight_approaches),
    (statements.SNAP, in_every_reading(snaps)),
)

MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.MOSTLY_EMBEDDED, in_both_treatments(mostly_embedded)),
    (statements.QUASI_PRESENT, in_every_reading(quasi_stable_occurs)),
    (statements.EACH_APPROACH, in_both_treatments(stable_in_each)),
    (statements.LEAST_OFTEN, in_both_treatments(stable_is_rarest)),
)
