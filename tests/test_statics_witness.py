"""The witness for the statics of contacts against closed forms (docs/forces.md, section 6) and against itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.pose import turn_about
from oracle.statics.certificates import forces_bound, imbalance, norms, twist_bound
from oracle.statics.friction import (
    FrictionBounds,
    hold_friction,
    hold_friction_by_pyramids,
    wedge_friction,
    wedge_friction_by_pyramids,
)
from oracle.statics.loads import least_largest_normal_forces, normal_force_range, reaction, support_margin
from oracle.statics.wrenches import Contacts, Floats, Twist, Wrench

FRICTION_TOLERANCE = 1e-8
"""Width of a certified interval of friction."""
ROUND_OFF = 1e-12
"""Of numbers that linear algebra gives."""

PUSH = Wrench.of((0.0, 0.0, -1.0))
UP = np.array([0.0, 0.0, 1.0])
RADIUS = 3.0


def push_through(x: float, y: float) -> Wrench:
    return Wrench.of((0.0, 0.0, -1.0), point=(x, y, 0.0))


def three_around(radial: float, around: float, axial: float = 1.0) -> tuple[Floats, Floats]:
    """Three contacts on a circle of ``RADIUS``, with normals in these proportions."""
    azimuths = np.radians([10.0, 130.0, 250.0])
    out = np.column_stack([np.cos(azimuths), np.sin(azimuths), np.zeros(3)])
    along = np.cross(UP, out)
    normals = radial * out + around * along + axial * UP
    return RADIUS * out, normals / norms(normals)[:, None]


def scattered(seed: int, count: int) -> tuple[Floats, Floats]:
    """Contacts about a bolt, most of them pushing upwards."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(count, 3)) * [3.0, 3.0, 1.0]
    normals = rng.normal(size=(count, 3)) + UP
    return points, normals / norms(normals)[:, None]


def assert_certified(bounds: FrictionBounds, expected: float, tolerance: float = FRICTION_TOLERANCE) -> None:
    assert bounds.upper is not None
    assert bounds.lower <= bounds.upper
    assert bounds.upper - bounds.lower <= tolerance * (1.0 + expected)
    assert bounds.lower - ROUND_OFF <= expected <= bounds.upper + ROUND_OFF


def assert_never(bounds: FrictionBounds) -> None:
    assert bounds.lower == math.inf
    assert bounds.upper is None
    assert bounds.exclusions


def peg(tilt_deg: float, peg_diameter: float = 10.0, hole_diameter: float = 10.4) -> tuple[Floats, Floats]:
    """A tilted peg's two-point contact: its tip on the hole's wall, the hole's rim on its side; mm."""
    a = math.radians(tilt_deg)
    length = (hole_diameter - peg_diameter * math.cos(a)) / math.sin(a)
    tip = np.array([-0.5 * hole_diameter, 0.0, 0.0])
    across, along = np.array([math.cos(a), 0.0, -math.sin(a)]), np.array([math.sin(a), 0.0, math.cos(a)])
    rim = tip + peg_diameter * across + length * along
    assert abs(rim[0] - 0.5 * hole_diameter) < ROUND_OFF * hole_diameter
    return np.array([tip, rim]), np.array([[1.0, 0.0, 0.0], -across])


@pytest.mark.parametrize("tilt_deg", [2.0, 3.0, 4.0, 6.0, 11.0, 20.0])
def test_peg_wedges_where_the_line_between_its_contacts_lies_in_both_cones(tilt_deg: float) -> None:
    points, normals = peg(tilt_deg)
    line = (points[1] - points[0]) / np.linalg.norm(points[1] - points[0])
    angles = [math.acos(float(line @ normals[0])), math.acos(-float(line @ normals[1]))]
    bounds = wedge_friction(points, normals, 5.0)
    assert_certified(bounds, math.tan(max(angles)))
    a = math.radians(tilt_deg)
    assert_certified(bounds, (1.04 - math.cos(a)) / math.sin(a))


