from __future__ import annotations

import math

import pytest

from threadstate.errors import InvalidValueError
from threadstate.state.model import Flag, StateClass
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
THREE_CONTACTS_DEG = (-4.0, 0.0, 131.0)
ROUND_OFF_DEG = 1e-12


@pytest.mark.parametrize(
    ("name", "value", "limit"),
    [
        ("turn_limit_deg", 0.0, "45"),
        ("turn_limit_deg", -1.0, "45"),
        ("turn_limit_deg", 45.1, "45"),
        ("turn_limit_deg", math.nan, "45"),
        ("quasi_stable_fraction", -0.01, "1"),
        ("quasi_stable_fraction", 1.01, "1"),
        ("quasi_stable_fraction", math.inf, "1"),
        ("tie_tolerance", 0.0, "0.0001"),
        ("tie_tolerance", 1e-3, "0.0001"),
        ("embedment_tolerance", 0.0, "0.01"),
        ("embedment_tolerance", 0.1, "0.01"),
    ],
)
def test_an_option_out_of_range_names_itself_its_value_and_the_limit(name: str, value: float, limit: str) -> None:
    with pytest.raises(InvalidValueError) as error:
        SolveOptions(**{name: value})
    assert error.value.name == name
    assert repr(value) in str(error.value)
    assert limit in error.value.valid


def test_the_limits_themselves_are_allowed() -> None:
    assert SolveOptions(turn_limit_deg=45.0).turn_limit_deg == 45.0
    assert SolveOptions(quasi_stable_fraction=0.0).quasi_stable_fraction == 0.0
    assert SolveOptions(quasi_stable_fraction=1.0).quasi_stable_fraction == 1.0


def test_a_turn_ends_at_its_limit() -> None:
    free = solve_pose(PAIR, *THREE_CONTACTS_DEG)
    assert free.lambda_deg is not None
    assert free.mu_deg is not None
    assert free.lambda_deg < 2.0 < free.mu_deg
    short = solve_pose(PAIR, *THREE_CONTACTS_DEG, SolveOptions(turn_limit_deg=2.0))
    assert short.flags == (Flag.NO_THIRD,)
    assert short.lambda_deg == pytest.approx(free.lambda_deg, abs=ROUND_OFF_DEG)
    assert (short.mu_deg, len(short.contacts)) == (None, 2)
    shorter = solve_pose(PAIR, *THREE_CONTACTS_DEG, SolveOptions(turn_limit_deg=1.0))
    assert shorter.flags == (Flag.NO_SECOND, Flag.NO_THIRD)
    assert (shorter.lambda_deg, len(shorter.contacts)) == (None, 1)
    assert {short.state_class, shorter.state_class} == {StateClass.UNSTABLE_TWO_POINT}


def test_the_quasi_stable_fraction_moves_its_threshold() -> None:
    state = solve_pose(PAIR, *THREE_CONTACTS_DEG)
    assert state.pivot_offset is not None
    fraction = state.pivot_offset / (PAIR.nominal_diameter / 2)
    for share, expected in ((0.99, StateClass.STABLE_THREE_POINT), (1.01, StateClass.QUASI_STABLE_TWO_POINT)):
        options = SolveOptions(quasi_stable_fraction=share * fraction)
        assert solve_pose(PAIR, *THREE_CONTACTS_DEG, options).state_class is expected


@pytest.mark.parametrize(
    ("pose", "name"),
    [
        ((10.0000001, 0.0, 0.0), "roll"),
        ((-11.0, 0.0, 0.0), "roll"),
        ((math.nan, 0.0, 0.0), "roll"),
        ((0.0, 10.1, 0.0), "pitch"),
        ((0.0, math.inf, 0.0), "pitch"),
        ((0.0, 0.0, math.nan), "phase"),
        ((0.0, 0.0, -math.inf), "phase"),
    ],
)
def test_a_pose_out_of_range_names_its_angle_and_value(pose: tuple[float, float, float], name: str) -> None:
    with pytest.raises(InvalidValueError, match=name) as error:
        solve_poses(PAIR, [THREE_CONTACTS_DEG, pose])
    assert error.value.name == name
    assert str(pose[("roll", "pitch", "phase").index(name)]) in str(error.value)


def test_the_largest_tilts_are_allowed() -> None:
    for roll, pitch in ((10.0, 10.0), (-10.0, 10.0), (10.0, -10.0), (-10.0, -10.0)):
        assert solve_pose(PAIR, roll, pitch, 100.0).contacts


@pytest.mark.parametrize("poses", [[(1.0, 2.0)], [1.0, 2.0], [[[1.0, 2.0, 3.0]]]])
def test_poses_of_another_shape_are_refused(poses: list[object]) -> None:
    with pytest.raises(InvalidValueError, match="poses"):
        solve_poses(PAIR, poses)  # type: ignore[arg-type]


def test_no_poses_have_no_states() -> None:
    assert solve_poses(PAIR, []) == []
