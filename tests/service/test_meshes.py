from __future__ import annotations

import io

import numpy as np
import pytest
import trimesh
from fastapi.testclient import TestClient

from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Preset
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Part

pytestmark = pytest.mark.sqlite_alone

LARGEST_ZIPPED_BYTES = 150_000


@pytest.mark.parametrize("part", list(Part))
def test_mesh_is_the_part_of_the_librarys_pair(client: TestClient, part: Part) -> None:
    response = client.get(f"/v1/libraries/latest/meshes/{part.value}")
    assert response.headers["Content-Type"] == "model/gltf-binary"
    scene = trimesh.load_scene(io.BytesIO(response.content), file_type="glb")
    assert set(scene.geometry) == {"thread", "cut", "far_end", "wall"}
    solid = part_solid(quarter_twenty_unc(), part, Preset.PAPER.tessellation)
    whole = scene.to_mesh()
    whole.merge_vertices()
    assert len(whole.faces) == len(solid.triangles)
    assert whole.is_watertight
    assert np.allclose(whole.bounds, [solid.vertices.min(axis=0), solid.vertices.max(axis=0)], atol=1e-8)


def test_meshes_are_small_and_come_with_an_etag_of_their_own(client: TestClient) -> None:
    path = "/v1/libraries/latest/meshes/bolt"
    tags = {client.get(path, headers={"Accept-Encoding": coding}).headers["ETag"] for coding in ("gzip", "identity")}
    assert len(tags) == 2
    zipped = client.get(path, headers={"Accept-Encoding": "gzip"})
    assert int(zipped.headers["Content-Length"]) < LARGEST_ZIPPED_BYTES
    for tag in tags:
        headers = {"If-None-Match": tag, "Accept-Encoding": "gzip"}
        assert client.get(path, headers=headers).status_code == (304 if tag == zipped.headers["ETag"] else 200)


def test_other_parts_are_refused(client: TestClient) -> None:
    assert client.get("/v1/libraries/latest/meshes/washer").status_code == 400
