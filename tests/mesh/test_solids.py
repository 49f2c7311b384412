from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from scipy.integrate import quad
from scipy.optimize import minimize

from tests.mesh.pairs import FINE_PITCH, M6, PAIRS, UNC
from tests.thread.shapes import PROFILES
from threadstate.errors import InvalidValueError
from threadstate.mesh.end_face import SIDES
from threadstate.mesh.export import as_trimesh, mesh_report
from threadstate.mesh.part import BORE, WALL, part_solid
from threadstate.mesh.presets import LARGEST_CHORD, SMALLEST_CHORD, Preset, Tessellation
from threadstate.mesh.solid import Face, Floats, Solid, deviation
from threadstate.mesh.thread_surface import profile_cuts, thread_surface
from threadstate.thread.pair import Pair, Part
from threadstate.thread.profile import Profile

ROUGH = (Preset.COARSE, Preset.PAPER, Preset.MEDIUM)
PAPER = Preset.PAPER.tessellation


def profile_of(pair: Pair, part: Part) -> Profile:
    return pair.bolt if part is Part.BOLT else pair.nut


def thread_gaps(vertices: Floats, profile: Profile) -> Floats:
    """How far points are outside the true thread, along the radius."""
    s = vertices[:, 2] - profile.lead * np.arctan2(vertices[:, 1], vertices[:, 0]) / (2.0 * math.pi)
    return np.hypot(vertices[:, 0], vertices[:, 1]) - np.array([profile.radius(float(v)) for v in s])


def vertices_of(solid: Solid, face: Face) -> Floats:
    return solid.vertices[np.unique(solid.triangles[solid.faces == face])]


@pytest.mark.slow
@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize(
    ("pair", "preset"),
    [(pair, preset) for pair in PAIRS for preset in ROUGH if (pair, preset) != (FINE_PITCH, Preset.MEDIUM)],
    ids=lambda one: getattr(one, "designation", one),
)
def test_solids_are_closed_turned_outward_and_within_the_chord_height(pair: Pair, preset: Preset, part: Part) -> None:
    report = mesh_report(pair, part, preset.tessellation)
    chord = preset.tessellation.chord_height * pair.thread_pitch
    assert report.watertight
    assert report.volume > 0.0
    assert 0.2 * chord < report.chord_deviation < chord
    assert 0.2 * chord < report.edge_deviation < chord


@pytest.mark.slow
def test_presets_go_from_coarse_to_finest() -> None:
    reports = [mesh_report(UNC, Part.BOLT, preset.tessellation) for preset in Preset]
    assert all(report.watertight for report in reports)
    assert all(a.triangles < b.triangles for a, b in pairwise(reports))
    assert all(a.chord_deviation > b.chord_deviation for a, b in pairwise(reports))
    assert reports[-1].chord_deviation < Preset.FINEST.tessellation.chord_height * UNC.thread_pitch


def test_paper_is_the_chord_of_the_paper_on_its_thread() -> None:
    assert PAPER.chord_height * UNC.thread_pitch == pytest.approx(1e-4, rel=1e-15)
    assert PAPER.angle_control == 0.5


@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_vertices_lie_on_the_thread_and_on_the_planes(pair: Pair, part: Part) -> None:
    solid = part_solid(pair, part, PAPER)
    p = pair.thread_pitch
    low, high = (0.0, p) if part is Part.BOLT else (-p, 0.0)
    cut, far = (low, high) if part is Part.BOLT else (high, low)
    assert np.abs(thread_gaps(vertices_of(solid, Face.THREAD), profile_of(pair, part))).max() < 1e-12 * p
    assert set(vertices_of(solid, Face.CUT)[:, 2]) == {cut}
    assert set(vertices_of(solid, Face.FAR_END)[:, 2]) == {far}
    edge = solid.vertices[solid.edge]
    assert set(edge[:, 2]) == {cut}
    assert np.all(np.diff(np.arctan2(edge[:, 1], edge[:, 0]) % (2.0 * math.pi)) > 0.0)


def test_bolt_is_hollow_and_nut_cut_from_a_prism_of_16_sides() -> None:
    bolt, nut = (vertices_of(part_solid(UNC, part, PAPER), Face.WALL) for part in Part)
    assert len(bolt) == len(nut) == 2 * SIDES == 32
    assert np.hypot(bolt[:, 0], bolt[:, 1]).max() < UNC.fit.bolt_minor_diameter / 2
    assert np.hypot(nut[:, 0], nut[:, 1]).min() > UNC.fit.nut_major_diameter / 2


@pytest.mark.parametrize("part", Part)
@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_volumes_are_those_of_the_thread_and_the_prism(pair: Pair, part: Part) -> None:
    profile, p = profile_of(pair, part), pair.thread_pitch
    whole = quad(lambda s: math.pi * profile.radius(s) ** 2, 0.0, p, points=[p / 2, *profile.boundaries], limit=200)[0]
    inradius = BORE * pair.fit.bolt_minor_diameter / 2 if part is Part.BOLT else pair.fit.nut_major_diameter / 2
    inradius += 0.0 if part is Part.BOLT else WALL * p
    prism = SIDES * math.tan(math.pi / SIDES) * inradius**2 * p
    report = mesh_report(pair, part, PAPER)
    area = 3.0 * math.pi * profile.major_diameter * p
    assert report.volume == pytest.approx(abs(whole - prism), abs=area * report.chord_deviation)


