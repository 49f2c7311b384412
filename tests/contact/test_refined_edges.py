"""Edges with their motion in sums of two doubles: what they are, and poses that only they decide."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from oracle.first_height import first_height
from tests.contact.edges import new_edge, new_kept, refined_edges, wide_motion
from tests.contact.samples import Floats, PoseDeg
from threadstate.contact import _onset_kernel as onset
from threadstate.contact import _refined_edge_kernel as refined
from threadstate.contact import _stage_kernel as stage
from threadstate.contact import _wedge_kernel as wedges
from threadstate.contact._beside_kernel import keep
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import M_POINT, M_ROUNDED, MOTION_SIZE
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
BOLT, NUT = PAIR.bolt.packed, PAIR.nut.packed
R = PAIR.bolt.major_diameter / 2.0
HEIGHT_TOLERANCE_INCH = 1e-9
EXACT = 1e-30
"""What sums of two doubles of some inches round off."""


def edges(is_turn: bool = True) -> tuple[Edge, Edge]:
    """The edges of both parts in a turn about a point of the bolt's edge, or a way down; neither is refined."""
    pose, bolt_motion, nut_motion = np.zeros(12), np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    stage.rotation(0.02, -0.03, 0.7, pose)
    pose[9:] = 1e-4, -2e-4, 2e-3
    point, axis = np.array([0.8 * R, 0.5 * R, 0.0]), np.array([0.6, -0.8, 0.0])
    down = np.array([0.0, 0.0, -1.0])
    stage.set_motions(pose, is_turn, False, point, axis if is_turn else down, bolt_motion, nut_motion)
    return new_edge(bolt_motion, BOLT, NUT, new_kept(1)), new_edge(nut_motion, NUT, BOLT, new_kept(1))


def refined_pair(is_turn: bool = True) -> tuple[Edge, Edge]:
    """The same edges, refined."""
    bolt_edge, nut_edge = edges(is_turn)
    return refined_edges(bolt_edge, nut_edge, wide_motion(bolt_edge.motion))


def exact(rows: Floats) -> list[Fraction]:
    """Rows of high and low doubles as fractions."""
    return [Fraction(high) + Fraction(low) for high, low in rows.tolist()]


def test_the_motion_is_the_nearest_rotation_and_the_nuts_is_its_inverse() -> None:
    bolt_edge, nut_edge = refined_pair()
    assert bolt_edge.motion[M_ROUNDED] == nut_edge.motion[M_ROUNDED] == 1.0
    ours, back = exact(bolt_edge.wide), exact(nut_edge.wide)
    stored = [*bolt_edge.motion[:12], *bolt_edge.motion[M_POINT : M_POINT + 6]]
    assert max(abs(float(one) - number) for one, number in zip(ours, stored, strict=True)) < 1e-15
    rows = [ours[3 * i : 3 * i + 3] for i in range(3)]
    for i in range(3):
        for j in range(3):
            product = sum(a * b for a, b in zip(rows[i], rows[j], strict=True))
            assert abs(float(product - (i == j))) < EXACT
    assert abs(float(sum(one * one for one in ours[15:18]) - 1)) < EXACT
    origin, point, axis = ours[9:12], ours[12:15], ours[15:18]
    assert away(rows, back[9:12], [-one for one in origin]) < EXACT
    assert away(rows, back[12:15], [a - b for a, b in zip(point, origin, strict=True)]) < EXACT
    assert away(rows, back[15:18], [-one for one in axis]) < EXACT


def away(rows: list[list[Fraction]], vector: list[Fraction], expected: list[Fraction]) -> float:
    """How far a rotated vector is from another one, in one of its components."""
    turned = [sum(a * b for a, b in zip(row, vector, strict=True)) for row in rows]
    return max(abs(float(a - b)) for a, b in zip(turned, expected, strict=True))


@pytest.mark.parametrize("is_turn", [True, False])
def test_jets_are_those_of_doubles_but_for_round_off(is_turn: bool) -> None:
    rng = np.random.default_rng(311)
    jet, refined_jet = np.empty(onset.JET_SIZE), np.empty(onset.JET_SIZE)
    for edge, finer in zip(edges(is_turn), refined_pair(is_turn), strict=True):
        assert refined.is_refined(finer)
        assert not refined.is_refined(edge)
        for theta, tau in rng.uniform((0.0, 0.0), (6.0, 0.1), (40, 2)).tolist():
            onset.set_jet_beside(theta, tau, edge, jet)
            onset.set_jet_beside(theta, tau, finer, refined_jet)
            assert refined_jet == pytest.approx(jet, rel=1e-9, abs=1e-14)
            assert not np.array_equal(refined_jet, jet)


