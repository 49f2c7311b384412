"""Contact modes beside closed forms, Coulomb's law and a search of another kind (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from tests.statics.test_check_values import hold
from tests.statics.test_friction import scenes
from threadstate.errors import InvalidValueError
from threadstate.state.solve import solve_pose
from threadstate.statics.load import Load
from threadstate.statics.modes import ContactMode, ModeStatus, Motion, contact_modes, modes_of
from threadstate.statics.reaction import least_wrench
from threadstate.statics.scene import Scene, scene_of
from threadstate.statics.solve import statics_of
from threadstate.statics.torus_roots import common_zeros, padded, times_cosine, times_sine
from threadstate.statics.touching import Touching
from threadstate.statics.wrench_cone import contact_maps, force_maps
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()
OPENS, STICKS, SLIDES = Motion.OPENS, Motion.STICKS, Motion.SLIDES
UP = np.array([[0.0, 0.0, 1.0]])


def scene(points: Floats, normals: Floats, load: Floats) -> Scene:
    origin = (0.0, 0.0, 0.0)
    return Scene(load, Touching(points, normals, len(points), origin, False, False, 0.0, False), 1.0)


def twist(mode: ContactMode) -> Floats:
    assert mode.angular is not None
    assert mode.linear is not None
    return np.array([*mode.angular, *mode.linear])


def searched(points: Floats, normals: Floats, load: Floats, mu: float, starts: int) -> list[Floats]:
    """Twists that Newton's method finds from random forces: zeros of forces less their projections on the cones."""
    k = len(points)
    columns = np.concatenate(list(force_maps(points, normals)), axis=1)
    response, free = columns.T @ columns, columns.T @ load
    identity = np.eye(3 * k)

    def residual(forces: Floats) -> tuple[Floats, Floats]:
        velocities = free + response @ forces
        left, jacobian = forces.copy(), identity.copy()
        for a in range(0, 3 * k, 3):
            pressed = forces[a] - velocities[a]
            if pressed <= 0.0:
                continue
            left[a], jacobian[a] = velocities[a], response[a]
            across = slice(a + 1, a + 3)
            pulled, slope = forces[across] - velocities[across], identity[across] - response[across]
            size = float(np.linalg.norm(pulled))
            if size <= mu * pressed:
                left[across], jacobian[across] = velocities[across], response[across]
                continue
            along = pulled / size
            left[across] -= mu * pressed * along
            turned = mu * pressed / size * (np.eye(2) - np.outer(along, along))
            jacobian[across] -= turned @ slope + mu * np.outer(along, identity[a] - response[a])
        return left, jacobian

    rng = np.random.default_rng(0)
    found: list[Floats] = []
    for _ in range(starts):
        forces = rng.normal(size=3 * k) * 10.0 ** rng.uniform(-2.0, 1.0)
        forces[::3] = np.abs(forces[::3])
        for _ in range(40):
            left, jacobian = residual(forces)
            size = float(np.linalg.norm(left))
            if size < 1e-12 * (1.0 + np.linalg.norm(forces)):
                moving = load + columns @ forces
                if not any(np.abs(moving - other).max() < 1e-6 for other in found):
                    found.append(moving)
                break
            step, part = np.linalg.lstsq(jacobian, -left, rcond=1e-12)[0], 1.0
            while part > 1e-3 and np.linalg.norm(residual(forces + part * step)[0]) > size:
                part /= 2.0
            forces = forces + part * step
    return found


@pytest.mark.parametrize("mu", [0.3, 1.0])
def test_a_contact_at_the_origin_does_what_a_block_on_a_slope_does(mu: float) -> None:
    for slope in (0.1, 0.5, 1.1, 2.0):
        load = 2.0 * np.array([0.0, 0.0, 0.0, math.sin(slope), 0.0, -math.cos(slope)])
        (mode,) = modes_of(scene(np.zeros((1, 3)), UP, load), mu)
        speed = 2.0 * (math.sin(slope) - mu * math.cos(slope))
        if slope > math.pi / 2.0:
            assert mode.contacts == (OPENS,)
            assert twist(mode) == pytest.approx(load)
            assert mode.margin == pytest.approx(-math.cos(slope))
        elif speed > 0.0:
            assert mode.contacts == (SLIDES,)
            assert twist(mode) == pytest.approx([0.0, 0.0, 0.0, speed, 0.0, 0.0], abs=1e-12)
            assert mode.forces[0].normal == pytest.approx(2.0 * math.cos(slope))
            assert mode.forces[0].tangential[0] == pytest.approx(-2.0 * mu * math.cos(slope))
            assert mode.margin == pytest.approx(min(math.cos(slope), 0.5 * speed))
        else:
            assert mode.contacts == (STICKS,)
            assert twist(mode) == pytest.approx(np.zeros(6), abs=1e-12)
            assert mode.margin == pytest.approx((mu * math.cos(slope) - math.sin(slope)) / math.hypot(1.0, mu))