@pytest.mark.parametrize("pair", [UNC, M6], ids=lambda pair: pair.designation)
def test_deviation_is_the_distance_to_the_nearest_point_of_the_surface(pair: Pair) -> None:
    profile, p = pair.bolt, pair.thread_pitch
    solid = part_solid(pair, Part.BOLT, Preset.COARSE.tessellation)
    corners = solid.vertices[solid.triangles[solid.faces == Face.THREAD]]
    points = corners.mean(axis=1)[:: len(corners) // 60]

    def nearest(point: Floats) -> float:
        def square(at: Floats) -> float:
            theta, z = float(at[0]), float(at[1])
            r = profile.radius(z - p * theta / (2.0 * math.pi))
            x, y = r * math.cos(theta) - point[0], r * math.sin(theta) - point[1]
            return float((x * x + y * y + (z - point[2]) ** 2) / p**2)

        start = np.array([math.atan2(point[1], point[0]), point[2]])
        return math.sqrt(minimize(square, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-16}).fun) * p

    found = deviation(solid, profile).surface
    distances = [nearest(point) for point in points]
    assert 0.5 * found < max(distances) < found


def test_a_hole_in_a_mesh_is_seen() -> None:
    solid = part_solid(UNC, Part.BOLT, Preset.COARSE.tessellation)
    torn = Solid(solid.vertices, solid.triangles[1:], solid.faces[1:], solid.edge)
    assert as_trimesh(solid).is_watertight
    assert not as_trimesh(torn).is_watertight


@pytest.mark.slow
@given(PROFILES)
def test_any_thread_surface_is_a_tube_of_small_chords(profile: Profile) -> None:
    size = math.hypot(math.sqrt(2.0) * profile.major_diameter, profile.thread_pitch)
    surface = thread_surface(profile, 0.0, Preset.COARSE.tessellation, size)
    assert np.abs(thread_gaps(surface.vertices, profile)).max() < 1e-11 * profile.major_diameter
    edges = np.sort(np.vstack([surface.triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
    unique, uses = np.unique(edges, axis=0, return_counts=True)
    # Every edge joins two triangles but those of the two rims; a tube has as many vertices and triangles as edges.
    assert set(uses) == {1, 2}
    assert np.count_nonzero(uses == 1) == len(surface.low) + len(surface.high)
    assert len(surface.vertices) + len(surface.triangles) == len(unique)


def test_cuts_are_at_the_boundaries_of_the_regions() -> None:
    cuts = profile_cuts(UNC.bolt, PAPER, 1.0)
    p = UNC.thread_pitch
    assert np.all(np.diff(cuts) > 0.0)
    assert (cuts[0], cuts[-1]) == (-p / 4, 3 * p / 4)
    for boundary in UNC.bolt.boundaries:
        assert np.abs(cuts - boundary).min() < 1e-15
        assert np.abs(cuts - (p / 2 - boundary)).min() < 1e-15


def test_angle_control_makes_small_radii_finer() -> None:
    counts = [len(profile_cuts(UNC.bolt, Tessellation(PAPER.chord_height, a), 0.36)) for a in (0.0, 0.5, 1.0)]
    assert counts[0] < counts[1] < counts[2]


def test_chord_height_follows_the_rule_of_angle_control() -> None:
    tessellation = Tessellation(1e-3, 0.5)
    assert tessellation.chord_at(0.25, 10.0) == pytest.approx(0.5e-3)
    assert tessellation.chord_at(1.0, 10.0) == tessellation.chord_at(3.0, 10.0) == 1e-3
    assert Tessellation(1e-3, 0.0).chord_at(0.001, 10.0) == 1e-3


@pytest.mark.parametrize(
    ("chord_height", "angle_control", "message"),
    [
        (0.0, 0.5, "chord_height is 0.0"),
        (math.nextafter(LARGEST_CHORD, 1.0), 0.5, "chord_height"),
        (math.nextafter(SMALLEST_CHORD, 0.0), 0.5, "chord_height"),
        (math.nan, 0.5, "chord_height is nan"),
        (1e-3, -0.1, "angle_control is -0.1; valid: 0 to 1"),
        (1e-3, 1.1, "angle_control"),
    ],
)
def test_values_out_of_range_are_named(chord_height: float, angle_control: float, message: str) -> None:
    with pytest.raises(InvalidValueError, match=message):
        Tessellation(chord_height, angle_control)


def test_solids_are_read_only() -> None:
    solid = part_solid(UNC, Part.NUT, PAPER)
    for array in (solid.vertices, solid.triangles, solid.faces, solid.edge):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
