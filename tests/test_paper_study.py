from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.paper import statements
from studies.paper.claim import Claim, Finding, Read, Verdict, settled, unanimous
from studies.paper.measures.case_one import MEASURED as CASE_ONE
from studies.paper.measures.named_poses import ranges
from studies.paper.page import Chapters, page, print_table, row
from studies.paper.readings import Reading, declared_angles
from studies.paper.registry import CHAPTERS, claims_by_chapter, statement_count
from studies.paper.revolution import sampled_curve
from studies.paper.study import FIG_19, FIG_21, Scale, Study, poses_to_solve, solved_study
from threadstate.history.descents import falls_of
from threadstate.history.falls import SNAP_PITCHES, SteepestFall
from threadstate.history.height_curve import height_curve
from threadstate.state.model import Flag, StateClass
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

SMALL = Scale(tilts_deg=(-4, 0, 4), phase_step_deg=1, sampled=100)


@pytest.fixture(scope="module")
def study() -> Study:
    """The study on nine orientations; as many poses as it announces."""
    solved: list[int] = []
    found = solved_study(SMALL, solved.append)
    assert sum(solved) == poses_to_solve(SMALL)
    return found


@pytest.fixture(scope="module")
def chapters(study: Study) -> Chapters:
    """Every chapter of the small study."""
    measured: list[int] = []
    found = claims_by_chapter(study, measured.append)
    assert sum(measured) == statement_count()
    return found


def claim_of(chapters: Chapters, statement: str) -> Claim:
    return next(claim for _, claims in chapters for claim in claims if claim.statement == statement)


def test_every_statement_is_there_once_and_has_an_outcome(chapters: Chapters) -> None:
    claims = [claim for _, found in chapters for claim in found]
    stated = [(one.reference, one.text) for chapter in CHAPTERS for one, _ in chapter.measured]
    assert [(claim.reference, claim.statement) for claim in claims] == stated
    assert len(set(stated)) == len(stated)
    assert all(claim.measurement and claim.test for claim in claims)
    assert {claim.verdict for claim in claims} == set(Verdict)


def test_what_cannot_be_decided_says_why(chapters: Chapters) -> None:
    undecided = [claim for _, found in chapters for claim in found if claim.verdict is Verdict.UNDECIDED]
    assert undecided
    assert all(claim.reason for claim in undecided)


def test_page_of_the_documentation_holds_every_statement_and_no_other(repository_root: Path) -> None:
    text = (repository_root / "docs" / "paper-claims.md").read_text()
    lines = [line[2:-2].split(" | ") for line in text.splitlines() if line.startswith("| ")]
    shown = [cells[:3] for cells in lines if len(cells) == 5 and cells[0] != "where"]
    assert shown == [[one.reference, one.text, one.test] for chapter in CHAPTERS for one, _ in chapter.measured]
    assert [line[3:] for line in text.splitlines() if line.startswith("## ")][1:-1] == [one.title for one in CHAPTERS]


def test_page_is_the_same_for_the_same_study(study: Study, chapters: Chapters) -> None:
    again = claims_by_chapter(study, lambda _: None)
    assert page(again, study) == page(chapters, study)
    assert all(row(claim) in page(chapters, study) for _, claims in chapters for claim in claims)


def test_table_shows_every_verdict_and_their_counts(chapters: Chapters, capsys: pytest.CaptureFixture[str]) -> None:
    claims = [claim for _, found in chapters for claim in found]
    print_table(claims)
    printed = capsys.readouterr().out
    counts = [sum(claim.verdict is verdict for claim in claims) for verdict in Verdict]
    assert printed.endswith(
        f"Of {len(claims)} statements {counts[0]} agree, {counts[1]} disagree, and {counts[2]} cannot be decided.\n"
    )


@pytest.mark.parametrize(
    ("declared", "other", "verdict"),
    [
        (True, True, Verdict.AGREES),
        (True, False, Verdict.AGREES),
        (False, True, Verdict.UNDECIDED),
        (False, False, Verdict.DISAGREES),
    ],
)
def test_verdict_follows_from_the_readings(declared: bool, other: bool, verdict: Verdict) -> None:
    outcome = settled(Finding("0.1 in", declared), [Read("read otherwise", Finding("0.2 in", other))])
    assert (outcome.verdict, outcome.measurement) == (verdict, "0.1 in")
    assert ("read otherwise" in outcome.reason) == (declared != other)
    assert ("0.2 in" in outcome.reason) == (verdict is Verdict.UNDECIDED)


@pytest.mark.parametrize(
    ("holds", "verdict"),
    [
        ((True, True), Verdict.AGREES),
        ((True, False), Verdict.UNDECIDED),
        ((False, True), Verdict.UNDECIDED),
        ((False, False), Verdict.DISAGREES),
    ],
)
def test_verdict_follows_from_all_meanings(holds: tuple[bool, bool], verdict: Verdict) -> None:
    outcome = unanimous("0.1 in", holds, "which is meant")
    assert outcome.verdict is verdict
    assert outcome.reason == ("which is meant" if verdict is Verdict.UNDECIDED else "")


