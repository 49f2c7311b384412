from __future__ import annotations

import numpy as np
import pytest

from threadstate.mesh.segments import Intersection, intersection_segments
from threadstate.mesh.solid import Floats

BOLT = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]])
"""In the plane z = 0; along y = -0.5 it reaches from x = -0.75 to 0.75."""


def standing(low: float, high: float, top: float = 1.0) -> Floats:
    """A triangle in the plane y = -0.5 that meets z = 0 from x = ``low`` to ``high``."""
    middle = 0.5 * (low + high)
    return np.array(
        [[2.0 * low - middle, -0.5, -1.0 * top], [2.0 * high - middle, -0.5, -1.0 * top], [middle, -0.5, 1.0 * top]]
    )


CASES = [
    (standing(0.5, 1.5), Intersection.I, 0.5, 0.75),
    (standing(-2.0, -0.25), Intersection.I, -0.75, -0.25),
    (standing(-0.25, 0.5), Intersection.II, -0.25, 0.5),
    (standing(-2.0, 3.0), Intersection.III, -0.75, 0.75),
    (standing(1.0, 2.0), Intersection.IV, -0.75, 0.75),
]


@pytest.mark.parametrize(("nut", "kind", "low", "high"), CASES)
def test_types_and_ends(nut: Floats, kind: Intersection, low: float, high: float) -> None:
    for bolt_order in ([0, 1, 2], [2, 0, 1], [1, 0, 2]):
        for nut_order in ([0, 1, 2], [1, 2, 0], [2, 1, 0]):
            segments = intersection_segments(BOLT[None, bolt_order], nut[None, nut_order])
            assert segments.types.tolist() == [kind]
            ends = sorted([segments.starts[0].tolist(), segments.ends[0].tolist()])
            assert ends == [pytest.approx([low, -0.5, 0.0]), pytest.approx([high, -0.5, 0.0])]
            assert segments.midpoints[0] == pytest.approx([0.5 * (low + high), -0.5, 0.0])


def test_type_v_is_a_triangle_that_does_not_reach_the_line() -> None:
    above = standing(-0.2, 0.2) + np.array([0.0, 0.0, 2.0])
    segments = intersection_segments(BOLT[None], above[None])
    assert segments.types.tolist() == [Intersection.V]
    assert sorted([segments.starts[0, 0], segments.ends[0, 0]]) == pytest.approx([-0.75, 0.75])
    turned = intersection_segments(above[None], BOLT[None])
    assert turned.types.tolist() == [Intersection.V]
    assert np.isnan(turned.midpoints).all()


@pytest.mark.parametrize("shift", [0.0, 0.1])
def test_type_v_is_also_of_planes_without_a_line(shift: float) -> None:
    segments = intersection_segments(BOLT[None], BOLT[None] + [0.1, 0.0, shift])
    assert segments.types.tolist() == [Intersection.V]
    assert np.isnan(segments.midpoints).all()


def inside(points: Floats, triangles: Floats) -> Floats:
    """The least barycentric coordinate of points that lie in the triangles' planes."""
    a, b, c = (triangles[:, k] for k in range(3))
    normal = np.cross(b - a, c - a)
    size = np.einsum("ij,ij->i", normal, normal)
    parts = [np.einsum("ij,ij->i", np.cross(q - p, points - p), normal) / size for p, q in ((a, b), (b, c), (c, a))]
    return np.asarray(np.min(parts, axis=0))


def test_segments_of_random_triangles_lie_in_both_and_end_on_their_sides() -> None:
    rng = np.random.default_rng(11)
    bolt, nut = rng.normal(size=(2, 4000, 3, 3))
    segments = intersection_segments(bolt, nut)
    true = np.isin(segments.types, (Intersection.I, Intersection.II, Intersection.III))
    assert [np.count_nonzero(segments.types == kind) > 100 for kind in Intersection] == [True] * 5
    for points in (segments.starts, segments.ends):
        in_bolt, in_nut = inside(points[true], bolt[true]), inside(points[true], nut[true])
        assert min(in_bolt.min(), in_nut.min()) > -1e-9
        assert np.minimum(in_bolt, in_nut).max() < 1e-9
    assert np.all(
        np.minimum(inside(segments.midpoints[true], bolt[true]), inside(segments.midpoints[true], nut[true])) > -1e-12
    )
