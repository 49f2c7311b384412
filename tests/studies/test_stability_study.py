"""The stability study's parts that count and draw, and a very small run from end to end."""

from __future__ import annotations

import csv
import io
import math
import xml.etree.ElementTree as ET
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from studies.methods import Case, MeshStates
from studies.stability import page_exact, page_methods
from studies.stability.agreement import Outcome
from studies.stability.brute_force import Fault
from studies.stability.descent_study import OutcomeRow, WrongHeight, first_height, height_outcome, recheck
from studies.stability.events import EventKind, events_along, phase_line
from studies.stability.findings import Extent, Findings, RivalExtent, findings
from studies.stability.maps import DECADE_MAP, MAPS, colours, drawn
from studies.stability.page import page
from studies.stability.rival_study import RivalTally, Wrong, thinned
from studies.stability.tally import Tally, described
from studies.stability.tangent_study import error_deg, printed_angles, two_argument_angles
from studies.stability.trials import DECADES, SCALES, Kind, perturbations, rescaled, with_tolerances, with_whole_turns
from tests.studies.states import EXACT, PAIR, THREE_POINT, answered
from threadstate.library.grid import Grid
from threadstate.mesh.options import Descent
from threadstate.mesh.presets import Preset

pytestmark = pytest.mark.slow

CENTRE = Case(PAIR, THREE_POINT)
TUNNEL = Case(PAIR, (0.0, -4.0, 350.0))
SAFE, DECADES_DOWN = (MeshStates(Preset.COARSE, descent) for descent in (Descent.SAFE, Descent.DECADES))
EXTENT = Extent(
    lines=1,
    degrees=3,
    centres=1,
    grid=Grid(tilt_max_deg=4.0, tilt_step_deg=4.0, phase_step_deg=10.0),
    rivals=(RivalExtent(DECADES_DOWN, 1, 1, demonstrated=True),),
    descents=(DECADES_DOWN,),
    pitfall_poses=10,
    trials=13,
)


@pytest.fixture(scope="module")
def found() -> Findings:
    return findings(EXACT, PAIR, EXTENT, processes=1)


def test_perturbations_have_the_size_of_their_decade_and_repeat() -> None:
    trials = perturbations([CENTRE], 3)
    assert trials == perturbations([CENTRE], 3)
    assert trials != perturbations([CENTRE], 4)
    for trial in trials:
        if trial.kind is Kind.POSE:
            change = np.subtract(trial.case.pose_deg, CENTRE.pose_deg)
            assert trial.decade is not None
            assert np.abs(change).max() == pytest.approx(10.0**trial.decade, abs=2e-15)
    assert {trial.decade for trial in trials} == set(DECADES)
    assert {trial.kind for trial in trials} == {Kind.POSE, Kind.DIMENSIONS}


def test_other_inputs_change_one_thing_alone() -> None:
    for trial in rescaled([CENTRE]):
        assert trial.case.pair.fit.nut_major_diameter == PAIR.fit.nut_major_diameter * trial.case.scale
        assert trial.case.pose_deg == THREE_POINT
    assert {trial.case.scale for trial in rescaled([CENTRE])} == set(SCALES)
    for trial in with_whole_turns([CENTRE]):
        assert math.remainder(trial.case.pose_deg[2] - THREE_POINT[2], 360.0) == pytest.approx(0.0, abs=1e-6)
    assert min(trial.case.options.tie_tolerance for trial in with_tolerances([CENTRE])) == 1e-14


def test_thinned_keeps_every_decade_of_the_pose() -> None:
    chosen = thinned(perturbations([CENTRE], 0), 13)
    assert [trial.decade for trial in chosen if trial.kind is Kind.POSE] == list(DECADES)
    assert len(chosen) == 13
    assert len(thinned(perturbations([CENTRE], 0), 2)) == 2


