"""Bolts with a chamfer as meshes, beside the brute force of oracle.chamfer."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from oracle.chamfer import chamfered_height
from tests.mesh.pairs import LEFT_OF_TWO_STARTS, M6, SHARP, UNC
from threadstate.errors import InvalidValueError, MeshUndecidedError
from threadstate.mesh.chamfer_deviation import chamfered_deviation
from threadstate.mesh.export import glb_by_face, mesh_report
from threadstate.mesh.options import MeshOptions, Scene
from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solid import Face
from threadstate.mesh.solve import mesh_procedure, solve_poses_by_mesh
from threadstate.state.model import FeaturePair
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.pair import Pair, Part
from threadstate.thread.regions import Region

PAPER, MEDIUM = Preset.PAPER.tessellation, Preset.MEDIUM.tessellation


def with_end(pair: Pair, share: float, angle_deg: float = 45.0) -> Pair:
    """The pair with a chamfer at that share of the way from the major to the minor diameter."""
    major, minor = pair.fit.bolt_major_diameter, pair.fit.bolt_minor_diameter
    return replace(pair, chamfer=Chamfer(major - share * (major - minor), angle_deg))


SHAPES = [
    with_end(UNC, 1.1),
    with_end(UNC, 0.4),
    with_end(UNC, 1.2, 30.0),
    with_end(M6, 1.1, 60.0),
    with_end(SHARP, 0.8),
    with_end(LEFT_OF_TWO_STARTS, 1.1),
]


def beyond(points: np.ndarray, pair: Pair) -> tuple[np.ndarray, np.ndarray]:
    """How far points are beyond the thread and beyond the cone, along the radius."""
    assert pair.chamfer is not None
    r = np.hypot(points[:, 0], points[:, 1])
    s = points[:, 2] - pair.bolt.lead * np.arctan2(points[:, 1], points[:, 0]) / (2.0 * math.pi)
    cone = pair.chamfer.end_diameter / 2.0 + points[:, 2] / math.tan(math.radians(pair.chamfer.angle_deg))
    return r - np.array([pair.bolt.radius(float(v)) for v in s]), r - cone


@pytest.mark.parametrize("pair", SHAPES, ids=range(len(SHAPES)))
def test_vertices_lie_on_thread_and_cone_and_those_of_their_edge_on_both(pair: Pair) -> None:
    solid = part_solid(pair, Part.BOLT, PAPER)
    least = 1e-12 * pair.thread_pitch
    of_thread, of_cone = (np.unique(solid.triangles[solid.faces == face]) for face in (Face.THREAD, Face.CHAMFER))
    assert np.abs(beyond(solid.vertices[of_thread], pair)[0]).max() < least
    assert beyond(solid.vertices[of_thread], pair)[1].max() < least
    assert np.abs(beyond(solid.vertices[of_cone], pair)[1]).max() < least
    assert beyond(solid.vertices[of_cone], pair)[0].max() < least
    both = np.intersect1d(of_thread, of_cone)
    assert len(both) > 100
    outline = solid.vertices[solid.edge]
    assert set(outline[:, 2]) == {0.0}
    assert np.maximum(*beyond(outline, pair)) == pytest.approx(np.zeros(len(outline)), abs=least)
    azimuths = np.unwrap(np.arctan2(outline[:, 1], outline[:, 0]))
    assert (np.diff(azimuths) > 0.0).all()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pair", "preset"),
    [
        *itertools.product(SHAPES, [Preset.COARSE, Preset.PAPER]),
        *itertools.product(SHAPES[1:3], [Preset.MEDIUM]),
    ],
)
def test_solids_are_closed_and_within_the_chord_height(pair: Pair, preset: Preset) -> None:
    chord = preset.tessellation.chord_height * pair.thread_pitch
    for part in Part:
        report = mesh_report(pair, part, preset.tessellation)
        assert report.watertight
        assert 0.2 * chord < report.chord_deviation < chord
        assert 0.2 * chord < report.edge_deviation < chord
    flat = mesh_report(replace(pair, chamfer=None), Part.BOLT, preset.tessellation)
    assert mesh_report(pair, Part.NUT, preset.tessellation).volume > flat.volume


def test_the_cone_is_cut_off_the_flat_bolts_volume() -> None:
    """Of a bolt whose thread is as shallow as a mesh allows the cut is a ring: a cylinder less a cone's frustum."""
    r, e, p = 0.1245, 0.11, UNC.thread_pitch
    fit = replace(
        UNC.fit,
        bolt_major_diameter=2.0 * r,
        bolt_pitch_diameter=2.0 * r - 1e-5,
        bolt_minor_diameter=2.0 * r - 2e-5,
        nut_pitch_diameter=0.2499,
        nut_minor_diameter=0.2498,
    )
    shallow = replace(UNC, form=replace(SHARP.form, nut_crest_fillet=0.0), fit=fit)
    cut = replace(shallow, chamfer=Chamfer(2.0 * e))
    height = r - e
    removed = math.pi * (r * r * height - height / 3.0 * (r * r + r * e + e * e))
    solid = mesh_report(cut, Part.BOLT, Preset.MEDIUM.tessellation).volume
    whole = mesh_report(shallow, Part.BOLT, Preset.MEDIUM.tessellation).volume
    pitches = 1 + math.ceil(height / p)
    assert pitches * whole - solid == pytest.approx(removed, rel=1e-2)