def test_a_load_on_the_border_of_the_cone_is_marginal() -> None:
    load = np.array([0.0, 0.0, 0.0, 0.3, 0.4, -1.0])
    (mode,) = modes_of(scene(np.zeros((1, 3)), UP, load), 0.5)
    assert (mode.contacts, mode.status) == ((STICKS,), ModeStatus.MARGINAL)


def test_without_friction_the_motion_is_the_only_one_and_opposes_the_reaction() -> None:
    for contacts in (1, 2, 3):
        for points, normals, load in scenes(6, contacts, seed=60 + contacts):
            (mode,) = modes_of(scene(points, normals, load), 0.0)
            assert twist(mode) == pytest.approx(-least_wrench(contact_maps(points, normals, 0.0), load)[1], abs=1e-7)
            (little,) = modes_of(scene(points, normals, load), 1e-6)
            assert twist(little) == pytest.approx(twist(mode), abs=1e-4)


@pytest.mark.parametrize(("contacts", "count", "mu"), [(2, 6, 1.0), (2, 6, 2.5), (3, 4, 0.4), (3, 3, 2.0)])
def test_all_motions_are_those_that_a_search_finds(contacts: int, count: int, mu: float) -> None:
    """There is always one, and rest is one exactly where the contacts can hold the load."""
    for points, normals, load in scenes(count, contacts, seed=100 + contacts):
        found = modes_of(scene(points, normals, load), mu)
        assert {mode.status for mode in found} == {ModeStatus.CONSISTENT}
        others = searched(points, normals, load, mu, 40)
        for mode in found:
            assert min(np.abs(twist(mode) - other).max() for other in others) < 1e-6
        for other in others:
            assert min(np.abs(twist(mode) - other).max() for mode in found) < 1e-6
        rests = any(np.abs(twist(mode)).max() < 1e-9 for mode in found)
        assert rests == (mu >= hold(load, points, normals)[2])


def test_a_state_may_rest_or_move_in_two_ways() -> None:
    state, mu = solve_pose(PAIR, 3.0, 2.0, 0.0), 2.0
    found = contact_modes(PAIR, state, mu=mu)
    assert {mode.contacts for mode in found} == {
        (STICKS, STICKS, STICKS),
        (STICKS, OPENS, STICKS),
        (SLIDES, OPENS, SLIDES),
    }
    placed = scene_of(PAIR, state, Load())
    metric = np.repeat([placed.radius, 1.0], 3)
    for other in searched(placed.points, placed.normals, placed.load, mu, 40):
        assert min(np.abs(metric * twist(mode) - other).max() for mode in found) < 1e-6
    for mode in found:
        moving = metric * twist(mode)
        # Coulomb's law at each contact, and the motion that its forces and the load drive.
        drive = placed.load.copy()
        for motion, force, point, normal in zip(mode.contacts, mode.forces, placed.points, placed.normals, strict=True):
            tangential = np.array(force.tangential)
            whole = force.normal * normal + tangential
            drive += [*np.cross(point, whole), *whole]
            velocity = moving[3:] + np.cross(moving[:3], point)
            leaving = float(velocity @ normal)
            across = velocity - leaving * normal
            if motion is OPENS:
                assert force.normal == np.linalg.norm(tangential) == 0.0
                assert leaving > 0.01
            else:
                assert force.normal > 0.01
                assert abs(leaving) < 1e-12
                assert np.linalg.norm(tangential) <= mu * force.normal * (1.0 + 1e-12)
            if motion is STICKS:
                assert np.abs(velocity).max() < 1e-12
            if motion is SLIDES:
                friction = -mu * force.normal * across / np.linalg.norm(across)
                assert tangential == pytest.approx(friction, abs=1e-10)
        assert drive == pytest.approx(moving, abs=1e-10)
    assert len(contact_modes(PAIR, state, mu=0.99 * statics_of(PAIR, state).hold.lower)) == 2


