from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import ArrayLike

from oracle.pose import pose_rotation, turn_about
from threadstate.mesh.frames import (
    along,
    apply,
    axis_angles,
    fixed_from_bolt,
    inverse,
    rot_x,
    rot_y,
    rot_z,
    trans,
    turned,
)
from threadstate.mesh.solid import Floats

RNG = np.random.default_rng(6)
EXACT = 1e-13


def axis_angles_as_printed(direction: ArrayLike) -> tuple[float, float]:
    """The same with the acos of Eqs. 7, 9 and 11 as printed: wrong where y < 0, undefined along +-z.

    Raises:
        ValueError: the direction, of unit length, is along z.
    """
    x, _, z = (float(v) for v in np.asarray(direction, dtype=np.float64))
    sine = math.sin(math.acos(z))
    if sine == 0.0:
        raise ValueError(f"direction {direction!r} is along z: Eq. 7 divides by 0")
    return math.acos(max(-1.0, min(1.0, x / sine))), math.acos(z) - math.pi / 2.0


def p0_from_fixed(T_p0_c0: Floats, T_c0_fixed: Floats) -> Floats:
    """Eq. 13."""
    return T_p0_c0 @ T_c0_fixed


def p0_from_bolt(T_p0_c0: Floats, second_turn: float, T_c0_fixed: Floats, T_fixed_bolt: Floats) -> Floats:
    """Eq. 14: bolt to P0 at the second contact; ``T_fixed_bolt`` is the pose of the first."""
    return T_p0_c0 @ rot_x(second_turn) @ T_c0_fixed @ T_fixed_bolt


def fixed_from_p0(T_p0_c0: Floats, T_c0_fixed: Floats) -> Floats:
    """Eq. 16."""
    return inverse(T_c0_fixed) @ inverse(T_p0_c0)


def bolt_from_p0(third_turn: float, T_p0_c0: Floats, second_turn: float, T_c0_bolt: Floats) -> Floats:
    """Eq. 17: P0 to bolt at the third contact; ``T_c0_bolt`` is that of the pose of the first (Eq. 8)."""
    return inverse(T_c0_bolt) @ rot_x(-second_turn) @ inverse(T_p0_c0) @ rot_x(-third_turn)


def unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))


DIRECTIONS = [unit(vector) for vector in RNG.normal(size=(40, 3))]
AXES = [sign * axis for axis in np.eye(3) for sign in (1.0, -1.0)]


def test_a_pose_is_the_rotation_of_the_method_and_a_translation() -> None:
    T = fixed_from_bolt(math.radians(3.0), math.radians(-2.0), math.radians(200.0), [0.1, 0.2, 0.3])
    assert T[:3, :3] == pytest.approx(pose_rotation(3.0, -2.0, 200.0), abs=EXACT)
    assert T[:3, 3] == pytest.approx([0.1, 0.2, 0.3])


def test_inverse_undoes() -> None:
    T = fixed_from_bolt(0.3, -0.2, 1.0, [0.1, 0.2, 0.3])
    assert inverse(T) @ T == pytest.approx(np.eye(4), abs=EXACT)
    points = RNG.normal(size=(5, 3))
    assert apply(inverse(T), apply(T, points)) == pytest.approx(points, abs=EXACT)


@pytest.mark.parametrize("rotate", [rot_x, rot_y, rot_z])
def test_rotations_are_right_handed_and_add_up(rotate: object) -> None:
    assert callable(rotate)
    assert rotate(0.3) @ rotate(0.4) == pytest.approx(rotate(0.7), abs=EXACT)
    axis = {rot_x: 0, rot_y: 1, rot_z: 2}[rotate]
    assert rotate(0.7)[:3, :3] == pytest.approx(turn_about(np.eye(3)[axis], math.degrees(0.7)), abs=EXACT)


@pytest.mark.parametrize("direction", [*DIRECTIONS, *AXES])
def test_a_frame_along_a_direction_has_its_x_axis_there(direction: Floats) -> None:
    origin = np.array([0.3, -0.1, 0.2])
    T = along(direction, origin)
    assert apply(T, origin) == pytest.approx([0.0, 0.0, 0.0], abs=EXACT)
    assert apply(T, origin + direction) == pytest.approx([1.0, 0.0, 0.0], abs=EXACT)
    assert np.linalg.det(T[:3, :3]) == pytest.approx(1.0)


