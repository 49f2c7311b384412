"""The convex hull of points of a plane, against NumPy's order and all triples of points."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact._hull_kernel import convex_hull, set_order

Floats = NDArray[np.float64]

COUNTS = (0, 1, 2, 3, 7, 40)


def some_points(count: int, seed: int) -> Floats:
    """Points of a coarse grid, many of them equal in x or the same, each with its number as a third column."""
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.integers(-3, 4, (count, 2)), np.arange(count)]).astype(np.float64)


def corners_of(points: Floats) -> set[tuple[float, float]]:
    """The points that no triangle or segment of others has in it."""
    distinct = [(x, y) for x, y in np.unique(points[:, :2], axis=0).tolist()]

    def holds(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float], p: tuple[float, float]) -> bool:
        turns = [(q[0] - o[0]) * (p[1] - o[1]) - (q[1] - o[1]) * (p[0] - o[0]) for o, q in ((a, b), (b, c), (c, a))]
        beyond = any(not min(a[i], b[i], c[i]) <= p[i] <= max(a[i], b[i], c[i]) for i in range(2))
        return not beyond and (min(turns) >= 0.0 or max(turns) <= 0.0)

    def is_corner(point: tuple[float, float]) -> bool:
        others = [other for other in distinct if other != point]
        return not any(holds(a, b, c, point) for a, b, c in [*combinations(others, 3), *((a, a, a) for a in others)])

    return {point for point in distinct if is_corner(point)}


@pytest.mark.parametrize("count", COUNTS)
def test_points_are_ordered_by_x_then_y_then_as_given(count: int) -> None:
    points = some_points(count, count)
    order = np.empty(count, dtype=np.int64)
    set_order(count, points, order)
    assert np.array_equal(order, np.lexsort((points[:, 1], points[:, 0])))


@pytest.mark.parametrize("seed", range(8))
def test_the_hull_has_the_corners_and_runs_counter_clockwise(seed: int) -> None:
    points = some_points(12, 100 + seed)
    hull = np.full((len(points) + 1, 3), np.nan)
    corners = hull[: convex_hull(points, len(points), hull)]
    assert {(x, y) for x, y, _ in corners.tolist()} == corners_of(points)
    following, last = np.roll(corners, -1, axis=0), np.roll(corners, -2, axis=0)
    ahead, after = following[:, :2] - corners[:, :2], last[:, :2] - following[:, :2]
    assert (ahead[:, 0] * after[:, 1] > ahead[:, 1] * after[:, 0]).all()
    assert np.array_equal(points[corners[:, 2].astype(int)], corners)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_of_less_than_three_points_the_hull_is_these(count: int) -> None:
    points = np.array([[1.0, 2.0], [0.0, 5.0]])
    hull = np.full((3, 2), np.nan)
    assert convex_hull(points, count, hull) == count
    assert np.array_equal(np.unique(hull[:count], axis=0), np.unique(points[:count], axis=0))