@pytest.mark.parametrize("pair", [UNC, M6], ids=lambda pair: pair.designation)
def test_a_chamfer_that_removes_nothing_leaves_the_flat_bolt(pair: Pair) -> None:
    nothing = with_end(pair, 0.0)
    for part in Part:
        flat, same = part_solid(pair, part, PAPER), part_solid(nothing, part, PAPER)
        for name in ("vertices", "triangles", "faces", "edge"):
            assert np.array_equal(getattr(flat, name), getattr(same, name)), name
    poses = [(-4.0, 0.0, 131.0), (0.0, 3.0, 250.0)]
    options = MeshOptions(PAPER, checked=False)
    assert [one.contacts for one in solve_poses_by_mesh(nothing, poses, options)] == [
        one.contacts for one in solve_poses_by_mesh(pair, poses, options)
    ]


@pytest.mark.slow
@pytest.mark.parametrize("pair", [with_end(UNC, 1.1), with_end(UNC, 0.5), with_end(M6, 1.1, 60.0)], ids=range(3))
def test_first_heights_are_those_of_the_brute_force(pair: Pair) -> None:
    options = MeshOptions(MEDIUM, checked=False)
    procedure = mesh_procedure(pair, options)
    deviations = sum(
        chamfered_deviation(part_solid(pair, part, MEDIUM), profile, chamfer).edge
        for part, profile, chamfer in ((Part.BOLT, pair.bolt, pair.chamfer), (Part.NUT, pair.nut, None))
    )
    # A steep face lets the bolt down by more than its own deviation: a cone of 60 deg by 1.73 times.
    least = 2.0 * deviations + options.final_step * pair.thread_pitch
    rng = np.random.default_rng(28)
    kinds = set()
    for _ in range(10):
        roll, pitch, phase = rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0]).round(2).tolist()
        expected = chamfered_height(pair, roll, pitch, phase)
        kinds.add(expected.bolt)
        first, _ = procedure.first_pose((roll, pitch, phase))
        assert first[2, 3] == pytest.approx(expected.height, abs=least), (roll, pitch, phase)
    assert len(kinds & {"cone", "rim", "thread", "outline"}) >= 2


FEATURES = {
    ("cone", "edge"): FeaturePair.THREAD_EDGE,
    ("rim", "edge"): FeaturePair.THREAD_EDGE,
    ("thread", "edge"): FeaturePair.THREAD_EDGE,
    ("cone", "thread"): FeaturePair.THREAD_THREAD,
    ("rim", "thread"): FeaturePair.THREAD_THREAD,
    ("thread", "thread"): FeaturePair.THREAD_THREAD,
    ("rim", "surface"): FeaturePair.THREAD_SURFACE,
    ("outline", "edge"): FeaturePair.EDGE_EDGE,
    ("outline", "surface"): FeaturePair.EDGE_SURFACE,
    ("outline", "thread"): FeaturePair.EDGE_THREAD,
    ("base", "edge"): FeaturePair.BASE_EDGE,
}


@pytest.mark.slow
@pytest.mark.parametrize("share", [1.1, 0.5])
def test_states_have_three_stages_and_name_the_cone(share: float) -> None:
    pair = with_end(UNC, share)
    assert pair.chamfer is not None
    options = MeshOptions(MEDIUM, checked=False)
    segment = mesh_procedure(pair, options).segment
    rng = np.random.default_rng(5)
    solved, agreed, on_cone = 0, 0, 0
    for _ in range(12):
        pose = tuple(rng.uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0]).round(2).tolist())
        try:
            (state,) = solve_poses_by_mesh(pair, [pose], options)
        except MeshUndecidedError:
            continue
        solved += 1
        first = chamfered_height(pair, *pose)
        agreed += state.contacts[0].features is FEATURES[first.bolt, first.nut]
        assert math.dist(state.contacts[0].point, first.point) < 3.0 * segment or len(state.contacts) > 3
        for contact in state.contacts:
            assert np.linalg.norm(contact.normal) == pytest.approx(1.0, rel=1e-12)
            assert contact.bolt_margin >= 0.0
            of_thread, of_cone = (float(v[0]) for v in beyond(np.array([contact.point_bolt]), pair))
            if contact.bolt_region is Region.CHAMFER:
                on_cone += 1
                assert abs(of_cone) < 0.01 * pair.thread_pitch
                assert of_thread < 0.01 * pair.thread_pitch
            elif contact.features is not FeaturePair.BASE_EDGE:
                assert abs(of_thread) < 0.01 * pair.thread_pitch
    # A turn with the cone on the nut's edge may part that contact in two: undecided, as beside any earlier contact.
    assert solved >= 6
    assert agreed >= solved - 1
    assert on_cone > 0


@pytest.mark.parametrize("scene", [Scene.EDGES, Scene.CURVES])
def test_scenes_without_a_cone_refuse_it(scene: Scene) -> None:
    pair = with_end(UNC, 1.1)
    with pytest.raises(InvalidValueError, match=f"scene is '{scene}'; valid: full or band of a pair whose bolt has a"):
        scene_part(pair, Part.BOLT, PAPER, scene)
    with pytest.raises(InvalidValueError, match="valid: full or band"):
        solve_poses_by_mesh(pair, [(1.0, 2.0, 3.0)], MeshOptions(PAPER, scene=scene))


def test_a_level_bolt_on_its_cone_is_undecided_by_name() -> None:
    with pytest.raises(MeshUndecidedError, match="a level bolt with a chamfer rests on an arc of its cone"):
        solve_poses_by_mesh(with_end(UNC, 1.1), [(0.0, 0.0, 90.0)], MeshOptions(PAPER, checked=False))


def test_a_file_has_the_cone_as_a_mesh_of_its_own() -> None:
    assert b"chamfer" in glb_by_face(part_solid(with_end(UNC, 1.1), Part.BOLT, PAPER))
    assert b"chamfer" not in glb_by_face(part_solid(UNC, Part.BOLT, PAPER))
