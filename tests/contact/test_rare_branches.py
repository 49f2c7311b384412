"""Branches of kernels that no known pose takes, or next to none, each entered by a case made for it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle import lift as oracle_lift
from oracle.contact_rules import Touch, frame_gap, normal_faults, region_faults, surface_gaps
from oracle.first_height import first_height
from oracle.profile import bolt_profile, nut_profile, radius
from tests.contact.edges import new_edge, new_kept
from tests.contact.samples import Floats, PoseDeg
from threadstate.contact import _edge_search_kernel as edge_search
from threadstate.contact import _entry_kernel as entry
from threadstate.contact import _flush_kernel as flush
from threadstate.contact import _lift_kernel as lift
from threadstate.contact import _onset_kernel as onset
from threadstate.contact import _record_kernel as record
from threadstate.contact import _ridge_kernel as ridge
from threadstate.contact import _solve_kernel as solve
from threadstate.contact import _stage_kernel as stage
from threadstate.contact import _tangency_kernel as tangency
from threadstate.contact import _wedge_kernel as wedges
from threadstate.contact._bound_kernel import B_LIPSCHITZ, B_SECOND_DERIVATIVE, BOUNDS_SIZE
from threadstate.contact._box_kernel import ONE_EDGE, ONE_PLANE, ONE_THREAD
from threadstate.contact._edge_kernel import Box
from threadstate.contact._geometry_kernel import MOTION_SIZE, PATH_SIZE
from threadstate.errors import UnresolvedPoseError
from threadstate.state.decode import decoded_states
from threadstate.state.model import FeaturePair
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair
from threadstate.thread.regions import Region

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
SHARP = pair_by_designation("1/4-16 ACME-2G with sharp corners")
NO_CLEARANCE = pair_by_designation("1/4-28 UNJF-3A/3B")
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed
P = PAIR.thread_pitch
TIE_INCH = 2e-11 * P
HEIGHT_TOLERANCE_INCH = 1e-9
LIFT_TOLERANCE_INCH = 1e-10
SURFACE_TOLERANCE_INCH = 1e-12
DOWN = np.array([0.0, 0.0, -1.0])


def pose_at(pose_deg: PoseDeg, height: float) -> Floats:
    """A pose of twelve numbers: rotation by rows, translation."""
    pose = np.zeros(12)
    stage.rotation(*(math.radians(angle) for angle in pose_deg), pose)
    pose[11] = height
    return pose


def descents(pose: Floats) -> tuple[Floats, Floats]:
    """The motions of the bolt's edge and of the nut's, straight down."""
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    stage.set_motions(pose, False, False, DOWN, DOWN, bolt_motion, nut_motion)
    return bolt_motion, nut_motion


def least_lift(pose: Floats) -> float:
    found = np.empty((stage.MAX_CONTACTS, stage.CONTACT_SIZE))
    length, status = lift.least_lift(pose, TIE_INCH, BOLT, NUT, stage.new_work(), found)
    assert status == stage.RESOLVED
    return float(length)


def solved(pose: PoseDeg, pair: Pair = PAIR) -> Floats:
    """The record of a pose, decided or not."""
    options, rows = np.zeros(solve.OPTIONS_SIZE), np.empty((1, record.RECORD_SIZE))
    tie = 2e-11 * pair.thread_pitch
    options[solve.S_TURN_LIMIT], options[solve.S_TIE], options[solve.S_CONVEX] = math.radians(45.0), tie, 1.0
    solve.solve_rows(np.radians([pose]), options, pair.bolt.packed, pair.nut.packed, solve.NONE_BESIDE, rows)
    return rows[0]


# --- Undecided poses


@pytest.mark.parametrize(
    ("pair", "pose", "poses"),
    [
        (SHARP, (7.122851332087587e-08, -3.768292630537729e-06, 1.5981335955963853), 0),
        (PAIR, (0.1790897872180624, 0.2289943449118028, 2.2930289846362895), 2),
        (SHARP, (-1.848321590093091e-09, 2.75804603556617e-06, -0.2093575674421757), 2),
    ],
)
def test_a_pose_whose_search_does_not_end_is_an_error_and_never_a_guess(pair: Pair, pose: PoseDeg, poses: int) -> None:
    """Of the first and of the third stage: ``poses`` of the three were found."""
    row = solved(pose, pair)
    assert (row[record.O_STATUS], row[record.O_POSES]) == (stage.UNRESOLVED, poses)
    with pytest.raises(UnresolvedPoseError, match="before every box was excluded"):
        solve_pose(pair, *pose)


def test_an_embedment_beside_edges_that_touch_along_an_arc_is_decided() -> None:
    """Of the arc no box is outside altogether; none is deeper than what the witness of an overlap has to be."""
    roll, pitch, phase = 1.0485832972802616, -1.9987059987023654, 4.943892773021979
    states = [solve_pose(NO_CLEARANCE, roll + offset, pitch, phase) for offset in (0.0, 1e-7)]
    first, beside = (state.embedment for state in states)
    assert first == pytest.approx(1.6305062e-3, abs=1e-10)
    assert beside == pytest.approx(first, abs=1e-9)
    assert [contact.features for contact in states[0].contacts] == [contact.features for contact in states[1].contacts]


@pytest.mark.parametrize(
    "pose",
    [
        (0.0009377165331601753, 0.002716068435739592, 1.1404050124514917),
        (2.903245030657479e-05, 6.360621194900974e-05, 0.19721446962774447),
        (1e-4, 5e-5, 0.0),
        (1.8398712734907334e-05, 0.00012444704985027888, 2.243004327857509),
    ],
)
def test_nearly_level_poses_whose_flanks_nearly_touch_as_a_whole_are_decided(pose: PoseDeg) -> None:
    state = solve_pose(PAIR, *pose)
    assert len(state.contacts) >= 3
    assert state.poses[0].translation[2] == pytest.approx(first_height(PAIR, *pose).height, abs=HEIGHT_TOLERANCE_INCH)


@pytest.mark.parametrize(
    "pose",
    [
        (1.023796249705424e-05, 7.699761540388403e-06, -2.2279607260969834),
        (1.701912697471972e-07, -1.9863046067914774e-07, -0.5992586643435125),
        (1.1447914971497242e-07, -1.302846134923598e-07, -0.17413760054958516),
    ],
)
def test_nearly_level_edges_in_narrow_boxes_without_a_peak_have_the_first_height(pose: PoseDeg) -> None:
    """There the curve touches to round-off, and its peak is outside of the box or never rises above the surface."""
    height = solved(pose)[record.O_POSE + 11]
    assert height == pytest.approx(first_height(PAIR, *pose).height, abs=HEIGHT_TOLERANCE_INCH)


# --- Boxes


@pytest.mark.parametrize(
    ("height", "shallow", "outcome"),
    [
        (1e-9, 1e-12, edge_search.OUTSIDE),
        (-1e-9, 1e-12, edge_search.INSIDE),
        (0.0, 1e-12, edge_search.OUTSIDE),
        (0.0, 0.0, edge_search.UNDECIDED),
    ],
)
def test_an_edge_that_lies_in_the_other_plane_is_nowhere_inside_by_more_than_is_allowed(
    height: float, shallow: float, outcome: int
) -> None:
    """Level on the surface every box of the edge over the nut's flat touches: with nothing allowed no list is long
    enough."""
    motion, _ = descents(pose_at((0.0, 0.0, 90.0), height))
    work = stage.new_work()
    found, _ = edge_search.find_inside(new_edge(motion, BOLT, NUT, new_kept(0)), shallow, 1e-11, work.boxes, work.queue)
    assert found == outcome


def test_an_edge_that_lies_in_the_other_plane_is_no_witness() -> None:
    outcome, until = lift.find_witness(pose_at((0.0, 0.0, 90.0), 0.0), 0.0, 1.0, BOLT, NUT, stage.new_work())
    assert (outcome, until) == (edge_search.OUTSIDE, 0.0)


# --- Onsets


def test_a_level_edge_has_no_onset_of_its_own_with_the_plane() -> None:
    """g has no slope along the edge: the Jacobian of g = g_theta = 0 is singular."""
    motion, _ = descents(pose_at((0.0, 0.0, 90.0), 1e-3))
    edge = new_edge(motion, BOLT, NUT, new_kept(0))
    place, _, _ = onset.newton_onset(ONE_PLANE, Box(1.0, 0.1, 0.0, 2e-3), edge, np.empty(onset.JET_SIZE))
    assert place == onset.NO_ROOT


def test_edges_that_run_along_each_other_are_not_separated() -> None:
    """Level and in phase, both edges are circles at their crests: their tangents define no plane there."""
    level, _ = descents(pose_at((0.0, 0.0, 0.0), 0.0))
    crest = math.radians(-90.0)
    assert PAIR.bolt.derivatives(P / 4.0)[1] == 0.0 == PAIR.nut.derivatives(P / 4.0)[1]
    crossing = wedges.crossing_at(crest, crest, 0.0, new_edge(level, BOLT, NUT, new_kept(0)), np.empty(9))
    assert not wedges.separates(crossing, 1e-12)


def test_edges_are_separated_where_they_first_touch() -> None:
    pose_deg = (-4.0, 0.0, 8.4)
    state = solve_pose(PAIR, *pose_deg)
    first = state.contacts[0]
    assert first.features is FeaturePair.EDGE_EDGE
    motion, _ = descents(pose_at(pose_deg, state.poses[0].translation[2]))
    on_bolt, on_nut = (math.atan2(point[1], point[0]) for point in (first.point_bolt, first.point))
    crossing = wedges.crossing_at(on_bolt, on_nut, 0.0, new_edge(motion, BOLT, NUT, new_kept(0)), np.empty(9))
    assert wedges.separates(crossing, 1e-12)


def test_an_onset_beyond_the_far_end_of_a_part_is_no_contact() -> None:
    """A thread is the same one pitch further down, where the part has ended."""
    state = solve_pose(PAIR, -4.0, 0.0, 8.0)
    first = state.contacts[0]
    assert first.features is FeaturePair.THREAD_EDGE
    pose = pose_at((-4.0, 0.0, 8.0), state.poses[0].translation[2])
    _, motion = descents(pose)
    theta = math.atan2(first.point[1], first.point[0])
    edge, jet, wedge = new_edge(motion, NUT, BOLT, new_kept(0)), np.empty(onset.JET_SIZE), np.empty(9)
    onset.set_jet_beside(theta, 0.0, edge, jet)
    assert 0.0 < jet[onset.J_Z] < P
    crossing = wedges.crossing_of(ONE_THREAD, theta, 0.0, edge, jet, wedge)
    assert wedges.is_contact(ONE_THREAD, theta, 0.0, crossing, edge, jet, wedge)
    jet[onset.J_Z] += P
    assert not wedges.is_contact(ONE_THREAD, theta, 0.0, crossing, edge, jet, wedge)


def test_a_full_list_of_candidates_drops_the_latest() -> None:
    found = np.full((onset.MAX_CANDIDATES, onset.CANDIDATE_SIZE), math.nan)
    times = np.random.default_rng(83).permutation(onset.MAX_CANDIDATES + 5).astype(float).tolist()
    count = 0
    for i, time in enumerate(times):
        x, y = 0.12 * math.cos(0.3 * i), 0.12 * math.sin(0.3 * i)
        one = onset.Candidate(time, int(ONE_EDGE), 0.3 * i, 0.3 * i, x, y, 0.0)
        count = onset.insert_candidate(one, count, found)
    assert count == onset.MAX_CANDIDATES
    assert found[:, onset.C_TIME].tolist() == sorted(times)[: onset.MAX_CANDIDATES]


def test_a_point_on_the_axis_of_a_turn_never_enters() -> None:
    path = np.zeros(PATH_SIZE)
    path[0], path[2] = 0.09, -0.01
    assert entry.entry_time(path, True, NUT, 1.0, 0.0, 1.0, 2.0, math.inf, 0.08) == (entry.NEVER, entry.NO_ENTRY)


# --- Thread on thread


def test_a_full_list_of_tangencies_drops_the_latest() -> None:
    pose_deg = (2.0, 1.0, 355.0)
    state = solve_pose(PAIR, *pose_deg)
    first, above = state.contacts[0], 1e-4
    assert first.features is FeaturePair.THREAD_THREAD
    motion, _ = descents(pose_at(pose_deg, state.poses[0].translation[2] + above))
    theta, z = math.atan2(first.point_bolt[1], first.point_bolt[0]), first.point_bolt[2]
    placement, jet = np.empty(tangency.PLACEMENT_SIZE), np.empty(tangency.TANGENCY_JET_SIZE)
    for listed_times, is_listed in ((1.0, True), (0.0, False)):
        found = np.zeros((tangency.MAX_TANGENCIES, tangency.TANGENCY_SIZE))
        found[:, tangency.T_TIME] = listed_times
        count = tangency.newton_tangency(
            theta, z, 0.0, 1e-3, motion, BOLT, NUT, placement, jet, found, tangency.MAX_TANGENCIES
        )
        assert count == tangency.MAX_TANGENCIES
        assert (found[0, tangency.T_TIME] == pytest.approx(above, abs=1e-12)) == is_listed
        assert (found[1:, tangency.T_TIME] == listed_times).all()


@pytest.mark.parametrize("pose_deg", [(2.0, 1.0, 354.0), (2.0, 1.0, 355.0)])
@pytest.mark.parametrize("lowered", [1e-7, 1e-6, 1e-5])
def test_threads_that_overlap_below_all_edges_are_freed_by_as_much_as_the_bolt_was_lowered(
    pose_deg: PoseDeg, lowered: float
) -> None:
    """Thread meets thread first there: a little below no edge is inside, and the witness is a point of the thread."""
    first = first_height(PAIR, *pose_deg)
    pose = pose_at(pose_deg, first.height - lowered)
    overlaps = ridge.deepest_thread_point(descents(pose)[0], 1e-12 * P, stage.RIDGE_AZIMUTHS, BOLT, NUT)[0]
    assert overlaps
    assert pose[11] > max(first.by_feature[:2]) or lowered == 1e-5
    outcome, until = lift.find_witness(pose, 0.0, 1.0, BOLT, NUT, stage.new_work())
    assert outcome == edge_search.INSIDE
    assert 0.0 < until <= lowered + LIFT_TOLERANCE_INCH
    assert least_lift(pose) == pytest.approx(lowered, abs=LIFT_TOLERANCE_INCH)
    above = pose_at(pose_deg, first.height + lowered)
    assert lift.find_witness(above, 0.0, 1.0, BOLT, NUT, stage.new_work())[0] == edge_search.OUTSIDE


# --- Lifts


def test_a_bolt_above_the_nut_needs_no_lift() -> None:
    assert least_lift(pose_at((2.0, 1.0, 30.0), 0.1)) == 0.0


@pytest.mark.parametrize("sunk", [-2e-4, 0.0, 2e-4])
def test_a_bolt_within_the_play_of_the_threads_needs_no_lift(sunk: float) -> None:
    """A quarter of a pitch deep it is free between the nut's flanks, though further up it would meet them again."""
    pose = pose_at((0.01, 0.02, -90.0), -0.25 * P - sunk)
    assert oracle_lift.least_lift(PAIR, pose[:9].reshape(3, 3), pose[9:]) == 0.0
    assert oracle_lift.least_lift(PAIR, pose[:9].reshape(3, 3), pose[9:] - 1e-3 * DOWN) > 0.0
    assert least_lift(pose) == 0.0


