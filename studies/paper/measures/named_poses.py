"""Measurements on the three poses that the paper names (figures 19 to 21), whatever the datum of its phase."""

from __future__ import annotations

from collections.abc import Callable

from studies.paper import statements
from studies.paper.claim import NEAR_SURFACE, ON_SURFACE, Outcome, Statement, Verdict
from studies.paper.readings import Reading
from studies.paper.study import FIG_19, FIG_20, FIG_21, Measure, Named, Study
from threadstate.state.model import ContactState, Flag, StateClass

Test = Callable[[ContactState], bool]


SHORT = {
    Reading.DECLARED: "as declared",
    Reading.TURN_FIRST: "turned first",
    Reading.TURN_FIRST_REVERSED: "turned first and reversed",
}
"""The readings in few words."""


def at_every_datum(pose: Named, test: Test, shown: Callable[[ContactState], str]) -> Measure:
    """The measurement of a named pose as declared, and over all choices of datum and reading."""

    def measure(study: Study) -> Outcome:
        state = study.named[pose, Reading.DECLARED][0]
        return _over_data(study, shown(state), lambda reading, i: test(study.named[pose, reading][i]))

    return measure


def _over_data(study: Study, shown: str, holds: Callable[[Reading, int], bool]) -> Outcome:
    """The outcome of what holds or not in a reading with a datum, the declared datum first.

    Agrees if it holds as declared, disagrees if nowhere; else the datum of phase decides.
    """
    step, count = study.scale.phase_step_deg, len(study.scale.phases_deg)
    data = {reading: [i * step for i in range(count) if holds(reading, i)] for reading in Reading}
    holding = sum(map(len, data.values()))
    measurement = f"{shown}; holds with {holding:,} of {count * len(Reading):,} choices of datum and reading"
    if not holding:
        return Outcome(measurement, Verdict.DISAGREES)
    listed = "; ".join(f"{ranges(at, step)} {SHORT[reading]}" for reading, at in data.items() if at)
    verdict = Verdict.AGREES if 0 in data[Reading.DECLARED] else Verdict.UNDECIDED
    return Outcome(measurement, verdict, f"with the phase counted from (deg): {listed}")


def ranges(values: list[int], step: int) -> str:
    """Growing values as ranges of that step."""
    starts = [value for i, value in enumerate(values) if i == 0 or value - values[i - 1] != step]
    ends = [value for i, value in enumerate(values) if i + 1 == len(values) or values[i + 1] - value != step]
    return ", ".join(f"{a}" if a == b else f"{a} to {b}" for a, b in zip(starts, ends, strict=True))


def _class(state: ContactState) -> str:
    name = state.state_class.value.replace("_", " ")
    return f"{name}, lying flush" if Flag.FLUSH in state.flags else name


def _class_test(wanted: StateClass) -> Test:
    return lambda state: state.state_class is wanted


def _lengths(state: ContactState) -> str:
    if state.drop is None or state.embedment is None or state.pivot_offset is None:
        return f"no third contact ({_class(state)})"
    return f"drop {state.drop:.5f} in, embedment {state.embedment:.5f} in, pivot offset {state.pivot_offset:.4f} in"


def _heights(state: ContactState) -> str:
    listed = ", ".join(f"{pose.translation[2]:.5f}" for pose in state.poses)
    return f"origin at {listed} in, stage by stage"


def _depths(state: ContactState) -> str:
    depths = ", ".join(f"{contact.point[2] + 0.0:.5f}" for contact in state.contacts)
    return f"contacts at z = {depths} in; {_lengths(state)}"


def _close(value: float | None, stated: str) -> bool:
    """Whether a length rounds to the one that is printed."""
    digits = len(stated.partition(".")[2])
    return value is not None and abs(value - float(stated)) <= 0.5 * 10.0**-digits


def _heights_19(thread_pitch: float) -> Test:
    def test(state: ContactState) -> bool:
        if len(state.poses) < 3:
            return False
        second, third = (pose.translation[2] for pose in state.poses[1:])
        return any(_close(second + up, "0.047") and _close(third + up, "0.046") for up in (0.0, thread_pitch))

    return test


def height_19(study: Study) -> Outcome:
    """Heights of the origin of Fig. 19, of base or top."""
    return at_every_datum(FIG_19, _heights_19(study.pair.thread_pitch), _heights)(study)


def _lengths_test(drop: str, embedment: str) -> Test:
    return lambda state: _close(state.drop, drop) and _close(state.embedment, embedment)


def axis_20(study: Study) -> Outcome:
    """The pivot offset of Fig. 20."""
    near = 0.1 * study.pair.nominal_diameter / 2.0
    return at_every_datum(FIG_20, lambda s: s.pivot_offset is not None and s.pivot_offset <= near, _lengths)(study)


def _no_embedment(state: ContactState) -> bool:
    return state.embedment is not None and state.embedment <= ON_SURFACE


def _three_at_surface(state: ContactState) -> bool:
    at_surface = all(contact.point[2] >= -ON_SURFACE for contact in state.contacts)
    return at_surface and state.drop is not None and 0.0 < state.drop < NEAR_SURFACE


def one_datum_for_all(study: Study) -> Outcome:
    """Data and readings for which the three poses have the paper's three classes."""
    wanted = (
        (FIG_19, StateClass.UNSTABLE_TWO_POINT),
        (FIG_20, StateClass.QUASI_STABLE_TWO_POINT),
        (FIG_21, StateClass.STABLE_THREE_POINT),
    )
    shown = "; ".join(_class(study.named[pose, Reading.DECLARED][0]) for pose, _ in wanted)
    return _over_data(
        study,
        shown,
        lambda reading, i: all(study.named[pose, reading][i].state_class is name for pose, name in wanted),
    )


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.CLASS_19, at_every_datum(FIG_19, _class_test(StateClass.UNSTABLE_TWO_POINT), _class)),
    (statements.HEIGHT_19, height_19),
    (statements.EMBEDMENT_19, at_every_datum(FIG_19, _lengths_test("0.001", "0.004"), _lengths)),
    (statements.CLASS_20, at_every_datum(FIG_20, _class_test(StateClass.QUASI_STABLE_TWO_POINT), _class)),
    (statements.DROP_20, at_every_datum(FIG_20, _lengths_test("0.0045", "0.0013"), _lengths)),
    (statements.AXIS_20, axis_20),
    (statements.CLASS_21, at_every_datum(FIG_21, _class_test(StateClass.STABLE_THREE_POINT), _class)),
    (statements.NO_EMBEDMENT_21, at_every_datum(FIG_21, _no_embedment, _lengths)),
    (statements.AT_SURFACE_21, at_every_datum(FIG_21, _three_at_surface, _depths)),
    (statements.ONE_DATUM, one_datum_for_all),
)