def test_beside_a_contact_g_and_phi_are_differences_from_it() -> None:
    contact, jet = 0.4, np.empty(onset.JET_SIZE)
    finer, _ = refined_pair()
    free = np.empty(onset.JET_SIZE)
    onset.set_jet_beside(contact, 0.05, finer, free)
    keep(contact, True, True, finer.kept)
    for distance in (1e-3, 1e-6, 1e-9, 1e-12):
        onset.set_jet_beside(contact + distance, 0.05, finer, jet)
        way = (contact + distance) - contact
        assert jet[onset.J_PHI] == pytest.approx(way * free[onset.J_PHI_THETA], rel=10.0 * distance + 1e-12)
        assert jet[onset.J_G] == pytest.approx(way * free[onset.J_G_THETA], rel=10.0 * distance + 1e-12)


@pytest.mark.parametrize("is_turn", [True, False])
def test_a_crossing_is_that_of_doubles_but_for_round_off(is_turn: bool) -> None:
    rng = np.random.default_rng(312)
    jet, wedge = np.empty(onset.JET_SIZE), np.empty(9)
    for edge, finer in zip(edges(is_turn), refined_pair(is_turn), strict=True):
        for theta, tau in rng.uniform((0.0, 0.0), (6.0, 0.1), (40, 2)).tolist():
            onset.set_jet_beside(theta, tau, edge, jet)
            found = wedges.crossing_beside(theta, tau, 0.0, 0.0, edge, jet, wedge)
            exact_one = wedges.refined_crossing((theta, 0.0), (tau, 0.0), finer)
            assert exact_one.sine > wedges.LEAST_SINE
            assert tuple(exact_one) == pytest.approx(tuple(found), abs=1e-13 / exact_one.sine)


def test_a_crossing_is_doubtful_where_its_signs_or_its_time_are() -> None:
    """A face direction as near to the plane of both tangents as round-off; a tie shorter than the error of the time."""
    edge, finer = edges()[0], refined_pair()[0]
    theta, tau = 0.3, 0.01
    jet, wedge = np.empty(onset.JET_SIZE), np.empty(9)
    onset.set_jet_beside(theta, tau, edge, jet)
    one = wedges.crossing_beside(theta, tau, 0.0, 0.0, edge, jet, wedge)
    parted = one._replace(curve_1=0.5, curve_2=0.5, solid_1=-0.5, solid_2=-0.5)
    assert wedges.separates(parted, 0.0)
    assert not wedges.is_doubtful(theta, tau, parted, 1e-9, edge, jet, wedge)
    assert wedges.is_doubtful(theta, tau, parted, 0.0, edge, jet, wedge)
    assert wedges.is_doubtful(theta, tau, parted._replace(sine=0.0), 1e-9, edge, jet, wedge)
    turned = wedges.crossing_beside(theta, tau, 1e-9, 0.0, finer, jet, wedge)
    assert tuple(turned) != tuple(one)


@pytest.mark.slow
@pytest.mark.parametrize(
    "pose",
    [
        (0.10434019382280837, 0.0026860074511310863, 21.513048156163816),
        (-0.02895388877756049, 0.3574196117469121, 357.7117883697747),
        (0.05054066502838833, -0.019260628383938924, 357.71368527412494),
        (-0.07156067013024908, -0.07916843071604061, 251.43422606866707),
        (4.0, -4.0, 26.24169921875),
        (-4.564366480721452e-10, 2.097801656884374e-09, 2.1959579326156136),
        (0.5653341877907689, 0.39236941264432434, 2.3251282331231677),
        (0.38108159361209676, -1.4226935217666812, 7.681436594145521),
    ],
    ids=[
        "a first contact beside its double root",
        "a second one",
        "edges that graze",
        "an edge as level as a face",
        "beside the first",
        "a turn of 2e-9 deg onto a strip",
        "a flush first contact",
        "one in doubles that is none",
    ],
)
def test_a_pose_whose_contact_round_off_hides_is_decided(pose: PoseDeg) -> None:
    state = solve_pose(PAIR, *pose)
    assert len(state.contacts) >= 2
    assert state.poses[0].translation[2] == pytest.approx(first_height(PAIR, *pose).height, abs=HEIGHT_TOLERANCE_INCH)
    assert all(math.isfinite(number) for one in state.contacts for number in one.point)