def test_neither_order_nor_mirror_nor_size_of_the_load_changes_the_motions() -> None:
    mirror, pseudo = np.array([1.0, -1.0, 1.0]), np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
    order = [2, 0, 1]
    points, normals, load = scenes(2, 3, seed=143)[1]
    given = {mode.contacts: twist(mode) for mode in modes_of(scene(points, normals, load), 1.5)}
    other = modes_of(scene(points[order] * mirror, normals[order] * mirror, 1e-3 * load * pseudo), 1.5)
    assert len(other) == len(given)
    for mode in other:
        contacts = tuple(mode.contacts[order.index(i)] for i in range(3))
        assert 1e3 * twist(mode) * pseudo == pytest.approx(given[contacts], abs=1e-9)


def test_what_slides_under_any_force_is_undecided() -> None:
    """Two contacts that oppose each other may press with any force as the bolt slides between them."""
    points, normals = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    found = modes_of(scene(points, normals, np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0])), 0.3)
    undecided = [mode for mode in found if mode.status is ModeStatus.UNDECIDED]
    assert {mode.contacts for mode in undecided} == {(SLIDES, SLIDES), (STICKS, SLIDES), (SLIDES, STICKS)}
    assert undecided[0].margin is None
    assert (STICKS, STICKS) in [mode.contacts for mode in found]


def test_patches_and_bad_frictions_are_refused() -> None:
    flush = solve_pose(PAIR, 4.0, -3.0, 185.0)
    with pytest.raises(InvalidValueError, match="contacts is 'a patch'; valid: one to three contacts, at points"):
        contact_modes(PAIR, flush)
    tilted = solve_pose(PAIR, 1.0, -2.0, 10.0)
    with pytest.raises(InvalidValueError, match="contacts is '4'"):
        contact_modes(PAIR, replace(tilted, contacts=tilted.contacts + tilted.contacts[:1]))
    with pytest.raises(InvalidValueError, match=r"mu is -1\.0"):
        contact_modes(PAIR, tilted, mu=-1.0)


def test_zeros_of_trigonometric_polynomials_are_all_found() -> None:
    # cos a = b: two zeros; sin(2 a) = 0, as sin a cos a: four.
    assert np.sort(common_zeros([np.array([-0.3, 1.0, 0.0, 0.0, 0.0])], []).angles[:, 0]) == pytest.approx(
        [-math.acos(0.3), math.acos(0.3)]
    )
    four = common_zeros([times_cosine(np.array([0.0, 0.0, 1.0]), 0)], [])
    assert four.complete
    assert len(four.angles) == 4
    # cos a + sin b = 0.5 and sin a cos b = 0.1, which asin(...) reduces to one angle; only where sin a > 0.
    first = padded(np.array([[-0.5, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    second = padded(np.array([[-0.1, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))
    positive = times_sine(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]), 0)
    one = padded(np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]))
    found = common_zeros([first, second], [positive, one])
    assert found.complete
    grid = np.linspace(0.0, math.pi, 200_001)
    sines = 0.5 - np.cos(grid)
    real = np.abs(sines) <= 1.0
    changes = 0
    for sign in (1.0, -1.0):
        values = np.where(real, np.sin(grid) * sign * np.sqrt(np.maximum(1.0 - sines**2, 0.0)) - 0.1, np.nan)
        changes += int((values[:-1] * values[1:] < 0.0).sum())
    inside = found.angles[np.sin(found.angles[:, 0]) > 0.0]
    assert len(inside) == changes
    for a, b in inside:
        assert math.cos(a) + math.sin(b) == pytest.approx(0.5, abs=1e-12)
        assert math.sin(a) * math.cos(b) == pytest.approx(0.1, abs=1e-12)


def test_zeros_that_are_not_isolated_leave_the_search_incomplete() -> None:
    assert not common_zeros([np.zeros(5)], []).complete
    assert not common_zeros([np.array([1.0, -1.0, 0.0, 0.0, 0.0])], []).complete
