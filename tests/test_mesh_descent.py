from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.mesh_descent import FASTER, SAFE, Descent, mesh_first_heights
from benchmarks.tessellation import Mesh, bolt_mesh, nut_mesh
from tests.oracle.first_height import first_height
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.profile import Profile

PAIR = quarter_twenty_unc()
MESHES = {"bolt": (bolt_mesh(PAIR), PAIR.bolt), "nut": (nut_mesh(PAIR), PAIR.nut)}


@pytest.mark.parametrize("part", MESHES)
def test_meshes_are_closed_and_turned_outward(part: str) -> None:
    mesh, _ = MESHES[part]
    assert mesh.is_closed()
    assert mesh.volume() > 0.0
    assert len(mesh.triangles) == 60_476


def test_a_mesh_with_a_hole_is_not_closed() -> None:
    mesh, _ = MESHES["bolt"]
    assert not Mesh(mesh.vertices, mesh.triangles[1:]).is_closed()


@pytest.mark.parametrize("part", MESHES)
def test_thread_vertices_lie_on_the_surface(part: str) -> None:
    mesh, profile = MESHES[part]
    radii = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 1])
    away = np.array([abs(r - _radius(profile, v)) for r, v in zip(radii, mesh.vertices, strict=True)])
    between_ends = np.abs(mesh.vertices[:, 2]) % PAIR.thread_pitch > 1e-9
    wall = radii[~between_ends].min() if part == "bolt" else radii.max()
    on_thread = between_ends & (np.abs(radii - wall) > 1e-9)
    assert on_thread.sum() > 20_000
    assert away[on_thread].max() < 1e-14


def _radius(profile: Profile, vertex: np.ndarray[tuple[int], np.dtype[np.float64]]) -> float:
    return profile.radius(float(vertex[2]) - PAIR.thread_pitch * math.atan2(vertex[1], vertex[0]) / (2 * math.pi))


@pytest.mark.parametrize("descent", [SAFE, *FASTER])
def test_mesh_heights_agree_with_the_brute_force(descent: Descent) -> None:
    poses = np.random.default_rng(20).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (20, 3))
    heights, seconds = mesh_first_heights(PAIR, poses, descent)
    exact_inch = [first_height(PAIR, *(float(a) for a in pose)).height for pose in poses]
    assert seconds > 0.0
    # Meshes of half a degree differ from the surfaces by up to 7e-5 in near a snap (method, section 6).
    assert heights == pytest.approx(np.array(exact_inch), abs=7e-5)
    assert np.median(np.abs(heights - exact_inch)) < 2e-6
