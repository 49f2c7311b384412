"""Statics against values in closed form (forces, section 6)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.statics import _friction_kernel as fk
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics._support_kernel import distance_by_faces, distance_by_program, patch_margin, support_margin
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

TIPPING, _, TURNING, _, _, LIFT = np.eye(6)
PUSH = -LIFT


def units(rows: list[tuple[float, float, float]]) -> Floats:
    found = np.array(rows)
    return found / np.linalg.norm(found, axis=1)[:, np.newaxis]


def wedge(points: Floats, normals: Floats) -> tuple[int, float, float, Floats, Floats]:
    forces, twist = np.zeros(3 * len(points)), np.zeros(6)
    status, lower, upper = fk.wedge_friction(points, normals, forces, twist)
    return status, lower, upper, forces, twist


def hold(load: Floats, points: Floats, normals: Floats) -> tuple[int, float, float]:
    _, _, upper, wedge_forces, wedge_twist = wedge(points, normals)
    forces, twist = np.zeros(3 * len(points)), np.zeros(6)
    found: tuple[int, float, float] = fk.hold_friction(
        load, points, normals, upper, wedge_forces, wedge_twist, forces, twist
    )
    return found


def round_about(tilt: float, radius: float = 1.0, lead: float = 0.0) -> tuple[Floats, Floats]:
    """Three contacts about the z axis whose normals lean inwards by ``tilt``, back along the circle by ``lead``."""
    azimuths = np.radians([0.0, 120.0, 240.0])
    outwards = np.column_stack([np.cos(azimuths), np.sin(azimuths), np.zeros(3)])
    along = np.column_stack([-np.sin(azimuths), np.cos(azimuths), np.zeros(3)])
    normals = -math.sin(tilt) * outwards + math.cos(tilt) * (
        math.cos(lead) * np.array([0.0, 0.0, 1.0]) - math.sin(lead) * along
    )
    return radius * outwards, normals


def test_one_contact_balances_lines_through_it_alone_and_never_wedges() -> None:
    points, normals = np.array([[0.3, -0.2, 0.1]]), units([(0.2, 0.1, 1.0)])
    force = np.array([-0.1, 0.3, -1.0])
    load = np.array([*np.cross(points[0], force), *force])
    angle = math.acos(float(-force @ normals[0]) / float(np.linalg.norm(force)))
    status, lower, upper = hold(load, points, normals)
    assert (status, lower) == (fk.FOUND, upper)
    assert upper == pytest.approx(math.tan(angle), abs=1e-12)
    assert hold(load + 1e-6 * TIPPING, points, normals)[0] == fk.NEVER
    assert hold(-load, points, normals)[0] == fk.NEVER
    assert wedge(points, normals)[0] == fk.NEVER


def test_two_opposed_contacts_wedge_without_friction() -> None:
    points, normals = np.array([[-1.0, 0.2, 0.3], [1.0, 0.2, 0.3]]), units([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)])
    assert wedge(points, normals)[:3] == (fk.FOUND, 0.0, 0.0)


@pytest.mark.parametrize("angles_deg", [(10.0, 35.0), (40.0, 5.0), (30.0, 30.0)])
def test_two_contacts_wedge_where_the_line_between_them_lies_in_both_cones(angles_deg: tuple[float, float]) -> None:
    first, second = np.radians(angles_deg)
    points = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    normals = units([(math.cos(first), 0.0, math.sin(first)), (-math.cos(second), math.sin(second), 0.0)])
    _, lower, upper, _, _ = wedge(points, normals)
    assert lower == pytest.approx(math.tan(max(first, second)), abs=1e-12)
    assert upper == pytest.approx(math.tan(max(first, second)), abs=1e-12)


def test_peg_in_a_hole_on_two_points() -> None:
    """The peg's edge touches the hole, the hole's edge the peg; in exact geometry, with the rim's normal tilted."""
    peg, hole = 10.0, 10.4
    for tilt_deg in (2.0, 3.0, 4.0, 6.0):
        tilt = math.radians(tilt_deg)
        # In the plane of the tilt: the peg's axis leans, its low corner touches the wall x = -D/2, and the rim at
        # (D/2, 0) touches the peg's side; the corners are a diameter and a depth of the peg apart.
        side = np.array([math.cos(tilt), 0.0, -math.sin(tilt)])
        axis = np.array([math.sin(tilt), 0.0, math.cos(tilt)])
        depth = (hole - peg * math.cos(tilt)) / math.sin(tilt)
        corner = np.array([-hole / 2.0, 0.0, 0.0])
        rim = corner + peg * side + depth * axis
        assert rim[0] == pytest.approx(hole / 2.0, abs=1e-9)
        points = np.array([corner, rim]) / 5.0
        normals = np.array([[1.0, 0.0, 0.0], -side])
        expected = max(
            abs(rim[2] - corner[2]) / hole,
            depth / peg,
        )
        _, lower, upper, _, _ = wedge(points, normals)
        assert lower == pytest.approx(expected, abs=1e-9)
        assert upper == pytest.approx(expected, abs=1e-9)
        assert depth / peg == pytest.approx((hole / peg - math.cos(tilt)) / math.sin(tilt), abs=1e-12)