@pytest.mark.parametrize("direction", DIRECTIONS)
def test_the_printed_angles_are_right_on_one_side_alone(direction: Floats) -> None:
    """The acos of Eqs. 7, 9 and 11 loses the sign of y."""
    found, printed = axis_angles(direction), axis_angles_as_printed(direction)
    assert printed[1] == pytest.approx(found[1], abs=1e-12)
    if direction[1] > 0.0:
        assert printed[0] == pytest.approx(found[0], abs=1e-12)
    else:
        assert printed[0] == pytest.approx(-found[0], abs=1e-12)
        assert abs(printed[0] - found[0]) > 1e-3


def test_the_printed_angles_fail_along_z() -> None:
    for z in (1.0, -1.0):
        assert axis_angles([0.0, 0.0, z]) == pytest.approx((0.0, -z * math.pi / 2.0))
    with pytest.raises(ValueError, match="divides by 0"):
        axis_angles_as_printed([0.0, 0.0, 1.0])


def test_a_turn_is_one_about_the_axis_of_its_frame() -> None:
    T, origin, direction = fixed_from_bolt(0.1, 0.2, 0.3, [0.0, 0.0, 0.5]), np.array([0.1, 0.2, 0.0]), DIRECTIONS[0]
    moved = turned(T, along(direction, origin), 0.4)
    rotation = turn_about(direction, math.degrees(0.4))
    assert moved[:3, :3] == pytest.approx(rotation @ T[:3, :3], abs=EXACT)
    assert moved[:3, 3] == pytest.approx(origin + rotation @ (T[:3, 3] - origin), abs=EXACT)


def test_the_cycles_of_equations_13_to_17_close() -> None:
    first = fixed_from_bolt(0.05, -0.03, 2.0, [0.0, 0.0, 0.004])
    cp0, tangent, second_turn, third_turn = np.array([0.1, 0.05, 0.0]), unit(np.array([-0.4, 0.9, 0.05])), -0.03, 0.02
    T_c0_fixed = along(tangent, cp0)
    second = turned(first, T_c0_fixed, second_turn)
    # Eq. 8: along the tangent through the contact, both seen from the bolt.
    T_fixed_bolt = inverse(first)
    T_c0_bolt = along(T_fixed_bolt[:3, :3] @ tangent, apply(T_fixed_bolt, cp0))

    cp1 = np.array([-0.06, 0.08, 0.001])
    axis_in_c0 = unit(apply(T_c0_fixed, cp1))
    T_p0_c0 = along(axis_in_c0, np.zeros(3))
    T_p0_fixed = p0_from_fixed(T_p0_c0, T_c0_fixed)
    assert apply(T_p0_fixed, [cp0, cp1]) == pytest.approx(
        np.array([[0.0, 0.0, 0.0], [np.linalg.norm(cp1 - cp0), 0.0, 0.0]]), abs=EXACT
    )
    assert fixed_from_p0(T_p0_c0, T_c0_fixed) @ T_p0_fixed == pytest.approx(np.eye(4), abs=EXACT)
    assert p0_from_bolt(T_p0_c0, second_turn, T_c0_fixed, first) == pytest.approx(T_p0_fixed @ second, abs=EXACT)

    third = turned(second, T_p0_fixed, third_turn)
    # Both C0 frames have their x axes along the tangent through CP0, but may be turned about it.
    twist = T_c0_fixed @ first @ inverse(T_c0_bolt)
    angle = math.atan2(twist[2, 1], twist[1, 1])
    assert twist == pytest.approx(rot_x(angle), abs=EXACT)
    bolt_from = bolt_from_p0(third_turn, T_p0_c0, second_turn + angle, T_c0_bolt)
    point = np.array([0.02, -0.11, -0.003])
    assert apply(bolt_from, apply(T_p0_fixed, point)) == pytest.approx(apply(inverse(third), point), abs=EXACT)


def test_translations_add_up() -> None:
    assert trans([1.0, 2.0, 3.0]) @ trans([0.5, 0.0, -3.0]) == pytest.approx(trans([1.5, 2.0, 0.0]))
