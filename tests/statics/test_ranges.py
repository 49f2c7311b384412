"""How far balancing forces are from unique, and least reactions beside the witness (forces, section 3)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.statics import loads as witness
from oracle.statics.wrenches import Wrench
from tests.statics.test_check_values import hold, wedge
from tests.statics.test_friction import scenes
from threadstate.state.solve import solve_pose
from threadstate.statics.load import Load
from threadstate.statics.ranges import forces_range_of, normal_ranges
from threadstate.statics.reaction import least_wrench, reaction_of
from threadstate.statics.scene import scene_of
from threadstate.statics.solve import statics_of
from threadstate.statics.wrench_cone import contact_maps
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()


def ranges(points: Floats, normals: Floats, load: Floats, mu: float) -> Floats:
    """Least and largest normal force of each contact, and how uncertain they are: shape (k, 3)."""
    size = float(np.linalg.norm(load))
    return np.array(normal_ranges(contact_maps(points, normals, mu), load / size)) * size / math.hypot(1.0, mu)


@pytest.mark.parametrize("contacts", [1, 2, 3, 4])
def test_the_least_reaction_is_the_witnesses(contacts: int) -> None:
    """Its bounds are nearly one number, where contacts wedge as well."""
    for points, normals, load in scenes(8, contacts, seed=40 + contacts):
        wedging = wedge(points, normals)[2]
        for mu in (0.0, 0.2, 1.0, 1.2 * wedging if wedging < math.inf else 5.0):
            lower, wrench = least_wrench(contact_maps(points, normals, mu), load)
            upper = float(np.linalg.norm(wrench))
            theirs = witness.reaction(points, normals, Wrench.of(load[3:], load[:3]), 1.0, mu)
            assert upper - lower <= 1e-9
            assert lower - 1e-9 <= theirs.upper
            assert theirs.lower <= upper + 1e-9


def test_a_reaction_is_needed_exactly_where_the_contacts_do_not_hold_the_load() -> None:
    for points, normals, load in scenes(30, 3, seed=5):
        _, lower, upper = hold(load, points, normals)
        # Near the friction that wedges the forces are some thousand times the load.
        assert np.linalg.norm(least_wrench(contact_maps(points, normals, 1.001 * upper), load)[1]) < 1e-6
        assert least_wrench(contact_maps(points, normals, 0.99 * lower), load)[0] > 0.0


def test_the_reaction_of_one_contact_is_the_distance_from_its_cone() -> None:
    points, normals = np.zeros((1, 3)), np.array([[0.0, 0.0, 1.0]])
    for angle, mu in ((0.7, 0.0), (0.7, 0.3), (1.2, 1.0)):
        load = 3.0 * np.array([0.0, 0.0, 0.0, math.sin(angle), 0.0, -math.cos(angle)])
        lower, wrench = least_wrench(contact_maps(points, normals, mu), load)
        expected = 3.0 * math.sin(angle - math.atan(mu))
        assert lower == pytest.approx(expected, abs=1e-9)
        assert np.linalg.norm(wrench) == pytest.approx(expected, abs=1e-9)


def test_a_patch_takes_its_whole_hull() -> None:
    state = solve_pose(PAIR, 4.0, -3.0, 185.0)
    assert reaction_of(PAIR, state).size == pytest.approx(-statics_of(PAIR, state).support_margin, abs=1e-9)
    across = Load(force=(0.2, 0.3, -1.0), moment=(0.0, 0.01, 0.02))
    found = reaction_of(PAIR, state, across, 0.2)
    assert 0.0 < found.size <= found.least_size + 1e-9
    scene = scene_of(PAIR, state, across)
    assert forces_range_of(scene, 0.2, held=False).internal_dimension is None


@pytest.mark.parametrize(("contacts", "count"), [(3, 12), (4, 4)])
def test_ranges_of_forces_are_the_witnesses(contacts: int, count: int) -> None:
    compared = 0
    for points, normals, load in scenes(count, contacts, seed=20 + contacts):
        holding, wedging = hold(load, points, normals)[2], wedge(points, normals)[2]
        mu = 0.5 * (holding + min(wedging, 2.0 * holding))
        if mu <= holding:
            continue
        compared += 1
        found = ranges(points, normals, load, mu)
        assert found[:, 2].max() < 1e-6 * found[:, 1].max()
        for contact, (least, largest, uncertainty) in enumerate(found):
            theirs = witness.normal_force_range(points, normals, Wrench.of(load[3:], load[:3]), mu, contact)
            assert max(theirs.least[1] - theirs.least[0], theirs.largest[1] - theirs.largest[0]) < 1e-7
            tolerance = uncertainty + 1e-8 * (1.0 + largest)
            assert theirs.least[0] - tolerance <= least <= theirs.least[1] + tolerance
            assert theirs.largest[0] - tolerance <= largest <= theirs.largest[1] + tolerance
    assert compared > count // 2


@pytest.mark.parametrize(("tilt_deg", "mu"), [(30.0, 0.0), (30.0, 0.4), (-20.0, 0.4), (60.0, 0.2), (60.0, 0.6)])
def test_two_contacts_that_lean_against_each_other_share_a_push(tilt_deg: float, mu: float) -> None:
    """Each carries half of the push and a force between them, along any line within its cone; at last they wedge."""
    a, phi = math.radians(tilt_deg), math.atan(mu)
    points = np.array([[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    normals = np.array([[math.sin(a), 0.0, math.cos(a)], [-math.sin(a), 0.0, math.cos(a)]])
    ends = sorted(0.5 * (math.cos(a) + math.sin(a) * math.tan(a + side * phi)) for side in (-1.0, 1.0))
    expected = ends if a + phi < math.pi / 2.0 else [ends[1], math.inf]
    found = ranges(points, normals, np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0]), mu)
    assert found[:, :2] == pytest.approx(np.array([expected, expected]), abs=1e-8)


def test_forces_without_friction_are_unique_and_those_that_wedge_have_no_limit() -> None:
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    points = np.array([[1.0, 0.0, 0.0], [-0.5, 0.8, 0.0], [-0.5, -0.8, 0.0]])
    push = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -3.0])
    assert ranges(points, up, push, 0.0) == pytest.approx(np.array([[1.0, 1.0, 0.0]] * 3), abs=1e-9)
    # Two of four contacts oppose each other; what they press with does not matter to the other two.
    sides = np.array([[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
    facing = np.array([[0.0, 1.0, 0.0], [0.0, -1.0, 0.0]])
    both = np.vstack([np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]), sides]), np.vstack([up[:2], facing])
    assert ranges(*both, push, 0.0)[:, :2] == pytest.approx(
        np.array([[1.5, 1.5], [1.5, 1.5], [0.0, math.inf], [0.0, math.inf]]), abs=1e-9
    )


def test_neither_order_nor_mirror_nor_size_changes_what_is_found() -> None:
    mirror, pseudo = np.array([1.0, -1.0, 1.0]), np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    order = [2, 0, 1]
    for points, normals, load in scenes(6, 3, seed=31):
        mu = 1.3 * hold(load, points, normals)[2]
        given = ranges(points, normals, load, mu)[:, :2]
        moved = ranges(points[order], normals[order], load, mu)[:, :2]
        assert moved == pytest.approx(given[order], rel=1e-6, abs=1e-8)
        assert ranges(points * mirror, normals * mirror, load * pseudo, mu)[:, :2] == pytest.approx(
            given, rel=1e-6, abs=1e-8
        )
        assert ranges(points, normals, 1e3 * load, mu)[:, :2] == pytest.approx(1e3 * given, rel=1e-6, abs=1e-5)
        needed = least_wrench(contact_maps(points, normals, 0.1 * mu), load)[1]
        other = least_wrench(contact_maps(points[order] * mirror, normals[order] * mirror, 0.1 * mu), load * pseudo)[1]
        assert other == pytest.approx(needed * pseudo, abs=1e-6)


def test_forces_of_a_state_lie_within_their_range() -> None:
    state = solve_pose(PAIR, 1.0, -2.0, 10.0)
    for mu, unlimited in ((1.5, False), (2.0, True)):
        statics = statics_of(PAIR, state, mu=mu)
        found = forces_range_of(scene_of(PAIR, state, statics.load), mu, held=True)
        assert found.internal_dimension == 3
        for force, limits in zip(statics.forces, found.contacts, strict=True):
            assert limits.normal_min - 1e-6 <= force.normal <= limits.normal_max + 1e-6
            assert math.isinf(limits.normal_max) == unlimited
    assert forces_range_of(scene_of(PAIR, state, Load()), 0.2, held=False).contacts == ()
