"""What scenes leave out, and that contacts do not miss it."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from tests.mesh.pairs import PAIRS, UNC
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.edge_curve import EdgeCurve
from threadstate.mesh.edge_zone import ZONE
from threadstate.mesh.frames import fixed_from_bolt, inverse, trans
from threadstate.mesh.options import Descent, MeshOptions, Scene
from threadstate.mesh.part import cut_inradius
from threadstate.mesh.presets import Preset, Tessellation
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solid import Face, Floats, Ints, Solid, deviation
from threadstate.mesh.solve import mesh_procedure, solve_poses_by_mesh
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_pose
from threadstate.thread.pair import Pair, Part
from threadstate.thread.profile import Profile

pytestmark = pytest.mark.slow

PAPER, MEDIUM, FINE = (preset.tessellation for preset in (Preset.PAPER, Preset.MEDIUM, Preset.FINE))
OPEN = (Scene.BAND, Scene.EDGES)
MICROINCH = 1e-6

POSES = ((1.0, -2.0, 10.0), (0.0, 3.0, 250.0), (-4.0, 0.0, 131.0), (4.0, 0.0, 185.0))
"""Three that the method's check values name, on surface, edge and thread, and one that comes to lie flush."""


def profile_of(pair: Pair, part: Part) -> Profile:
    return pair.bolt if part is Part.BOLT else pair.nut


def triangle_sides(solid: Solid) -> Ints:
    """Directed, (3 m, 2)."""
    return np.vstack([solid.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])


def open_sides(solid: Solid) -> Ints:
    sides = np.sort(triangle_sides(solid), axis=1)
    unique, uses = np.unique(sides, axis=0, return_counts=True)
    assert set(uses) == {1, 2}
    return unique[uses == 1]


@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize("scene", OPEN)
@pytest.mark.parametrize("preset", [Preset.COARSE, Preset.PAPER])
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_open_scenes_are_open_at_the_far_rim_and_at_the_walls_alone(
    pair: Pair, preset: Preset, scene: Scene, part: Part
) -> None:
    solid = scene_part(pair, part, preset.tessellation, scene)
    _, uses = np.unique(triangle_sides(solid), axis=0, return_counts=True)
    assert uses.max() == 1, "two triangles are turned against each other"
    rim = solid.vertices[np.unique(open_sides(solid))]
    far = np.isclose(np.abs(rim[:, 2]), pair.thread_pitch)
    walls = np.isclose(np.hypot(rim[:, 0], rim[:, 1]), cut_inradius(pair, part) / math.cos(math.pi / 16))
    assert np.all(far ^ walls)
    assert far.any()
    assert np.count_nonzero(walls) == 16
    depth = np.abs(solid.vertices[:, 2])[solid.triangles].max(axis=1)
    at_rim = depth > (1.0 - 1e-9) * pair.thread_pitch
    assert np.all(solid.faces[at_rim] == Face.FAR_END)
    assert not at_rim[solid.faces != Face.FAR_END].any()


