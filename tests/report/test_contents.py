"""What a report says of a map: counts, worst orientations, the path that is shown."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from tests.report.example import DATE, FIRST_TO_FAIL, FRICTIONS, GRID, INPUTS, cell, orientations
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath
from threadstate.device.model import Outcome, SettledMargins, SettledState
from threadstate.report.contents import ChosenPath, Report, default_path, made_report
from threadstate.report.words import MINUS, NEWTON, NOTHING, answer, counted, critical_words, listed, rounded
from threadstate.success.model import CriticalFriction, OrientationMap
from threadstate.success.scaled import scaled_orientation
from threadstate.units import LengthUnit

POSE = ChosenPath(0.0, 0.0, 0.0, 0.0, "asked for", is_default=False)
NOT_SETTLED = SettledState(
    *(0.0, 0.0, 0.0, Outcome.UNDECIDED, (), None, None, None, (), None, ()),
    SettledMargins(None, None, None, None, None),
    (),
)
NO_PATH = AssemblyPath(NOT_SETTLED, INPUTS.strategy, 0.0, AssemblyOutcome.UNDECIDED, (), (), (), None, None, None)


def report_of(found: tuple[OrientationMap, ...], unit: LengthUnit = LengthUnit.INCH) -> Report:
    """A report without a path."""
    return made_report(INPUTS, found, POSE, NO_PATH, unit=unit, title="", date=DATE, libraries=())


def engaging(mu: float) -> int:
    """How many orientations of the made-up map engage from both phases."""
    return sum(
        all(cell(one.roll_deg, one.pitch_deg, phase_deg, mu).engages for phase_deg in GRID.phases_deg)
        for one in orientations()
    )


def test_what_engages_is_counted_at_each_friction() -> None:
    report = report_of(orientations())
    assert [part.area.engaged for part in report.parts] == [engaging(mu) for mu in FRICTIONS] == [15, 14, 12]
    assert [part.undecided_paths for part in report.parts] == [0, 2, 3]
    assert [part.reasons for part in report.parts] == [(), (("ambiguous", 2),), (("ambiguous", 2), ("bounded", 1))]
    assert len(report.without_friction) == 15
    assert not report.undecided_without_friction


def test_the_first_failure_is_a_certain_one() -> None:
    report = report_of(orientations())
    # The undecided one is known no farther than 0.05, and is not called a failure.
    assert (report.worst[0].roll_deg, report.worst[0].pitch_deg) == (2.0, -2.0)
    first = report.first_failure
    assert first is not None
    assert (first.roll_deg, first.pitch_deg, first.critical.phase_deg) == FIRST_TO_FAIL[:3]
    assert first.critical.last is not None
    assert first.critical.first is not None
    assert first.critical.last <= FIRST_TO_FAIL[3] < first.critical.first


def test_those_that_fail_without_friction_are_listed_from_level_on() -> None:
    failing = report_of(orientations()).failing_without_friction
    tilts = [math.hypot(one.roll_deg, one.pitch_deg) for one in failing]
    assert len(failing) == 10
    assert all(one.pitch_deg > 0.0 for one in failing)
    assert tilts == sorted(tilts)


def test_an_orientation_that_is_undecided_without_friction_neither_engages_nor_fails() -> None:
    unknown = replace(
        orientations()[0], critical=CriticalFriction(None, 0.0, 0.0, AssemblyOutcome.UNDECIDED, reenters=False)
    )
    at_zero = replace(cell(0.0, 0.0, 0.0, 0.0), outcome=AssemblyOutcome.UNDECIDED)
    unknown = replace(unknown, cells=tuple(at_zero if c.phase_deg == c.mu == 0.0 else c for c in unknown.cells))
    report = report_of((unknown, *orientations()[1:]))
    assert report.undecided_without_friction == (unknown,)
    assert unknown not in (*report.without_friction, *report.failing_without_friction)


def test_the_path_shown_is_the_worst_that_engages() -> None:
    chosen = default_path(INPUTS, orientations())
    # The one that is undecided at 0.1 is known to engage without friction alone; of its phases 180 has more torque.
    assert (chosen.roll_deg, chosen.pitch_deg, chosen.phase_deg, chosen.mu) == (2.0, -2.0, 180.0, 0.0)
    assert chosen.is_default
    without = tuple(one for one in orientations() if (one.roll_deg, one.pitch_deg) != (2.0, -2.0))
    chosen = default_path(INPUTS, without)
    assert (chosen.roll_deg, chosen.pitch_deg, chosen.phase_deg, chosen.mu) == (*FIRST_TO_FAIL[:3], 0.1)


def test_of_orientations_that_engage_at_every_friction_the_one_of_the_largest_torque_is_shown() -> None:
    throughout = tuple(one for one in orientations() if one.critical.last is not None and one.critical.first is None)
    torques = {(one.roll_deg, one.pitch_deg): abs(one.roll_deg) for one in throughout}
    chosen = default_path(INPUTS, throughout)
    assert len(set(torques.values())) == 3
    assert torques[chosen.roll_deg, chosen.pitch_deg] == max(torques.values())
    assert (chosen.phase_deg, chosen.mu) == (180.0, FRICTIONS[-1])
    assert chosen.why.startswith("The orientations that engage from every starting phase do so at every friction")


def test_an_orientation_that_no_friction_leaves_engaging_still_engages_without() -> None:
    critical = CriticalFriction(0.0, 0.005, 0.0, AssemblyOutcome.IDLE, reenters=False)
    slick = replace(orientations()[0], critical=critical, cells=(*orientations()[0].cells, cell(0.0, 0.0, 0.0, 0.005)))
    report = report_of((slick, *orientations()[1:]))
    assert slick in report.without_friction
    assert report.worst[0] is slick
    assert critical_words(critical) == "0 to 0.005 (idle)"


def test_where_no_orientation_engages_the_path_shown_is_said_to_be_another() -> None:
    failing = tuple(one for one in orientations() if one.pitch_deg > 0.0)
    chosen = default_path(INPUTS, failing)
    assert chosen.why.startswith("No path engages")
    assert (chosen.roll_deg, chosen.pitch_deg) == (0.0, 1.0)
    first = failing[0]
    engaged = replace(cell(0.0, 0.0, 180.0, 0.0), torque=0.7)
    cells = tuple(engaged if (c.mu, c.phase_deg) == (0.0, 180.0) else c for c in first.cells)
    chosen = default_path(INPUTS, (replace(first, cells=cells), *failing[1:]))
    assert (chosen.roll_deg, chosen.pitch_deg, chosen.phase_deg) == (first.roll_deg, first.pitch_deg, 180.0)
    assert chosen.why.startswith("No orientation engages from every starting phase")


def test_lengths_are_in_the_unit_of_the_report_and_the_hash_is_that_of_the_map() -> None:
    inches, millimetres = report_of(orientations()), report_of(orientations(), LengthUnit.MILLIMETRE)
    assert inches.content_sha256 == millimetres.content_sha256
    for own, other in zip(inches.parts, millimetres.parts, strict=True):
        assert own.torque is not None
        assert own.shift is not None
        assert other.torque == pytest.approx(25.4 * own.torque, rel=1e-15)
        assert other.shift == pytest.approx(25.4 * own.shift, rel=1e-15)
        assert other.tilt_deg == own.tilt_deg
    assert scaled_orientation(orientations()[0], 1.0) is orientations()[0]


def test_the_answer_has_the_numbers_of_the_map() -> None:
    engages, fails, asks, undecided = answer(report_of(orientations()))
    assert "Of 25 orientations, roll and pitch up to 2°" in engages
    assert "from both starting phases in 15 without friction, 14 at μ = 0.1 and 12 at μ = 0.2." in engages
    assert "10 orientations fail even without friction: the bolt does not snap in" in fails
    assert f"first certain failure is at roll 1°, pitch {MINUS}1°: it engages up to μ = 0.125" in fails
    assert "the bolt turns idly, without following the thread, from phase 180°" in fails
    assert f"without friction, 0.121 {NEWTON}in of torque, 0.242° of tilt and 0.00121 in of shift" in asks
    assert "2 of 50 paths at μ = 0.1 (2 ambiguous)" in undecided
    assert "3 of 50 paths at μ = 0.2 (2 ambiguous, 1 bounded)" in undecided


def test_an_answer_without_anything_that_engages_says_so() -> None:
    failing = tuple(
        replace(one, cells=tuple(replace(c, outcome=AssemblyOutcome.JAMMED) for c in one.cells))
        for one in orientations()
    )
    _, _, asks, undecided = answer(report_of(failing))
    assert asks.startswith("No path of the map engages")
    assert undecided == "Every path of the map has a certain outcome."


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, NOTHING),
        (-0.0, "0"),
        (-1.23456, f"{MINUS}1.235"),
        (123456.0, "123500"),
        (8.649e-05, "0.00008649"),
        (1.5e-12, f"1.5e{MINUS}12"),
    ],
)
def test_numbers_are_rounded_and_have_no_exponent_unless_they_are_tiny(value: float | None, text: str) -> None:
    assert rounded(value) == text


def test_words_of_counts_and_critical_frictions() -> None:
    assert listed(["a"]) == "a"
    assert listed(["a", "b", "c"]) == "a, b and c"
    assert (counted(1, "phase"), counted(1000, "phase")) == ("1 phase", "1,000 phases")
    no_snap = AssemblyOutcome.NO_SNAP
    assert critical_words(CriticalFriction(0.3, None, None, None, reenters=False)) == "at least 0.3"
    assert critical_words(CriticalFriction(0.1, 0.11, 0.0, no_snap, reenters=False)) == "0.1 to 0.11 (no snap)"
    assert (
        critical_words(CriticalFriction(None, 0.0, 0.0, no_snap, reenters=False)) == "none (no snap without friction)"
    )