def test_verdict_changes_with_what_was_solved(study: Study) -> None:
    measure = dict(CASE_ONE)[statements.CREST_SEQUENCE]
    alike = replace(study, declared=study.turned_first, geometries={})
    swapped = replace(alike, turned_first=study.declared)
    found = [measure(one).verdict for one in (study, swapped, alike)]
    assert found == [Verdict.AGREES, Verdict.UNDECIDED, Verdict.DISAGREES]


def test_verdict_on_a_named_pose_follows_from_the_data_of_phase(study: Study) -> None:
    measure = next(m for chapter in CHAPTERS for one, m in chapter.measured if one is statements.CLASS_19)
    stable = study.named[FIG_21, Reading.DECLARED][180]
    unstable = study.named[FIG_19, Reading.DECLARED][180]
    assert stable.state_class is StateClass.STABLE_THREE_POINT
    assert unstable.state_class is StateClass.UNSTABLE_TWO_POINT
    nowhere = {key: (stable,) * len(states) for key, states in study.named.items()}
    as_declared = nowhere | {(FIG_19, Reading.DECLARED): (unstable, stable)}
    elsewhere = nowhere | {(FIG_19, Reading.DECLARED): (stable, unstable)}
    small = replace(study, scale=replace(SMALL, phase_step_deg=180))
    verdicts = [measure(replace(small, named=named)).verdict for named in (as_declared, elsewhere, nowhere)]
    assert verdicts == [Verdict.AGREES, Verdict.UNDECIDED, Verdict.DISAGREES]


def test_measurements_are_those_of_the_solver(study: Study, chapters: Chapters) -> None:
    pair = quarter_twenty_unc()
    turn = [solve_pose(pair, 4, 0, phase) for phase in range(360)]
    at_surface = sum(state.contacts[0].point[2] >= -1e-9 for state in turn)
    assert claim_of(chapters, statements.ON_THE_SURFACE.text).measurement == f"4 deg: {at_surface / 360:.1%}"
    falls = [
        a.poses[0].translation[2] - b.poses[0].translation[2] for a, b in zip(turn, turn[1:] + turn[:1], strict=True)
    ]
    fall = claim_of(chapters, statements.NEGATIVE_SHIFT.text).measurement
    found = re.fullmatch(r"4 deg: (\S+) in from phase (\S+) on, \S+ times the lead, of (\S+) in", fall)
    assert found is not None
    steepest, start, whole = map(float, found.groups())
    later = solve_pose(pair, 4, 0, start + 1).poses[0].translation[2]
    assert max(falls) <= steepest <= whole
    # Phases are written to 0.005 deg, over which the height changes by up to 5e-6 in.
    assert steepest == pytest.approx(solve_pose(pair, 4, 0, start).poses[0].translation[2] - later, abs=5e-6)
    flush = sum(Flag.FLUSH in state.flags for one in study.declared.tilted() for state in one.states)
    assert claim_of(chapters, statements.NOT_PARALLEL.text).measurement.startswith(f"{flush:,} of 2,880 ")


def test_snaps_are_those_of_the_one_definition(study: Study, chapters: Chapters) -> None:
    pair = quarter_twenty_unc()
    tilts = [(one.roll_deg, one.pitch_deg) for one in study.declared.tilted()]
    falls = [falls_of(height_curve(pair, *tilt), pair.thread_pitch) for tilt in tilts]
    snaps = [snap.fall for one in falls if (snap := one.snap(SNAP_PITCHES * pair.thread_pitch)) is not None]
    assert claim_of(chapters, statements.SNAP.text).measurement.startswith(
        f"{len(snaps)} of 8 orientations snap, by up to {max(snaps):.6f} in; "
    )


def test_falls_between_samples_are_those_of_straight_lines() -> None:
    curve = sampled_curve(np.array([0.0, 4.0, 4.0, 3.0, -2.0, -1.0, 2.0, 1.0]), 45.0, 1.0)
    falls = falls_of(curve, 1.0, span_deg=67.5)
    assert [(one.start_deg, one.end_deg, one.fall) for one in falls.descents] == [
        (90.0, 180.0, 6.0),
        (270.0, 360.0, 2.0),
    ]
    assert falls.steepest == SteepestFall(5.5, 112.5, 0)
    assert not any(descent.jumps for descent in falls.descents)


def test_turning_first_is_another_pose_only_when_both_turned_and_tilted() -> None:
    assert declared_angles(Reading.TURN_FIRST, 3, 0, 0) == pytest.approx((3, 0, 0))
    assert declared_angles(Reading.TURN_FIRST, 0, 0, 50) == pytest.approx((0, 0, 50))
    # Turned by a quarter first, the roll about the nut's x is a tilt about the bolt's own -y.
    assert declared_angles(Reading.TURN_FIRST, 3, 0, 90) == pytest.approx((0, -3, 90))
    assert declared_angles(Reading.TURN_FIRST_REVERSED, 3, 0, -90) == pytest.approx((0, -3, 90))
    assert declared_angles(Reading.DECLARED, 3, 0, 90) == (3, 0, 90)


def test_ranges_are_broken_where_a_value_is_left_out() -> None:
    assert ranges([0, 1, 2, 5, 7, 8], 1) == "0 to 2, 5, 7 to 8"
    assert ranges([0, 5, 20], 5) == "0 to 5, 20"