@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize("scene", OPEN)
@pytest.mark.parametrize("pair", PAIRS[:3], ids=lambda pair: pair.designation)
def test_faces_look_outward_and_the_edge_is_that_of_the_solid(pair: Pair, scene: Scene, part: Part) -> None:
    solid, whole = scene_part(pair, part, PAPER, scene), scene_part(pair, part, PAPER, Scene.FULL)
    corners = solid.vertices[solid.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    radial = np.einsum("ij,ij->i", normals[:, :2], corners.mean(axis=1)[:, :2])
    outward = 1.0 if part is Part.BOLT else -1.0
    cut = solid.faces == Face.CUT
    assert np.all(radial[~cut] * outward > 0.0)
    assert np.all(normals[cut, 2] * outward < 0.0)
    edge = solid.vertices[solid.edge]
    assert set(edge[:, 2]) == {0.0}
    azimuths = np.arctan2(edge[:, 1], edge[:, 0]) % (2.0 * math.pi)
    assert np.all(np.diff(azimuths) > 0.0)
    same = scene_part(pair, part, PAPER, Scene.CURVES)
    assert same.vertices == pytest.approx(whole.vertices[whole.edge], abs=1e-14 * profile_of(pair, part).major_diameter)
    assert len(same.triangles) == 0
    profile = profile_of(pair, part)
    assert deviation(solid, profile).edge == pytest.approx(deviation(whole, profile).edge, rel=0.05)


@pytest.mark.parametrize("part", Part)
def test_beside_the_edge_triangles_are_as_fine_as_the_solids_and_beyond_coarser(part: Part) -> None:
    profile, p = profile_of(UNC, part), UNC.thread_pitch
    solid = scene_part(UNC, part, PAPER, Scene.EDGES)
    heights = np.abs(solid.vertices[solid.triangles][:, :, 2])
    chord = PAPER.chord_height * p
    near = solid.faces == Face.THREAD
    near &= heights.max(axis=1) <= ZONE * p * (1.0 + 1e-9)
    for chosen, least, most in ((near, 0.2 * chord, chord), (~near, 2.0 * chord, 15.0 * chord)):
        chosen_solid = Solid(solid.vertices, solid.triangles[chosen], solid.faces[chosen].copy(), solid.edge)
        assert least < deviation(chosen_solid, profile).surface < most
    assert len(solid.triangles) < 0.5 * len(scene_part(UNC, part, PAPER, Scene.FULL).triangles)


@cache
def states_of_full_solids() -> list[ContactState]:
    return solve_poses_by_mesh(UNC, POSES, MeshOptions(MEDIUM, checked=False))


@pytest.mark.parametrize("scene", [*OPEN, Scene.CURVES])
def test_contacts_are_those_of_the_full_solids(scene: Scene) -> None:
    full = states_of_full_solids()
    found = solve_poses_by_mesh(UNC, POSES, MeshOptions(MEDIUM, scene=scene, checked=False))
    segment = 3e-3
    for one, other in zip(full, found, strict=True):
        assert (other.state_class, other.flags) == (one.state_class, one.flags)
        assert [contact.features for contact in other.contacts] == [contact.features for contact in one.contacts]
        # Extreme points of a patch are as near as a segment, or a wide shallow corner, lets them be.
        near = 5.0 * segment if one.flags else segment
        for a, b in zip(one.contacts, other.contacts, strict=True):
            assert math.dist(a.point, b.point) < near
        assert other.poses[0].translation[2] == pytest.approx(one.poses[0].translation[2], abs=2e-5)
        assert other.lambda_deg == pytest.approx(one.lambda_deg, abs=0.02)


def test_curves_come_nearer_to_the_exact_method_with_finer_polygons() -> None:
    for pose in POSES[1:3]:
        exact = solve_pose(UNC, *pose)
        errors = []
        for chord in (2e-3, 1e-4, 1e-5):
            options = MeshOptions(Tessellation(chord, 0.5), final_step=1e-7, scene=Scene.CURVES, checked=False)
            (state,) = solve_poses_by_mesh(UNC, [pose], options)
            assert state.state_class is exact.state_class
            errors.append(abs(state.poses[0].translation[2] - exact.poses[0].translation[2]))
            assert errors[-1] < mesh_procedure(UNC, options).edge_deviation + 1e-7 * UNC.thread_pitch
            assert state.lambda_deg == pytest.approx(exact.lambda_deg, abs=30.0 * chord)
            assert state.mu_deg == pytest.approx(exact.mu_deg, abs=30.0 * chord)
        assert errors[-1] < 1e-7


def test_curves_do_not_see_thread_meet_thread() -> None:
    pose = (4.0, 2.0, 345.0)
    exact = solve_pose(UNC, *pose)
    (state,) = solve_poses_by_mesh(UNC, [pose], MeshOptions(FINE, scene=Scene.CURVES, checked=False))
    assert exact.contacts[1].features.value == "thread-thread"
    assert state.poses[0].translation[2] == pytest.approx(exact.poses[0].translation[2], abs=5e-6)
    assert state.lambda_deg is not None
    assert exact.lambda_deg is not None
    assert state.lambda_deg > exact.lambda_deg + 1.0


def test_curves_march_down_and_their_decades_tunnel() -> None:
    pose = (0.0, -4.0, 350.0)
    exact_inch = solve_pose(UNC, *pose).poses[0].translation[2]
    for descent, least, most in ((Descent.SAFE, -3e-6, 1e-9), (Descent.DECADES, -0.02, -0.01)):
        found, clusters = mesh_procedure(UNC, MeshOptions(FINE, descent, scene=Scene.CURVES)).first_pose(pose)
        assert clusters == ()
        assert least < found[2, 3] - exact_inch < most


def test_curves_say_when_contacts_are_too_near_each_other() -> None:
    with pytest.raises(MeshUndecidedError, match="within two sides of an earlier one"):
        solve_poses_by_mesh(UNC, [(-3.0, 1.0, 73.0)], MeshOptions(PAPER, scene=Scene.CURVES, checked=False))


def curves() -> tuple[EdgeCurve, EdgeCurve]:
    bolt, nut = (scene_part(UNC, part, PAPER, Scene.CURVES) for part in Part)
    return EdgeCurve(bolt, UNC.bolt, -1.0), EdgeCurve(nut, UNC.nut, 1.0)


def runs_by_sampling(curve: EdgeCurve, other: EdgeCurve, T_other_own: Floats, sign: float) -> float:
    """The share of points of a curve, twenty a side, that are inside the other part."""
    places = np.arange(0.025, curve.sides, 0.05)
    points = np.array([curve.point(float(place)) for place in places]) @ T_other_own[:3, :3].T + T_other_own[:3, 3]
    inside = [sign * point[2] > 0.0 and other.thread_depth(point) > 0.0 for point in points]
    return float(np.mean(inside))


@pytest.mark.parametrize("height", [0.008, 0.004, -0.003])
def test_runs_are_where_points_of_the_edge_are_inside(height: float) -> None:
    bolt, nut = curves()
    T = trans([0.0, 0.0, height]) @ fixed_from_bolt(
        math.radians(4.0), math.radians(-1.0), math.radians(40.0), np.zeros(3)
    )
    for curve, other, T_other_own, sign in ((bolt, nut, T, -1.0), (nut, bolt, inverse(T), 1.0)):
        runs = curve.runs_inside(other, T_other_own)
        share = (runs[:, 1] - runs[:, 0]).sum() / curve.sides
        assert share == pytest.approx(runs_by_sampling(curve, other, T_other_own, sign), abs=4e-3)
        assert np.all(runs[:, 1] > runs[:, 0])


def test_places_wrap_around() -> None:
    bolt, _ = curves()
    assert bolt.point(0.25) == pytest.approx(bolt.point(bolt.sides + 0.25), abs=1e-15)
    assert bolt.near(np.array([0.2, 0.4]), np.array([[bolt.sides - 0.5, bolt.sides - 0.1]]), 0.5)
    assert not bolt.near(np.array([2.0, 3.0]), np.array([[bolt.sides - 0.5, bolt.sides + 0.5]]), 1.0)
    assert not bolt.near(np.array([2.0, 3.0]), np.empty((0, 2)), 1.0)
