from __future__ import annotations

import numpy as np
import pytest

from oracle.pose import turn_about
from threadstate.mesh.pivot import origin_moment, sense_by_moment, sense_by_quadrants
from threadstate.mesh.solid import Floats

RNG = np.random.default_rng(63)


def random_axis() -> tuple[Floats, Floats]:
    azimuths, radii = RNG.uniform(0.0, 2.0 * np.pi, 2), RNG.uniform(0.09, 0.125, 2)
    x, y = radii * np.cos(azimuths), radii * np.sin(azimuths)
    return np.array([x[0], y[0], 0.0]), np.array([x[1], y[1], 0.0])


def test_the_moment_says_which_way_the_origin_sinks() -> None:
    for _ in range(200):
        cp0, cp1 = random_axis()
        origin = RNG.normal(scale=1e-3, size=3)
        sense = sense_by_moment(cp0, cp1, origin)
        after = cp0 + turn_about(cp1 - cp0, sense * 0.01) @ (origin - cp0)
        assert after[2] < origin[2] or abs(origin_moment(cp0, cp1, origin)) < 1e-5


def test_an_origin_over_the_axis_is_balanced() -> None:
    assert sense_by_moment([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.3, 0.0, 0.2]) == 0


def test_the_quadrants_agree_with_the_moment_unless_the_axis_passes_between_nut_axis_and_origin() -> None:
    differing = 0
    for _ in range(2000):
        cp0, cp1 = random_axis()
        origin = np.array([*RNG.normal(scale=2e-2, size=2), RNG.normal(scale=2e-3)])
        along = (cp1 - cp0)[:2]
        sides = [along[0] * (o[1] - cp0[1]) - along[1] * (o[0] - cp0[0]) for o in (np.zeros(2), origin[:2])]
        between = sides[0] * sides[1] < 0.0
        assert (sense_by_quadrants(cp0, cp1) != sense_by_moment(cp0, cp1, origin)) == between
        differing += between
    assert 50 < differing < 1000


@pytest.mark.parametrize(
    ("cp0", "cp1"), [([-0.1, 0.05, 0.0], [0.1, 0.05, 0.0]), ([0.1, -0.05, 0.0], [-0.1, -0.05, 0.001])]
)
def test_the_quadrants_say_nothing_of_an_axis_without_intercept(cp0: list[float], cp1: list[float]) -> None:
    assert sense_by_quadrants(cp0, cp1) == 0
    assert sense_by_moment(cp0, cp1, np.zeros(3)) != 0