def test_a_witness_is_followed_for_a_limited_number_of_steps() -> None:
    """Bounds that allow steps of a fixed length: so many of them, and no farther."""
    path, bounds = np.zeros(PATH_SIZE), np.zeros(BOUNDS_SIZE)
    path[0], path[2], path[8], path[9] = 0.14, -0.01, 1.0, 1.0
    depth = 0.14 - PAIR.nut.major_diameter / 2.0
    step = lift.LEAST_GAP * P
    bounds[B_LIPSCHITZ], bounds[B_SECOND_DERIVATIVE] = depth / step, math.inf
    reached = lift.inside_until(path, 0.0, 0.005, 1.0, NUT, 1.0, bounds)
    assert 0.5 * lift.MAX_WITNESS_STEPS * step < reached < 0.005


# --- Patches and contacts that next to no pose has


def test_a_level_bolt_within_the_nut_s_outline_has_no_patch() -> None:
    bolt, nut = bolt_profile(PAIR), nut_profile(PAIR)
    azimuths = np.linspace(0.0, 2.0 * math.pi, 720).tolist()
    assert all(radius(-P * a / (2 * math.pi), bolt) < radius(-P * a / (2 * math.pi), nut) for a in azimuths)
    pose, row = pose_at((0.0, 0.0, 0.0), 0.0), np.zeros(record.RECORD_SIZE)
    extremes = np.empty((4, flush.EXTREME_SIZE))
    assert flush.extreme_points(pose, BOLT, NUT, 1.0, 0.0, extremes) == 0
    assert not solve.append_flush_pose(2, pose, np.zeros(3), np.array([1.0, 0.0, 0.0]), 0.0, BOLT, NUT, extremes, row)
    assert not row.any()


