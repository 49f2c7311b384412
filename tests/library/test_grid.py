from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid


def test_the_default_grid_is_81_orientations_of_360_phases() -> None:
    grid = Grid()
    assert grid.tilts_deg == (-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0)
    assert grid.phases_deg == tuple(float(phase) for phase in range(360))
    assert (grid.orientation_count, grid.pose_count) == (81, 29160)


def test_a_decimal_step_gives_the_decimals_a_reader_would_write() -> None:
    grid = Grid(tilt_max_deg=0.3, tilt_step_deg=0.1, phase_step_deg=0.3)
    assert grid.tilts_deg == (-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3)
    assert grid.phases_deg[3] == 0.9
    assert 3 * 0.3 != 0.9
    assert grid.phases_deg[-1] == 359.7


def test_poses_are_in_the_order_of_their_ordinals() -> None:
    grid = Grid(1.0, 1.0, 120.0)
    poses = [pose for index in range(grid.orientation_count) for pose in grid.poses(index)]
    assert poses == sorted(poses)
    assert len(set(poses)) == grid.pose_count == 27
    assert [grid.first_ordinal(index) for index in range(3)] == [0, 3, 6]
    assert poses[grid.first_ordinal(5)] == (0.0, 1.0, 0.0)


def test_no_angle_is_minus_zero() -> None:
    grid = Grid(2.0, 0.5, 90.0)
    assert all(math.copysign(1.0, angle) > 0 for angle in (*grid.tilts_deg, *grid.phases_deg) if angle == 0.0)


def test_zero_tilt_alone_is_a_grid() -> None:
    assert Grid(0.0, 1.0, 90.0).tilts_deg == (0.0,)


@given(st.integers(1, 1000), st.integers(1, 100))
def test_any_step_in_hundredths_divides_its_own_multiples(hundredths: int, count: int) -> None:
    step = hundredths / 100
    if hundredths * count > 1000:
        count = 1000 // hundredths
    grid = Grid(hundredths * count / 100, step, 360.0)
    assert grid.tilt_count == 2 * count + 1
    assert grid.tilts_deg[-1] == hundredths * count / 100
    assert grid.tilts_deg == tuple(-tilt for tilt in reversed(grid.tilts_deg))


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ((10.5, 0.5, 1.0), "tilt_max"),
        ((-1.0, 1.0, 1.0), "tilt_max"),
        ((math.nan, 1.0, 1.0), "tilt_max"),
        ((4.0, 0.0, 1.0), "tilt_step"),
        ((4.0, 3.0, 1.0), "tilt_step"),
        ((4.0, 8.0, 1.0), "tilt_step"),
        ((4.0, math.inf, 1.0), "tilt_step"),
        ((4.0, 1.0, 7.0), "phase_step"),
        ((4.0, 1.0, 0.001), "phase_step"),
        ((4.0, 1.0, -1.0), "phase_step"),
        ((10.0, 0.01, 0.01), "pose count"),
    ],
)
def test_an_impossible_grid_names_the_value(values: tuple[float, float, float], name: str) -> None:
    with pytest.raises(InvalidValueError, match=name):
        Grid(*values)
