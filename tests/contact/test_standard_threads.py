"""Contacts of other threads than the default pair: the forms of the standards, tight and loose."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from oracle.first_height import first_height
from oracle.lift import least_lift
from oracle.profile import bolt_profile, nut_profile, radius
from oracle.state_turns import begins_at, earlier_appearance, turns_of, within_brute_force
from tests.contact.samples import random_poses
from tests.thread.shapes import BUTTRESS, TURNED_BUTTRESS
from threadstate.contact import _record_kernel as rk
from threadstate.errors import InvalidValueError
from threadstate.state.model import Contact
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.fit import Fit
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

DESIGNATIONS = [
    "4-40 UNC-1A/1B at minimum material",
    "1/4-20 UNC-3A/3B",
    "M3",
    "M3 at minimum material",
    "1/4-16 ACME-2G",
    "1/4-16 ACME-2G at minimum material",
    "1/2-10 STUB ACME-2G",
    "Tr 8x1.5-7e/7H at minimum material",
    "1/4-20 BSW",
    "1/4-20 BSW at minimum material",
]
FURTHER = ["1/4-28 UNJF at minimum material", "MJ6", "1/2-16 BUTT", "1/2-16 PUSH-BUTT-3A/3B at minimum material"]
PAIRS = [*map(pair_by_designation, DESIGNATIONS), BUTTRESS, TURNED_BUTTRESS, *map(pair_by_designation, FURTHER)]
SEED = 181
HEIGHTS, TURNS = 6, 1
PARTED = 2e-5
"""Depth, over the thread pitch, from which on a component that is first seen had no onset there."""


def largest_distance(pair: Pair, contact: Contact) -> float:
    """How far a contact is from the surfaces that its features name, in the nut's plane and in the bolt's."""
    found = []
    parts = (contact.point_bolt, bolt_profile(pair)), (contact.point, nut_profile(pair))
    for (point, profile), feature in zip(parts, contact.features.split("-"), strict=True):
        s = point[2] - pair.thread_pitch * math.atan2(point[1], point[0]) / math.tau
        found += [abs(math.hypot(point[0], point[1]) - radius(s, profile))] if feature in ("thread", "edge") else []
        found += [abs(point[2])] if feature != "thread" else []
    return max(found)


@pytest.mark.parametrize("number", range(len(PAIRS)), ids=[pair.designation for pair in PAIRS])
def test_heights_and_turns_are_those_of_the_brute_force(number: int) -> None:
    pair = PAIRS[number]
    pitch = pair.thread_pitch
    poses = random_poses(SEED + number, HEIGHTS, tilt_deg=4.0)
    poses[::2, 2] = poses[::2, 2] % 40.0 - 20.0
    for number, state in enumerate(solve_poses(pair, poses)):
        pose = (state.roll_deg, state.pitch_deg, state.phase_deg)
        height, expected = state.poses[0].translation[2], first_height(pair, *pose).height
        # Samples find no height that is too great, but may step over a narrow pocket: its point proves it.
        assert height >= expected - 1e-9 * pitch, pose
        if height > expected + 1e-9 * pitch:
            assert largest_distance(pair, state.contacts[0]) < 1e-12 * pitch, pose
        for turn in turns_of(pair, state) if number < TURNS else ():
            earlier = earlier_appearance(pair, turn, SolveOptions().turn_limit_deg, steps=10)
            assert earlier is None or earlier.depth > PARTED * pitch, (pose, turn.stage)
            if turn.turn_deg is None or turn.turn_deg < 1e-4 or not within_brute_force(turn):
                continue
            for point in (np.array(contact.point) for contact in turn.found if contact.features.value != "flush"):
                assert begins_at(pair, turn, point, 1e-4, 1e-3), (pose, turn.stage)


@pytest.mark.parametrize(
    ("designation", "pose"),
    [
        ("M3 at minimum material", (-1.6990751824320345, 1.9688071751891254, 342.62488721389104)),
        ("M3 at minimum material", (-0.11847220454691954, 3.869999434186301, 1.3425704230996338)),
        ("M3 at 0/1", (-0.8355486315805702, 3.71380535274044, 350.21966778404607)),
        ("1/4-20 BSW at minimum material", (-1.6990751824320345, 1.9688071751891254, 342.62488721389104)),
        ("1/4-20 UNC at minimum material", (-2.6900667643746567, 3.8934234425368723, 345.83319360644913)),
    ],
)
def test_a_turn_in_which_an_edge_comes_to_lie_along_a_flank_is_decided(
    designation: str, pose: tuple[float, float, float]
) -> None:
    """During the second turn the nut's edge and the bolt's flank agree around the first contact to the third order.

    There round-off alone tells inside from outside, up to a thousandth of a radian from the contact.
    """
    pair = pair_by_designation(designation)
    state = solve_pose(pair, *pose)
    turn = turns_of(pair, state)[0]
    earlier = earlier_appearance(pair, turn, SolveOptions().turn_limit_deg, steps=14)
    # What is deep at once has parted from the overlap around the first contact.
    assert earlier is None or earlier.depth > PARTED * pair.thread_pitch


def test_a_metric_pair_is_an_inch_pair_of_another_size() -> None:
    metric = pair_by_designation("M3")
    by = 1.0 / 25.4
    lengths = {name: value * by for name, value in vars(metric.fit).items() if name != "name"}
    inch = Pair(
        "M3 in inches",
        metric.unit,
        metric.nominal_diameter * by,
        metric.thread_pitch * by,
        metric.form,
        Fit("", **lengths),
    )
    for pose in random_poses(SEED, 12, tilt_deg=4.0):
        here, there = solve_pose(metric, *pose), solve_pose(inch, *pose)
        assert [one.features for one in here.contacts] == [one.features for one in there.contacts]
        assert here.flags == there.flags
        for one, other in zip(here.contacts, there.contacts, strict=True):
            np.testing.assert_allclose(np.array(one.point) * by, other.point, rtol=0.0, atol=1e-9 * inch.thread_pitch)
            np.testing.assert_allclose(one.normal, other.normal, rtol=0.0, atol=1e-7)


def of_fillets(designation: str, radius: float) -> Pair:
    """A pair all of whose fillets have a radius, over the thread pitch."""
    pair = pair_by_designation(designation)
    names = ("bolt_root_fillet", "bolt_crest_fillet", "nut_root_fillet", "nut_crest_fillet")
    return replace(pair, form=replace(pair.form, **dict.fromkeys(names, radius)))  # type: ignore[arg-type]


@pytest.mark.parametrize("designation", ["1/4-16 ACME-2G", "M6", "1/4-20 UNC-1A/1B at minimum material"])
def test_heights_of_sharp_corners_are_those_of_the_brute_force(designation: str) -> None:
    sharp = pair_by_designation(f"{designation} with sharp corners")
    pitch = sharp.thread_pitch
    poses = random_poses(1821, 5, tilt_deg=4.0)
    poses[::2, 2] = poses[::2, 2] % 40.0 - 20.0
    for pose, record in zip(poses.tolist(), solve_records(sharp, SolveOptions(), poses), strict=True):
        assert record[rk.O_STATUS] == 0.0
        assert record[rk.O_POSE + 11] == pytest.approx(first_height(sharp, *pose).height, abs=1e-9 * pitch), pose


@pytest.mark.parametrize("designation", ["1/4-16 ACME-2G at minimum material", "1/4-20 UNC", "Tr 8x1.5-7e/7H"])
def test_states_of_ever_smaller_fillets_become_those_of_sharp_corners(designation: str) -> None:
    """No contact is missed at a ridge as narrow as a corner: another one would be found later, by far more."""
    poses = random_poses(1822, 150, tilt_deg=4.0)
    poses[::2, 2] = poses[::2, 2] % 40.0 - 20.0
    found = [solve_records(of_fillets(designation, radius), SolveOptions(), poses) for radius in (1e-7, 0.0)]
    decided = (found[0][:, rk.O_STATUS] == 0.0) & (found[1][:, rk.O_STATUS] == 0.0)
    assert decided.mean() > 0.97
    near, sharp = (records[decided] for records in found)
    np.testing.assert_array_equal(near[:, rk.O_CONTACTS], sharp[:, rk.O_CONTACTS])
    for column in (rk.O_LAMBDA, rk.O_MU):
        np.testing.assert_allclose(near[:, column], sharp[:, column], rtol=0.0, atol=1e-4)


def test_flanks_too_flat_are_refused() -> None:
    pair = pair_by_designation("1/4-16 ACME-2G")
    flat = replace(pair, form=replace(of_fillets("1/4-16 ACME-2G", 0.0).form, flank_half_angle_deg=6.9))
    with pytest.raises(InvalidValueError, match=r"flank_half_angle_deg is 6\.9; valid: at least 7 deg"):
        solve_pose(flat, 1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("designation", "pose", "mu_deg"),
    [
        ("1/4-16 STUB ACME-2G", (1.4076287827948257, 3.834881868549828, -105.64747773500358), 0.347125994266),
        ("1/4-16 STUB ACME-2G", (-3.303835790379943, 3.831965939614628, -105.44283522125892), 0.244713646734),
        ("1/4-16 ACME-2G", (-2.476317625618872, 2.3989105495521468, -70.8415375385481), 0.000152266781),
    ],
)
def test_threads_that_meet_early_in_a_turn_that_no_edge_ends_are_found(
    designation: str, pose: tuple[float, float, float], mu_deg: float
) -> None:
    """The overlap is 6e-5 in deep a hundredth of a degree later; at instants 1.5 deg apart it was missed altogether.

    One begins so early that a step of Newton's method back to it ends before the turn begins.
    """
    pair = pair_by_designation(f"{designation} at minimum material")
    state = solve_pose(pair, *pose)
    assert state.mu_deg == pytest.approx(mu_deg, abs=1e-9)
    third = [contact.features.value for contact in state.contacts if contact.stage == 3]
    assert third == ["thread-thread"]
    turn = turns_of(pair, state)[1]
    assert begins_at(pair, turn, np.array(turn.found[0].point), 1e-4, 1e-3)


@pytest.mark.parametrize(
    ("designation", "pose"),
    [
        ("1/4-16 ACME-2G with sharp corners", (2.0519332317019057, 1.1946532945972077, -51.09686706890932)),
        ("1/4-16 ACME-2G with sharp corners", (0.23977845224520422, 2.407406132980718, -54.96453360620363)),
        ("Tr 8x1.5-7e/7H with sharp corners", (-1.2100988496689258, 1.752333858483543, -50.38106869414966)),
        ("Tr 8x1.5-7e/7H with sharp corners", (-3.7173620104085936, 1.9222839960679199, -63.235591506409406)),
    ],
)
def test_embedment_at_a_sharp_corner_is_the_least_lift(designation: str, pose: tuple[float, float, float]) -> None:
    """An overlap along the corner's helix is narrow: some of these were 0, and the bolt at rest."""
    pair = pair_by_designation(designation)
    state = solve_pose(pair, *pose)
    last = state.poses[2]
    expected = least_lift(pair, np.array(last.rotation), np.array(last.translation))
    assert expected > 1e-5 * pair.thread_pitch
    assert state.embedment == pytest.approx(expected, abs=2e-7 * pair.thread_pitch)