@pytest.mark.parametrize("friction", [0.3, 0.8])
def test_peg_of_small_angles_wedges_below_the_depth_of_friction_times_diameter(friction: float) -> None:
    # Whitney takes both normals across the hole and the diameter as the distance across: l / d = c / theta.
    clearance = 0.4 / 10.4
    depth = 10.0 * clearance / (clearance / friction)
    points, normals = np.array([[-5.0, 0.0, -depth], [5.0, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    assert_certified(wedge_friction(points, normals, 5.0), friction)


@pytest.mark.parametrize("side", [-1.0, 0.0, 0.5, 2.0])
def test_peg_holds_a_push_on_the_jamming_line(side: float) -> None:
    # Whitney's line of two contacts, M / (r F) = lambda + mu (1 + lambda) Fx / F about the tip's centre, with his signs
    # turned to the load's on the bolt; depth 5, d = 10, mu = 0.3: lambda = 5 / 3. Both contacts press: |Fx| < F / mu.
    friction, depth, radius = 0.3, 5.0, 5.0
    lam = depth / (2.0 * radius * friction)
    points = np.array([[-radius, 0.0, 0.0], [radius, 0.0, depth]])
    normals = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    moment = radius * (lam + friction * (1.0 + lam) * side)
    load = Wrench.of((side, 0.0, -1.0), (0.0, moment, 0.0))
    assert_certified(hold_friction(points, normals, load, radius), friction)


@pytest.mark.parametrize("angle_deg", [0.0, 10.0, 45.0, 80.0])
def test_one_contact_balances_what_lies_in_its_cone(angle_deg: float) -> None:
    point, load_direction = np.array([1.0, 2.0, 3.0]), turn_about(np.array([0.3, 1.0, 0.0]), angle_deg) @ -UP
    load = Wrench.of(load_direction, point=point + 7.0 * load_direction)
    assert_certified(hold_friction([point], [UP], load, RADIUS), math.tan(math.radians(angle_deg)))
    assert_never(wedge_friction([point], [UP], RADIUS))


@pytest.mark.parametrize(
    "load",
    [
        push_through(1.0, 0.0),
        Wrench.of((0.0, 0.0, 1.0)),
        Wrench.of((1.0, 0.0, 0.0)),
        Wrench.of((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    ],
    ids=["beside it", "away from it", "along its plane", "a couple"],
)
def test_one_contact_balances_nothing_else(load: Wrench) -> None:
    assert_never(hold_friction([[0.0, 0.0, 0.0]], [UP], load, RADIUS))


def test_opposed_contacts_wedge_without_friction() -> None:
    points, normals = np.array([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    assert_certified(wedge_friction(points, normals, RADIUS), 0.0, tolerance=0.0)
    # A push between them is held by any friction, if they press enough: the least is 0 and is not attained.
    held = hold_friction(points, normals, PUSH, RADIUS)
    assert_certified(held, 0.0, tolerance=0.0)
    assert len(held.rays) == 1
    assert support_margin(points, normals, PUSH, RADIUS).upper == pytest.approx(-1.0, abs=ROUND_OFF)
    # None carries a moment about their line.
    assert_never(hold_friction(points, normals, push_through(0.0, 0.1), RADIUS))


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (0.7, -0.3), (-1.2, 0.4)])
def test_three_contacts_on_a_plane_carry_each_push_inside_their_triangle(x: float, y: float) -> None:
    points, normals = three_around(0.0, 0.0)
    load = push_through(x, y)
    assert_certified(hold_friction(points, normals, load, RADIUS), 0.0, tolerance=0.0)
    # A wrench is (y / r, -x / r, 1) there; the planes of the facets hold the triangle's edges.
    size = math.hypot(1.0, math.hypot(x, y) / 2.0)
    edges = [(-p / RADIUS) for p in points]
    margins = [(0.5 * RADIUS - edge[:2] @ (x, y)) / math.hypot(2.0, 0.5 * RADIUS) / size for edge in edges]
    margin = support_margin(points, normals, load, 2.0)
    assert margin.lower == pytest.approx(min(margins), abs=ROUND_OFF)
    assert margin.upper == pytest.approx(min(margins), abs=ROUND_OFF)
    corners = np.linalg.solve(np.vstack([points[:, :2].T, np.ones(3)]), [x, y, 1.0])
    forces = least_largest_normal_forces(points, normals, load, 0.0)
    assert forces.upper == pytest.approx(max(corners), abs=ROUND_OFF)
    assert forces.lower == pytest.approx(max(corners), abs=FRICTION_TOLERANCE)


@pytest.mark.parametrize("outside", [0.0, 0.2, 1.0])
def test_push_outside_the_triangle_has_the_margin_of_the_facet_beside_it(outside: float) -> None:
    points, normals = three_around(0.0, 0.0)
    x, y = -points[0, :2] / RADIUS * (0.5 * RADIUS + outside)
    margin = support_margin(points, normals, push_through(x, y), 2.0)
    expected = -outside / math.hypot(2.0, 0.5 * RADIUS) / math.hypot(1.0, math.hypot(x, y) / 2.0)
    assert margin.lower == pytest.approx(expected, abs=ROUND_OFF)
    assert margin.upper == pytest.approx(expected, abs=1e-10)
    if outside:
        assert_never(hold_friction(points, normals, push_through(x, y), RADIUS))


@pytest.mark.parametrize("tilt_deg", [15.0, -40.0])
def test_three_tilted_contacts_carry_a_push_on_their_axis_without_friction(tilt_deg: float) -> None:
    a = math.radians(tilt_deg)
    points, normals = three_around(math.sin(a), 0.0, math.cos(a))
    assert_certified(hold_friction(points, normals, PUSH, RADIUS), 0.0, tolerance=0.0)
    # The symmetric internal force lies along the radius.
    assert_certified(wedge_friction(points, normals, RADIUS), 1.0 / math.tan(abs(a)))
    # Of symmetric forces the largest allowed share of friction relieves the normals.
    for friction in (0.0, 0.1):
        forces = least_largest_normal_forces(points, normals, PUSH, friction)
        expected = 1.0 / 3.0 / (math.cos(a) + friction * math.sin(abs(a)))
        assert forces.friction <= friction + FRICTION_TOLERANCE
        assert forces.upper == pytest.approx(expected, abs=FRICTION_TOLERANCE)
        assert forces.lower == pytest.approx(expected, abs=FRICTION_TOLERANCE)


@pytest.mark.parametrize("torque", [0.05, 0.5, 2.0])
def test_three_tilted_contacts_resist_a_torque_as_one_contact_of_the_same_angle(torque: float) -> None:
    # By symmetry and convexity equal forces do; each has h = M / 3 rho around, v = F / 3 along the axis, and any radial
    # part. The nearest to the normal in that plane is off it by asin(cos(a) h / |(h, v)|).
    a = math.radians(25.0)
    points, normals = three_around(math.sin(a), 0.0, math.cos(a))
    h, v = torque / (3.0 * RADIUS), 1.0 / 3.0
    expected = math.tan(math.asin(math.cos(a) * h / math.hypot(h, v)))
    load = Wrench.of((0.0, 0.0, -1.0), (0.0, 0.0, torque))
    assert_certified(hold_friction(points, normals, load, RADIUS), expected)


@pytest.mark.parametrize(
    ("lead_deg", "half_angle_deg", "known"), [(4.185, 30.0, 0.0634), (2.4796, 30.0, 0.0375), (10.0, 0.0, 0.1763)]
)
def test_screw_locks_above_the_known_friction(lead_deg: float, half_angle_deg: float, known: float) -> None:
    lead, half = math.tan(math.radians(lead_deg)), math.tan(math.radians(half_angle_deg))
    points, normals = three_around(half, -lead)
    expected = lead * math.cos(math.radians(half_angle_deg))
    assert expected == pytest.approx(known, abs=5e-5)
    assert_certified(hold_friction(points, normals, PUSH, RADIUS), expected)


@pytest.mark.parametrize(("angle_deg", "friction"), [(40.0, 0.0), (40.0, 0.3), (40.0, 1.0), (70.0, 0.5)])
def test_reaction_of_one_contact_is_the_distance_from_its_cone(angle_deg: float, friction: float) -> None:
    point, a = np.array([1.0, -2.0, 0.5]), math.radians(angle_deg)
    load = Wrench.of((3.0 * math.sin(a), 0.0, -3.0 * math.cos(a)), point=point)
    found = reaction([point], [UP], load, RADIUS, friction, about=point)
    expected = 3.0 * math.sin(max(0.0, a - math.atan(friction)))
    assert found.lower - ROUND_OFF <= expected <= found.upper + ROUND_OFF
    assert found.upper - found.lower <= FRICTION_TOLERANCE
    assert np.linalg.norm(found.wrench[3:]) == pytest.approx(expected, abs=FRICTION_TOLERANCE)


def test_reaction_to_a_load_between_wedged_contacts_is_the_moment_about_their_line() -> None:
    points, normals = peg(6.0)
    load = Wrench.of((0.0, 0.0, -1.0), (0.0, 2.0, 0.0), (0.0, 0.4, 0.0))
    bounds = wedge_friction(points, normals, 5.0)
    assert bounds.upper is not None
    line = points[1] - points[0]
    moment = abs(load.about(points[0]).moment @ line) / np.linalg.norm(line)
    found = reaction(points, normals, load, 5.0, bounds.upper + 0.01, about=points[0])
    assert found.lower - ROUND_OFF <= moment / 5.0 <= found.upper + ROUND_OFF
    assert found.upper - found.lower <= FRICTION_TOLERANCE


@pytest.mark.parametrize(("tilt_deg", "friction"), [(30.0, 0.0), (30.0, 0.4), (-20.0, 0.4), (60.0, 0.2)])
def test_two_contacts_that_lean_against_each_other_share_a_push(tilt_deg: float, friction: float) -> None:
    # Each carries half of the push and a force between them, along any line within its cone.
    a, phi = math.radians(tilt_deg), math.atan(friction)
    points = np.array([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    normals = np.array([[math.sin(a), 0.0, math.cos(a)], [-math.sin(a), 0.0, math.cos(a)]])
    expected = sorted(0.5 * (math.cos(a) + math.sin(a) * math.tan(a + side * phi)) for side in (-1.0, 1.0))
    for contact in (0, 1):
        found = normal_force_range(points, normals, PUSH, friction, contact)
        for end, value in zip((found.least, found.largest), expected, strict=True):
            assert end == pytest.approx((value, value), abs=FRICTION_TOLERANCE)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("count", [2, 3, 4, 6])
def test_bounds_agree_with_each_other(seed: int, count: int) -> None:
    points, normals = scattered(100 * count + seed, count)
    load = push_through(0.2, -0.1)
    bounds, wedging = hold_friction(points, normals, load, RADIUS), wedge_friction(points, normals, RADIUS)
    for found in (bounds, wedging):
        if found.upper is None:
            assert_never(found)
        else:
            assert_certified(found, found.upper)
    if bounds.upper is None:
        assert not least_largest_normal_forces(points, normals, load, 1.0).upper
        return
    margin = support_margin(points, normals, load, RADIUS)
    assert (margin.lower >= 0.0) == (bounds.upper == 0.0)
    assert margin.upper - margin.lower <= FRICTION_TOLERANCE or margin.lower == math.inf
    above, below = 1.01 * bounds.upper + 0.001, 0.99 * bounds.lower
    assert reaction(points, normals, load, RADIUS, above).upper <= 1e-9
    largest = least_largest_normal_forces(points, normals, load, above)
    assert largest.upper is not None
    assert largest.forces is not None
    assert largest.upper - largest.lower <= 1e-6 * largest.upper
    assert imbalance(points, largest.forces, load) <= ROUND_OFF
    if bounds.lower > 0.0:
        assert reaction(points, normals, load, RADIUS, below).lower > 0.0
        assert least_largest_normal_forces(points, normals, load, below).upper is None


@pytest.mark.parametrize(("seed", "count"), [(0, 3), (1, 3), (2, 4)])
def test_pyramids_bracket_the_cone(seed: int, count: int) -> None:
    points, normals = scattered(seed, count)
    load = push_through(0.2, -0.1)
    hold, wedging = hold_friction(points, normals, load, RADIUS), wedge_friction(points, normals, RADIUS)
    assert hold.upper is not None
    assert wedging.upper is not None
    for sides in (4, 9):
        low, high = hold_friction_by_pyramids(points, normals, load, RADIUS, sides)
        assert high is not None
        assert low <= hold.upper
        assert high >= hold.lower
        assert low >= high * math.cos(math.pi / sides) - FRICTION_TOLERANCE
        low, high = wedge_friction_by_pyramids(points, normals, RADIUS, sides)
        assert high is not None
        assert low <= wedging.upper
        assert high >= wedging.lower
        assert low >= high * math.cos(math.pi / sides) - FRICTION_TOLERANCE


def test_square_pyramid_of_one_contact_is_known() -> None:
    # A load within the plane of two edges; turned by 45 degrees it meets the middle of a side.
    first = Contacts.of([[0.0, 0.0, 0.0]], [UP]).axes[0, :, 1]
    for turn_deg, factor in ((0.0, 1.0), (45.0, math.sqrt(2.0))):
        across = turn_about(UP, turn_deg) @ first
        load = Wrench.of(0.4 * across - UP)
        low, high = hold_friction_by_pyramids([[0.0, 0.0, 0.0]], [UP], load, RADIUS, 4)
        assert high == pytest.approx(0.4 * factor, abs=FRICTION_TOLERANCE)
        assert low == pytest.approx(0.4 * factor / math.sqrt(2.0), abs=FRICTION_TOLERANCE)


def test_nothing_depends_on_the_point_of_the_moment_or_on_the_frame() -> None:
    points, normals = scattered(1, 3)
    load = Wrench.of((0.1, 0.2, -1.0), (0.3, 0.0, 0.2), (0.1, 0.0, 0.4))
    moved = load.about((5.0, -7.0, 2.0))
    turn = turn_about(np.array([1.0, 2.0, 3.0]), 77.0)
    shift = np.array([0.5, 8.0, -3.0])
    turned = Wrench.of(turn @ load.force, turn @ load.moment, turn @ load.point + shift)
    for places, directions, same, about in (
        (points, normals, moved, np.zeros(3)),
        (points @ turn.T + shift, normals @ turn.T, turned, shift),
        (points[::-1], normals[::-1], load, np.zeros(3)),
    ):
        first, second = (
            (
                hold_friction(p, n, w, RADIUS).lower,
                wedge_friction(p, n, RADIUS).lower,
                support_margin(p, n, w, RADIUS, a).lower,
                reaction(p, n, w, RADIUS, 0.1, a).upper,
            )
            for p, n, w, a in ((points, normals, load, np.zeros(3)), (places, directions, same, about))
        )
        assert first == pytest.approx(second, abs=FRICTION_TOLERANCE)


@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_contacts_on_a_line_with_parallel_normals_carry_what_meets_the_line_between_them(friction: float) -> None:
    points, normals = np.array([[x, 0.0, 0.0] for x in (-1.0, 0.0, 2.0)]), np.tile(UP, (3, 1))
    assert_certified(hold_friction(points, normals, push_through(1.9, 0.0), RADIUS), 0.0, tolerance=0.0)
    assert_never(hold_friction(points, normals, push_through(2.1, 0.0), RADIUS))
    assert_never(hold_friction(points, normals, push_through(1.0, 0.1), RADIUS))
    assert_never(wedge_friction(points, normals, RADIUS))
    inclined = Wrench.of((friction, 0.0, -1.0), point=(1.0, 0.0, 0.0))
    assert_certified(hold_friction(points, normals, inclined, RADIUS), friction)
    aside = Wrench.of((0.0, friction, -1.0), point=(1.0, 0.0, 0.0))
    assert_certified(hold_friction(points, normals, aside, RADIUS), friction)


def test_load_through_one_of_three_contacts_is_carried_by_it() -> None:
    points, normals = three_around(0.0, 0.0)
    load = Wrench.of((0.2, 0.0, -1.0), point=points[1])
    bounds = hold_friction(points, normals, load, RADIUS)
    assert_certified(bounds, 0.2)
    assert support_margin(points, normals, push_through(*points[1, :2]), RADIUS).lower == pytest.approx(
        0.0, abs=ROUND_OFF
    )


def test_support_margin_where_the_cone_has_few_dimensions() -> None:
    one = support_margin([[0.0, 0.0, 0.0]], [UP], PUSH, RADIUS)
    assert (one.lower, one.upper) == pytest.approx((1.0, 1.0))
    opposed = np.array([UP, -UP])
    line = support_margin(np.zeros((2, 3)), opposed, PUSH, RADIUS)
    assert line.lower == line.upper == math.inf


@pytest.mark.parametrize("seed", [3, 5])
def test_support_margin_is_the_least_change_of_the_load_that_loses_support(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, normals = scattered(seed, 8)
    # A load within the cone, as coordinates (moment / r, force) of size 1 about the origin.
    weights = rng.uniform(0.5, 1.0, len(points))
    pushed = (weights[:, None] * np.hstack([np.cross(points, normals) / RADIUS, normals])).sum(axis=0)
    aim = pushed / np.linalg.norm(pushed)

    def margin_at(coordinates: Floats) -> float:
        load = Wrench.of(-coordinates[3:], -coordinates[:3] * RADIUS)
        return support_margin(points, normals, load, RADIUS).lower

    found = support_margin(points, normals, Wrench.of(-aim[3:], -aim[:3] * RADIUS), RADIUS)
    assert 0.0 < found.lower < 1.0
    assert found.twist is not None
    towards = np.concatenate([found.twist.angular * RADIUS, found.twist.linear])
    assert np.linalg.norm(towards) == pytest.approx(1.0)
    assert margin_at(aim - 0.999 * found.lower * towards) > 0.0
    assert margin_at(aim - 1.001 * found.lower * towards) < 0.0
    for _ in range(20):
        change = rng.normal(size=6)
        assert margin_at(aim + 0.999 * found.lower * change / np.linalg.norm(change)) > 0.0


def test_certificates_prove_nothing_where_they_fail() -> None:
    points, normals = three_around(0.0, 0.0)
    still = np.zeros(3)
    down, up, turn = Twist(still, -UP, still), Twist(still, UP, still), Twist(np.array([1.0, 0.0, 0.0]), still, still)
    for twist in (down, up, turn):
        assert twist_bound(points, normals, PUSH, twist) == 0.0
        assert twist_bound(points, normals, PUSH, None, [twist]) == 0.0
    assert twist_bound(points, normals, None, turn) == 0.0
    assert twist_bound(points, normals, None, None, [up]) == math.inf
    balanced = normals / 3.0
    assert forces_bound(points, normals, PUSH, balanced) == 0.0
    assert forces_bound(points, normals, PUSH, 1.001 * balanced) == math.inf
    assert forces_bound(points, normals, push_through(0.1, 0.0), balanced) == math.inf
    assert forces_bound(points, normals, None, balanced) == math.inf
    assert forces_bound(points, normals, None, 0.0 * balanced) == math.inf
    assert forces_bound(points, normals, Wrench.of((0.0, 0.0, 1.0)), -balanced) == math.inf
    assert forces_bound(points, normals, PUSH, balanced, [balanced]) == math.inf


def test_what_is_no_contact_and_no_load_is_refused() -> None:
    with pytest.raises(ValueError, match="load is zero"):
        Wrench.of((0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="three finite numbers"):
        Wrench.of((0.0, math.nan, 0.0))
    with pytest.raises(ValueError, match="k > 0"):
        wedge_friction(np.zeros((0, 3)), np.zeros((0, 3)), RADIUS)
    with pytest.raises(ValueError, match="unit length"):
        wedge_friction([[0.0, 0.0, 0.0]], [[0.0, 0.0, 1.1]], RADIUS)
    with pytest.raises(ValueError, match="length must be positive"):
        wedge_friction([[0.0, 0.0, 0.0]], [UP], 0.0)
    with pytest.raises(ValueError, match="at least 0"):
        reaction([[0.0, 0.0, 0.0]], [UP], PUSH, RADIUS, -0.1)
    with pytest.raises(ValueError, match="three sides"):
        wedge_friction_by_pyramids([[0.0, 0.0, 0.0]], [UP], RADIUS, 2)