def base_on_edge(inward: float) -> tuple[Floats, Floats]:
    """A pose in which the base rests on a point of the nut's edge, ``inward`` from its outline, and that contact."""
    azimuth = 2.0
    r = radius(-P * azimuth / (2 * math.pi), nut_profile(PAIR))
    point = np.array([r * math.cos(azimuth), r * math.sin(azimuth), 0.0])
    on_bolt = 1.0
    r_bolt = radius(-P * on_bolt / (2 * math.pi), bolt_profile(PAIR)) - inward
    pose = pose_at((1.0, -2.0, 50.0), 0.0)
    pose[9:] = point - pose[:9].reshape(3, 3) @ (r_bolt * math.cos(on_bolt), r_bolt * math.sin(on_bolt), 0.0)
    return pose, np.array([0.0, stage.BASE_EDGE, on_bolt, azimuth, *point])


def test_a_contact_of_the_base_on_the_nut_s_edge_is_recorded_by_the_rules() -> None:
    """No known pose of this thread has one."""
    pose, contact = base_on_edge(0.01)
    row = np.zeros((1, record.RECORD_SIZE))
    row[0, [record.O_LAMBDA, record.O_MU, record.O_DROP, record.O_EMBEDMENT, record.O_PIVOT]] = math.nan
    record.append_pose(pose, row[0])
    record.append_contact(1, contact, pose, BOLT, NUT, row[0])
    (state,) = decoded_states(PAIR, SolveOptions(), np.array([[1.0, -2.0, 50.0]]), row)
    touch = Touch.of(PAIR, state.contacts[0], state.poses[0])
    assert state.contacts[0].features is FeaturePair.BASE_EDGE
    assert state.contacts[0].bolt_region is Region.BASE
    assert state.contacts[0].bolt_margin == pytest.approx(0.01, abs=1e-12)
    assert frame_gap(touch) < SURFACE_TOLERANCE_INCH
    assert max(surface_gaps(touch).values()) < SURFACE_TOLERANCE_INCH
    assert normal_faults(touch) == []
    assert region_faults(touch, SURFACE_TOLERANCE_INCH) == []