def test_three_contacts_on_a_plane_carry_every_push_within_their_triangle() -> None:
    points = np.array([[1.0, 0.0, 0.0], [-0.5, 0.9, 0.0], [-0.6, -0.7, 0.0]])
    normals = np.tile([0.0, 0.0, 1.0], (3, 1))
    rays = np.hstack([np.cross(points, normals), normals])
    rng = np.random.default_rng(4)
    for x, y in rng.uniform(-1.2, 1.2, (60, 2)):
        load = np.array([-y, x, 0.0, 0.0, 0.0, -1.0])
        unit = load / np.linalg.norm(load)
        shares = np.linalg.solve(np.vstack([points[:, :2].T, np.ones(3)]), [x, y, 1.0])
        if shares.min() > 0.0:
            sides = []
            for i in range(3):
                a, b = np.delete(points, i, axis=0)[:, :2]
                edge = np.cross([a[1], -a[0], 1.0], [b[1], -b[0], 1.0])
                sides.append(abs(edge @ [y, -x, 1.0]) / np.linalg.norm(edge) / np.linalg.norm(load))
            assert support_margin(load, points, normals) == pytest.approx(min(sides), abs=1e-9)
            assert patch_margin(load, points[:, :2]) == pytest.approx(min(sides), abs=1e-9)
            assert hold(load, points, normals)[1:] == (0.0, 0.0)
        else:
            distance = distance_by_faces(unit, rays)
            assert distance == pytest.approx(distance_by_program(unit, rays), abs=1e-8)
            assert support_margin(load, points, normals) == pytest.approx(-distance, abs=1e-14)
            assert patch_margin(load, points[:, :2]) == pytest.approx(-distance, abs=1e-12)
            assert hold(load, points, normals)[0] == fk.NEVER
    assert wedge(points, normals)[0] == fk.NEVER


@pytest.mark.parametrize("tilt_deg", [10.0, 30.0, 55.0])
def test_three_contacts_round_about_wedge_at_the_cotangent_of_their_tilt(tilt_deg: float) -> None:
    points, normals = round_about(math.radians(tilt_deg))
    _, lower, upper, _, _ = wedge(points, normals)
    assert lower == pytest.approx(1.0 / math.tan(math.radians(tilt_deg)), abs=1e-9)
    assert upper == pytest.approx(1.0 / math.tan(math.radians(tilt_deg)), abs=1e-9)


@pytest.mark.parametrize("torque", [0.0, 0.05, -0.2, 0.6])
def test_three_contacts_round_about_hold_a_push_and_a_torque(torque: float) -> None:
    tilt, radius = math.radians(25.0), 0.8
    points, normals = round_about(tilt, radius)
    across, down = torque / (3.0 * radius), 1.0 / 3.0
    expected = math.tan(math.asin(math.cos(tilt) * abs(across) / math.hypot(across, down)))
    _, lower, upper = hold(PUSH + torque * TURNING, points, normals)
    assert lower == pytest.approx(expected, abs=1e-9)
    assert upper == pytest.approx(expected, abs=1e-9)


def test_a_screw_locks_from_the_lead_times_the_cosine_of_the_half_angle_on() -> None:
    pair = quarter_twenty_unc()
    radius = pair.bolt.pitch_diameter / 2.0
    slope = 1.0 / math.tan(math.radians(pair.form.flank_half_angle_deg))
    climb = pair.thread_pitch / (2.0 * math.pi)
    azimuths = np.radians([0.0, 120.0, 240.0])
    points = np.column_stack([radius * np.cos(azimuths), radius * np.sin(azimuths), climb * azimuths])
    outwards = np.column_stack([np.cos(azimuths), np.sin(azimuths), np.zeros(3)])
    along = np.column_stack([-np.sin(azimuths), np.cos(azimuths), np.zeros(3)])
    normals = units((-outwards - climb / radius * slope * along + [0.0, 0.0, slope]).tolist())
    lead = math.atan(climb / radius)
    assert math.degrees(lead) == pytest.approx(4.206, abs=1e-3)
    half_angle = math.radians(pair.form.flank_half_angle_deg)
    # A bolt that turns slides along the helix: what counts there is the half-angle across it.
    across = math.atan(math.tan(half_angle) * math.cos(lead))
    # In one plane, so that the push is shared alike.
    level = points * [1.0, 1.0, 0.0]
    _, lower, upper = hold(PUSH, level / radius, normals)
    assert lower == pytest.approx(math.tan(lead) * math.cos(half_angle), abs=1e-9)
    assert upper == pytest.approx(math.tan(lead) * math.cos(half_angle), abs=1e-9)
    for mu in (0.0, 0.02, 0.0634, 0.15, 0.4):
        up = turn_effort(1.0, 0.0, points / radius, normals, mu, 1.0)
        down = turn_effort(1.0, 0.0, points / radius, normals, mu, -1.0)
        assert up == pytest.approx(math.tan(math.atan(mu / math.cos(across)) + lead), abs=1e-12)
        assert down == pytest.approx(math.tan(math.atan(mu / math.cos(across)) - lead), abs=1e-12)


def test_efforts_that_no_torque_or_every_torque_reaches() -> None:
    up = units([(0.0, 0.0, 1.0)])
    blocked = units([(0.0, 0.0, 1.0), (0.0, -1.0, 0.0)])
    assert turn_effort(1.0, 0.0, np.array([[1.0, 0.0, 0.0]]), up, 0.3, 1.0) == pytest.approx(0.3)
    assert turn_effort(1.0, 0.0, np.array([[1.0, 0.0, 0.0]] * 2), blocked, 0.3, 1.0) == math.inf
    assert math.isnan(turn_effort(1.0, 0.0, np.array([[1.0, 0.0, 0.0]]), units([(1.0, 0.0, 0.0)]), 0.3, 1.0))
    steep = units([(0.0, -1.0, 0.2)])
    assert turn_effort(1.0, 0.0, np.array([[1.0, 0.0, 0.0]]), steep, 0.3, 1.0) == math.inf
