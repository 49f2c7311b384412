from __future__ import annotations

import numpy as np
import pytest

from tests.mesh.pairs import UNC
from threadstate.mesh.clusters import Connectivity, connected
from threadstate.mesh.collision import Collider
from threadstate.mesh.frames import apply, fixed_from_bolt
from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Preset
from threadstate.mesh.segments import Intersection
from threadstate.mesh.solid import Ints, Solid
from threadstate.mesh.touch import NoContactPointError, cluster_segments, touch
from threadstate.thread.pair import Part


def row_of_triangles(count: int) -> Solid:
    """Triangles (k, k + 1, k + 2): neighbours share two vertices, the next but one share one, others none."""
    triangles = np.array([[k, k + 1, k + 2] for k in range(count)])
    vertices = np.array([[k, k % 2, 0.0] for k in range(count + 2)], dtype=np.float64)
    return Solid(vertices, triangles, np.zeros(count, dtype=np.int8), np.arange(3))


ROWS = Connectivity(row_of_triangles(40), row_of_triangles(40))


def groups(pairs: list[tuple[int, int]]) -> list[list[tuple[int, ...]]]:
    found = ROWS.clusters(np.array(pairs, dtype=np.int64).reshape(-1, 2))
    return [[tuple(pair) for pair in cluster.pairs.tolist()] for cluster in found]


def test_pairs_are_connected_where_both_triangles_are() -> None:
    assert groups([]) == []
    assert groups([(0, 0), (1, 1), (2, 2)]) == [[(0, 0), (1, 1), (2, 2)]]
    assert groups([(0, 0), (20, 20)]) == [[(0, 0)], [(20, 20)]]
    assert groups([(0, 0), (0, 20)]) == [[(0, 0)], [(0, 20)]], "the same bolt triangle at two places of the nut"
    assert groups([(0, 0), (2, 2), (5, 5)]) == [[(0, 0), (2, 2)], [(5, 5)]]
    assert groups([(0, 0), (20, 20), (2, 0), (21, 20), (4, 0)]) == [[(0, 0), (2, 0), (4, 0)], [(20, 20), (21, 20)]]


def one(pairs: list[tuple[int, int]]) -> Ints:
    return np.array(pairs, dtype=np.int64)


def test_what_lies_about_a_contact() -> None:
    (at,) = ROWS.clusters(one([(10, 10)]))
    own, ring = ROWS.neighbourhood(at), ROWS.neighbourhood(at, rings=1)
    for k, in_own, in_ring in (
        (10, True, True),
        (12, True, True),
        (13, False, True),
        (14, False, True),
        (15, False, False),
    ):
        (cluster,) = ROWS.clusters(one([(k, k)]))
        assert ROWS.reaches(cluster, own) == in_own
        assert ROWS.reaches(cluster, ring) == in_ring
        assert connected(cluster, at) == in_own
    (aside,) = ROWS.clusters(one([(10, 30)]))
    assert not ROWS.reaches(aside, ring)
    assert not connected(aside, at)


BOLT, NUT = (part_solid(UNC, part, Preset.PAPER.tessellation) for part in Part)
DEEP = fixed_from_bolt(np.radians(4.0), 0.0, np.radians(185.0), [0.0, 0.0, 0.002])


def test_pairs_of_the_collision_meet_in_segments() -> None:
    """The numbers that the library gives are those of the triangles, in this order."""
    (cluster,) = Connectivity(BOLT, NUT).clusters(Collider(BOLT, NUT).pairs(DEEP))
    kinds = cluster_segments(cluster, BOLT, NUT, DEEP).types
    meeting = np.isin(kinds, (Intersection.I, Intersection.II, Intersection.III))
    assert len(kinds) > 100
    assert meeting.mean() > 0.95


def test_collision_distance_and_pairs_agree() -> None:
    collider = Collider(BOLT, NUT)
    apart = fixed_from_bolt(np.radians(4.0), 0.0, np.radians(185.0), [0.0, 0.0, 0.02])
    lowest = apply(apart, BOLT.vertices)[:, 2].min()
    assert not collider.collides(apart)
    assert collider.pairs(apart).shape == (0, 2)
    assert collider.distance(apart) == pytest.approx(lowest, abs=1e-12)
    assert collider.collides(DEEP)
    assert collider.distance(DEEP) == 0.0


def test_coplanar_faces_are_no_contact() -> None:
    level = np.eye(4)
    base = np.flatnonzero(BOLT.faces == 1)
    surface = np.flatnonzero(NUT.faces == 1)
    pairs = np.array([(base[0], surface[0])])
    (cluster,) = Connectivity(BOLT, NUT).clusters(pairs)
    with pytest.raises(NoContactPointError, match="is not a contact of the method"):
        touch(cluster, BOLT, NUT, level)