@pytest.mark.parametrize("name", ["M6x1-6h/6H", "1/4-20 UNC-3A/3B", "1/4-20 BSW-close/normal"])
def test_corners_of_a_patch_are_on_both_outlines_where_these_cross_at_samples(name: str) -> None:
    """Where pitch diameters are the same the outlines of a level bolt cross at phases of whole samples, too."""
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    pose, extremes = np.zeros(12), np.empty((4, flush.EXTREME_SIZE))
    corners = 0
    for phase in np.arange(0.0, 360.0, 5.625).tolist():
        stage.rotation(0.0, 0.0, math.radians(phase), pose)
        for theta, corner, _, _ in extremes[: flush.extreme_points(pose, bolt, nut, 1.0, 0.0, extremes)].tolist():
            outside = flush.distance_outside(theta, pose, bolt, nut)
            assert outside > -1e-12
            assert corner == 0.0 or outside < 1e-12
            corners += int(corner)
    assert corners > 20


def kept_lists(contact: Floats, pose: Floats) -> tuple[Floats, Floats]:
    """What is kept of a contact on the bolt's edge and on the nut's as the bolt goes down."""
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    stage.set_vertical_motions(pose, -1.0, bolt_motion, nut_motion)
    edges = new_edge(bolt_motion, BOLT, NUT, new_kept(1)), new_edge(nut_motion, NUT, BOLT, new_kept(1))
    stage.keep_contacts(contact[None, :], 1, pose, *edges)
    return edges[0].kept, edges[1].kept