def test_events_are_found_and_halved_to_the_last_digit() -> None:
    events = events_along(EXACT, phase_line(Case(PAIR, (0.0, -4.0, 356.0)), 4))
    (jump,) = (event for event in events if event.kind is EventKind.JUMP)
    roll, pitch, phase = jump.case.pose_deg
    assert 357.0 < phase < 358.0
    here = answered(jump.case.pose_deg).state.poses[0].translation[2]
    behind = answered((roll, pitch, phase + 1e-6)).state.poses[0].translation[2]
    assert here - behind > 5e-5


def test_tallies_add_up_and_name_a_failure_once() -> None:
    one, other = Tally(trials=3, refused=1), Tally(trials=4)
    one.fail(Fault.LAW, CENTRE, "a")
    one.fail(Fault.LAW, CENTRE, "b")
    other.fail(Fault.CLASS, CENTRE, "c")
    one.record_change(-6, 1.0, 5.0, 0.0)
    other.record_change(-6, 2.0, 4.0, 1.0)
    one.add(other)
    assert (one.trials, one.refused) == (7, 1)
    assert [failure.detail for failure in one.failures] == ["a", "c"]
    assert one.largest == {-6: (2.0, 5.0, 1.0)}
    total = RivalTally()
    for outcome in (Outcome.RIGHT, Outcome.HEIGHT):
        part = RivalTally(flips_within=1, wrong=[Wrong(outcome, "here")])
        part.outcomes[outcome] += 2
        total.add(part)
    assert (total.case_count, total.flips_within, len(total.wrong)) == (4, 2, 2)


def test_a_case_is_described_by_what_reproduces_it() -> None:
    assert described(CENTRE) == "roll 1.0, pitch -2.0, phase 10.0"
    wider = replace(CENTRE, pair=replace(PAIR, thread_pitch=0.0501))
    assert described(wider) == "roll 1.0, pitch -2.0, phase 10.0, thread_pitch 0.0501"


def test_decades_tunnel_and_the_safe_descent_does_not() -> None:
    exact = answered(TUNNEL.pose_deg).state.poses[0].translation[2]
    for method, expected in ((SAFE, Outcome.RIGHT), (DECADES_DOWN, Outcome.HEIGHT)):
        height = first_height(method, TUNNEL).height
        assert height is not None
        assert height_outcome(exact, height, method.declared_error(PAIR)) is expected
    assert height_outcome(exact, None, 1.0) is Outcome.REFUSED
    assert height_outcome(None, exact, 1.0) is Outcome.NO_TRUTH


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_printed_angles_lose_a_sign_and_those_of_atan2_do_not(axis: int, sign: float) -> None:
    direction = np.full(3, 1e-3)
    direction[axis] = sign
    direction /= np.linalg.norm(direction)
    assert error_deg(two_argument_angles(direction), direction) < 1e-12
    mirrored = direction * (1.0, -1.0, 1.0)
    errors = [error_deg(printed_angles(one), one) for one in (direction, mirrored)]
    assert min(errors) < 1e-6
    assert max(errors) > 0.1


def test_a_map_covers_every_pose_once_and_is_well_formed() -> None:
    rows = [
        OutcomeRow(roll, pitch, (Outcome.RIGHT, Outcome.HEIGHT, Outcome.HEIGHT, Outcome.REFUSED))
        for roll in (-1.0, 1.0)
        for pitch in (0.0, 1.0, 2.0)
    ]
    image = colours(DECADE_MAP, rows)
    assert image.shape == (7, 4, 3)
    shades = [tuple(bytes.fromhex(shade.colour[1:])) for shade in DECADE_MAP.shades]
    counts = Counter(tuple(pose) for pose in image.reshape(-1, 3).tolist())
    assert counts == {shades[0]: 6, shades[1]: 12, shades[2]: 6, (255, 255, 255): 4}
    assert image[3].min() == 255
    picture = drawn(DECADE_MAP, rows)
    assert picture == drawn(DECADE_MAP, rows)
    texts = ["".join(one.itertext()) for one in ET.fromstring(picture).iter("{http://www.w3.org/2000/svg}text")]
    named = {DECADE_MAP.title, DECADE_MAP.caption, "roll -1", "roll 1", "pitch", "330"}
    assert named | {shade.meaning for shade in DECADE_MAP.shades} <= set(texts)


