"""What the stability study calls wrong: laws, changes, the brute force, agreement with the exact answers."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from studies.certificate.exact import UncoveredError
from studies.methods import Case, Refusal, scaled
from studies.stability.agreement import Outcome, about, difference, flips_within_margins, outcome, truths
from studies.stability.brute_force import (
    CROSSING_WIDTH_DEG,
    HEIGHT_TOLERANCE_INCH,
    Event,
    Fault,
    explanation,
    first_height_near,
    missed_first,
    missed_later,
    wrong_embedment,
)
from studies.stability.change import SolvedCase, at_scale_one, change_between, has_jumped, is_steady
from studies.stability.crossings import crossing_height
from studies.stability.laws import broken_laws
from studies.stability.place_study import Neighbourhood
from tests.studies.states import EXACT, FLUSH, PAIR, THREE_POINT, answered
from threadstate.state.model import ContactState, StateClass
from threadstate.state.solve import solve_pose

pytestmark = pytest.mark.slow


def changed(one: SolvedCase, **values: object) -> SolvedCase:
    return SolvedCase(one.case, replace(one.state, **values))  # type: ignore[arg-type]


def moved_up(one: SolvedCase, lift: float) -> SolvedCase:
    """The same state with its first pose, and nothing else, higher."""
    first, *rest = one.state.poses
    x, y, z = first.translation
    return changed(one, poses=(replace(first, translation=(x, y, z + lift)), *rest))


@pytest.mark.parametrize("pose", [THREE_POINT, FLUSH, (0.0, -4.0, 0.0), (0.0, 0.0, 180.0)])
def test_laws_find_nothing_wrong_with_right_states(pose: tuple[float, float, float]) -> None:
    assert broken_laws(EXACT, answered(pose)) == []


def test_laws_find_what_is_wrong() -> None:
    right = answered(THREE_POINT)
    first, *rest = right.state.contacts
    x, y, z = first.point
    assert right.state.lambda_deg is not None
    assert right.state.drop is not None
    wrong = {
        "off": changed(right, contacts=(replace(first, point=(x, y, z + 1e-8)), *rest)),
        "normal": changed(right, contacts=(replace(first, normal=(0.0, 0.0, -1.0)), *rest)),
        "first pose": SolvedCase(Case(PAIR, (1.0, -2.0, 10.0 + 1e-9)), right.state),
        "turn": changed(right, lambda_deg=right.state.lambda_deg + 1e-6),
        "drop": changed(right, drop=right.state.drop + 1e-8),
        "class": changed(right, state_class=StateClass.UNSTABLE_TWO_POINT),
        "finite": changed(right, mu_deg=math.nan),
        "pivot offset": changed(right, pivot_offset=0.1),
    }
    for word, state in wrong.items():
        assert any(word in broken for broken in broken_laws(EXACT, state)), word


def test_change_is_the_largest_of_each_kind_and_none_between_other_stages() -> None:
    right = answered(THREE_POINT)
    near = answered((1.0, -2.0, 10.0 + 1e-6))
    change = change_between(right, near)
    assert change is not None
    assert 0.0 < change.height < 1e-7
    assert change.largest < 1e-6
    assert is_steady(right, near)
    assert not has_jumped(right, near)
    assert change_between(right, answered(FLUSH)) is None
    assert has_jumped(right, answered(FLUSH))
    assert has_jumped(right, moved_up(near, 2e-6))


def test_a_scaled_state_comes_back_to_scale_one() -> None:
    right = answered(THREE_POINT)
    case = Case(scaled(PAIR, 1e3), THREE_POINT, scale=1e3)
    (state,) = EXACT.answers([case])
    assert isinstance(state, ContactState)
    back = at_scale_one(SolvedCase(case, state), PAIR)
    change = change_between(right, back)
    assert change is not None
    assert change.largest < 1e-12
    assert is_steady(right, back)


def jump_sides() -> tuple[SolvedCase, SolvedCase]:
    """The two sides of the jump of roll 0, pitch -4, some 1e-6 deg of phase apart."""
    low, high = 357.0, 358.0
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        if answered((0.0, -4.0, middle)).state.poses[0].translation[2] > 0.0:
            low = middle
        else:
            high = middle
    return answered((0.0, -4.0, low)), answered((0.0, -4.0, high))


def test_brute_force_accepts_a_jump_and_no_bolt_that_falls_without_one() -> None:
    above, below = jump_sides()
    assert explanation(above, below) is Event.FIRST_LOST
    assert not missed_first(above)
    tunnelled = replace(below, case=above.case)
    plainly = replace(below, case=Case(PAIR, (0.0, -4.0, 350.0)))
    assert missed_first(plainly)
    assert explanation(above, tunnelled) is Fault.MISSED_FIRST


ABOVE_DEG = (0.1790897872143572, 0.22899434491659199, 357.71407167189835)
BELOW_DEG = (0.1790897872143572, 0.22899434491659199, 357.7140716718984)
"""Between these phases, one unit in the last place apart, two edges part that overlap by 1e-17 in before."""


def test_whether_edges_part_is_told_in_fifty_digits_where_doubles_cannot() -> None:
    above, below = answered(ABOVE_DEG), answered(BELOW_DEG)
    held = above.state.contacts[0]
    heights = [crossing_height(PAIR, pose_deg, held, CROSSING_WIDTH_DEG) for pose_deg in (ABOVE_DEG, BELOW_DEG)]
    assert heights == [pytest.approx(above.state.poses[0].translation[2], abs=1e-10), None]
    seen_by_doubles = first_height_near(PAIR, BELOW_DEG, held)
    assert seen_by_doubles > below.state.poses[0].translation[2] + HEIGHT_TOLERANCE_INCH
    assert explanation(above, below) is Event.FIRST_LOST
    assert explanation(above, replace(below, case=above.case)) is Fault.MISSED_FIRST


def test_a_crossing_that_is_not_near_is_not_decided() -> None:
    held = answered(ABOVE_DEG).state.contacts[0]
    with pytest.raises(UncoveredError, match="not widest near"):
        crossing_height(PAIR, ABOVE_DEG, held, 1e-6)


def test_brute_force_finds_a_turn_that_passes_a_contact() -> None:
    right = answered(THREE_POINT)
    assert not missed_later(right)
    assert right.state.mu_deg is not None
    assert missed_later(changed(right, mu_deg=right.state.mu_deg + 0.1))


def test_brute_force_measures_the_least_lift() -> None:
    right = answered((-4.0, 0.0, 131.0))
    assert right.state.embedment is not None
    assert wrong_embedment(right) == ""
    assert "least lift" in wrong_embedment(changed(right, embedment=right.state.embedment + 1e-6))


def test_routes_from_a_centre_are_steady_or_cross_events_that_are_explained() -> None:
    above, below = jump_sides()
    nowhere = Neighbourhood(EXACT, answered(THREE_POINT))
    assert nowhere.route_to(answered((1.0, -2.0, 10.0 + 1e-6)), divisible=True) == ()
    assert nowhere.events == []
    around = Neighbourhood(EXACT, above)
    route = around.route_to(below, divisible=True)
    assert route is not None
    assert route[-1] is Event.FIRST_LOST
    assert set(route) <= {Event.STEEP, Event.FIRST_LOST}
    assert {explained for explained, _, _ in around.events} == {Event.FIRST_LOST}


ERROR = 5e-4


def test_poses_about_a_case_are_as_far_as_the_error_moves_the_bolt() -> None:
    case = Case(PAIR, THREE_POINT)
    poses = [one.pose_deg for one in about(case, ERROR)]
    assert poses[0] == THREE_POINT
    assert len(set(poses)) == 15
    wider, narrower = (one.pair.fit.bolt_pitch_diameter for one in about(case, ERROR)[-2:])
    assert (wider - narrower) / 4.0 == pytest.approx(ERROR)
    largest = max(abs(a - b) for pose in poses for a, b in zip(pose, THREE_POINT, strict=True))
    assert math.radians(largest) * case.reach == pytest.approx(ERROR)


def test_outcome_names_the_first_stage_that_is_wrong() -> None:
    right = answered(THREE_POINT)
    state = right.state
    known = truths(EXACT, right.case, ERROR)
    assert known[0] == right
    assert outcome(right.case, state, known, ERROR) is Outcome.RIGHT
    assert outcome(right.case, Refusal("cannot"), known, ERROR) is Outcome.REFUSED
    assert outcome(right.case, state, [], ERROR) is Outcome.NO_TRUTH
    assert difference(moved_up(right, 0.9 * ERROR), right, ERROR) is Outcome.RIGHT
    assert difference(moved_up(right, 1.1 * ERROR), right, ERROR) is Outcome.HEIGHT
    for stage, expected in ((1, Outcome.FIRST), (2, Outcome.SECOND), (3, Outcome.THIRD)):
        elsewhere = tuple(
            replace(one, point=(-one.point[0], -one.point[1], one.point[2])) if one.stage == stage else one
            for one in state.contacts
        )
        assert difference(changed(right, contacts=elsewhere), right, ERROR) is expected
    assert state.lambda_deg is not None
    assert difference(changed(right, lambda_deg=state.lambda_deg + 3.0), right, ERROR) is Outcome.SECOND
    assert difference(changed(right, mu_deg=None), right, ERROR) is Outcome.THIRD
    assert difference(changed(right, state_class=StateClass.UNSTABLE_TWO_POINT), right, ERROR) is Outcome.CLASS


def test_either_side_of_an_event_nearer_than_the_error_is_right() -> None:
    above, below = jump_sides()
    known = truths(EXACT, above.case, ERROR)
    assert difference(below, above, ERROR) is Outcome.HEIGHT
    assert outcome(above.case, below.state, known, ERROR) is Outcome.RIGHT
    assert outcome(above.case, below.state, truths(EXACT, above.case, 1e-12), 1e-12) is Outcome.HEIGHT


def test_flips_need_a_small_margin() -> None:
    right = answered(THREE_POINT)
    margins = [right.state.drop_margin, right.state.embedment_margin, right.state.pivot_margin]
    least = min(abs(margin) for margin in margins if margin is not None)
    assert flips_within_margins(right, right, 1.01 * least)
    assert not flips_within_margins(right, right, 0.99 * least)


@pytest.mark.parametrize(
    "pose",
    [
        (0.5653341813910805, 0.3923694226441425, 2.3251282285121024),
        (0.1790897789812174, 0.22899435491659198, 2.293028984010698),
    ],
)
def test_a_crossing_whose_faces_doubles_cannot_tell_apart_is_not_taken_for_a_contact(
    pose: tuple[float, float, float],
) -> None:
    """Edges cross there at an angle of 1e-8 rad: signs of a normal that is off by 1e-7 were none."""
    state = solve_pose(PAIR, *pose)
    assert len(state.contacts) == 3
    assert broken_laws(EXACT, SolvedCase(Case(PAIR, pose), state)) == []