@pytest.mark.parametrize(("inward", "counted"), [(1e-3, 0), (1e-9, 1)])
def test_a_contact_of_the_base_counts_as_one_of_the_bolt_s_edge_beside_it(inward: float, counted: int) -> None:
    pose, contact = base_on_edge(inward)
    on_bolt, on_nut = kept_lists(contact, pose)
    assert (on_bolt[0, 0], on_nut[0, 0]) == (counted, 1)
    assert on_nut[1, :3].tolist() == [contact[stage.K_NUT_AZIMUTH], 1.0, 0.0]


@pytest.mark.parametrize(("outward", "counted"), [(1e-3, 0), (1e-9, 1)])
def test_a_contact_with_the_surface_counts_as_one_of_the_nut_s_edge_beside_it(outward: float, counted: int) -> None:
    azimuth = 2.0
    r = radius(-P * azimuth / (2 * math.pi), nut_profile(PAIR)) + outward
    contact = np.array([0.0, stage.EDGE_SURFACE, 1.0, azimuth, r * math.cos(azimuth), r * math.sin(azimuth), 0.0])
    on_bolt, on_nut = kept_lists(contact, pose_at((1.0, -2.0, 50.0), 0.0))
    assert (on_bolt[0, 0], on_nut[0, 0]) == (1, counted)
    assert on_bolt[1, :3].tolist() == [contact[stage.K_BOLT_AZIMUTH], 1.0, 0.0]