def test_the_study_finds_the_hard_places_and_classifies_every_pose(found: Findings) -> None:
    assert len(found.places) >= 8
    assert found.total.trials == sum(len(chunk.trials) for place in found.places for chunk in EXTENT.chunks(place))
    counted = found.total
    followed = counted.same_contacts + counted.other_contacts + counted.unfollowed + counted.without_centre
    assert followed + counted.refused == counted.trials
    assert sum(len(row.poses) for row in found.rows) == EXTENT.grid.pose_count
    outcomes = [one for row in found.descents for one in row.outcomes(0)]
    assert len(outcomes) == EXTENT.grid.pose_count
    assert outcomes.count(Outcome.HEIGHT) == len(found.rechecks) > 0
    (tallies,) = found.rivals.values()
    assert sum(tally.case_count for tally in tallies) == 2 * len(found.places)
    assert found.pitfalls.averaged_off > 0.05
    assert found.pitfalls.flush_met < found.pitfalls.flush_pairs


def test_a_recheck_distinguishes_tunnelling_from_a_jump_that_meshes_have_elsewhere() -> None:
    exact = answered(TUNNEL.pose_deg).state.poses[0].translation[2]
    height = first_height(DECADES_DOWN, TUNNEL).height
    assert height is not None
    checked = recheck(EXACT, WrongHeight(DECADES_DOWN, TUNNEL, height, exact))
    assert not checked.beside_event
    behind = Case(PAIR, (0.0, -4.0, 358.0))
    height = first_height(SAFE, behind).height
    assert height is not None
    exact = answered(behind.pose_deg).state.poses[0].translation[2]
    assert height_outcome(exact, height, SAFE.declared_error(PAIR)) is Outcome.HEIGHT
    checked = recheck(EXACT, WrongHeight(SAFE, behind, height, exact))
    assert checked.finer is Outcome.RIGHT


def test_the_page_says_what_was_found(found: Findings) -> None:
    text = page(found)
    assert text == page(found)
    assert all(f"| {place.name} |" in text for place in found.places)
    assert all(one.demonstration.mode in text for one in found.shown)
    assert f"{found.total.trials:,} perturbed poses" in text
    assert all(f"(stability/{chart.name}.svg)" in text for chart in MAPS)
    assert f"(stability/{DECADE_MAP.name}.svg)" in text
    for chart in MAPS:
        ET.fromstring(drawn(chart, found.rows))


def test_lists_hold_every_pose_that_is_not_right(found: Findings) -> None:
    descents = list(csv.DictReader(io.StringIO(page_methods.descents_csv(found))))
    wrong = [one for row in found.descents for one in row.outcomes(0)]
    assert len(descents) == sum(one is not Outcome.RIGHT for one in wrong)
    assert {"0,-4,350"} <= {f"{one['roll_deg']},{one['pitch_deg']},{one['phase_deg']}" for one in descents}
    listed = list(csv.DictReader(io.StringIO(page_methods.wrong_csv(found))))
    assert len(listed) == sum(len(tally.wrong) for tallies in found.rivals.values() for tally in tallies)
    failures = list(csv.DictReader(io.StringIO(page_exact.failures_csv(found))))
    assert len(failures) == len(found.total.failures) + sum(len(row.broken) for row in found.rows)


def test_the_page_of_the_documentation_is_of_the_whole_study(repository_root: Path) -> None:
    text = (repository_root / "docs" / "stability.md").read_text()
    assert "29,160" in text
    for kind in (EventKind.TIE, EventKind.JUMP, EventKind.DOUBLE_ROOT, EventKind.FLUSH, EventKind.DROP):
        assert f"| {kind.value} |" in text
    for name in ("failures.csv", "descents.csv", "wrong-meshes.csv"):
        assert (repository_root / "docs" / "stability" / name).is_file()
