"""The sense of the third turn: which way about CP0 -> CP1 the insertion force turns the bolt (decision 4)."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import ArrayLike

from oracle.pose import turn_about
from threadstate.mesh.procedure import origin_moment
from threadstate.mesh.solid import Floats

RNG = np.random.default_rng(63)


def sense_by_moment(cp0: ArrayLike, cp1: ArrayLike, origin: ArrayLike) -> int:
    """+1 or -1: the sense in which the bolt's origin sinks; 0 where it lies over or under the axis (balanced)."""
    return -int(np.sign(origin_moment(cp0, cp1, origin)))


def sense_by_quadrants(cp0: ArrayLike, cp1: ArrayLike) -> int:
    """The sense by the paper's section 6.3: from the quadrants of the contacts, the intercept and the slope.

    Where the axis meets the X axis of the nut and which way it leads from there says on which side of it the **nut's**
    axis lies, taken for the bolt's origin; heights are ignored. It differs from the moment wherever the axis passes
    between the nut's axis and the bolt's origin, and says nothing (0) of an axis parallel to X, which has no intercept,
    or through the nut's axis.
    """
    (x0, y0), (x1, y1) = (np.asarray(point, dtype=np.float64)[:2] for point in (cp0, cp1))
    if y1 == y0:
        return 0
    intercept = x0 - y0 * (x1 - x0) / (y1 - y0)
    return -int(np.sign(intercept) * np.sign(y1 - y0))


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
