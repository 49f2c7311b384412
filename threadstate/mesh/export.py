"""Solids as mesh files, and reports on them; by trimesh."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import cast

import trimesh

from threadstate.errors import InvalidValueError, ThreadstateError
from threadstate.mesh.chamfer_deviation import chamfered_deviation
from threadstate.mesh.options import Scene
from threadstate.mesh.presets import Tessellation
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solid import Face, Solid
from threadstate.thread.pair import Pair, Part

ENDINGS = ("stl", "ply", "glb")


class UnwritableFileError(ThreadstateError):
    """A file could not be written; the message names it and the reason."""


@dataclass(frozen=True, slots=True)
class MeshReport:
    """What a solid came to; lengths in the pair's unit.

    ``chord_deviation`` is the largest distance from the thread's mesh to the true surface, ``edge_deviation`` that from
    the outline of the cut end to the true edge curve.
    """

    vertices: int
    triangles: int
    watertight: bool
    volume: float
    chord_deviation: float
    edge_deviation: float


def as_trimesh(solid: Solid) -> trimesh.Trimesh:
    """The solid as trimesh has it, its vertices and triangles in the same order."""
    return trimesh.Trimesh(vertices=solid.vertices, faces=solid.triangles, process=False)


def glb_by_face(solid: Solid) -> bytes:
    """The solid as GLB, with a mesh of its own, named in small letters, for every kind of :class:`Face`.

    So a viewer can shade each kind smoothly and keep the edges between them sharp. Numbers are 32-bit floats in the
    pair's unit.
    """
    scene = trimesh.Scene()
    for face in Face:
        if face is Face.CHAMFER and not (solid.faces == face).any():
            continue
        patch = trimesh.Trimesh(solid.vertices, solid.triangles[solid.faces == face], process=False)
        patch.remove_unreferenced_vertices()
        scene.add_geometry(patch, node_name=face.name.lower(), geom_name=face.name.lower())
    return cast("bytes", scene.export(file_type="glb"))  # type: ignore[no-untyped-call]


def mesh_report(pair: Pair, part: Part, tessellation: Tessellation, scene: Scene = Scene.FULL) -> MeshReport:
    """The report of a part as a scene with triangles has it; of an open mesh the volume means nothing."""
    solid = scene_part(pair, part, tessellation, scene)
    profile, chamfer = (pair.bolt, pair.chamfer) if part is Part.BOLT else (pair.nut, None)
    found = chamfered_deviation(solid, profile, chamfer)
    mesh = as_trimesh(solid)
    return MeshReport(
        vertices=len(solid.vertices),
        triangles=len(solid.triangles),
        watertight=bool(mesh.is_watertight and mesh.is_winding_consistent),
        volume=float(mesh.volume),
        chord_deviation=found.surface,
        edge_deviation=found.edge,
    )


def file_ending(path: Path) -> str:
    """The ending of a mesh file, without its dot and in small letters.

    Raises:
        InvalidValueError: it is not one that can be written.
    """
    ending = path.suffix.removeprefix(".").lower()
    if ending not in ENDINGS:
        raise InvalidValueError("ending of the file", str(path), ", ".join(f".{known}" for known in ENDINGS))
    return ending


def write_mesh(solid: Solid, path: Path) -> int:
    """Write a solid as STL, PLY or GLB, by the file's ending; numbers are in the pair's unit, as 32-bit floats.

    Returns:
        The file's size in bytes.

    Raises:
        InvalidValueError: another ending.
        UnwritableFileError: the file cannot be written.
    """
    # trimesh knows formats of text and of several files, too; these are bytes.
    content = cast("bytes", as_trimesh(solid).export(file_type=file_ending(path)))
    try:
        return path.write_bytes(content)
    except OSError as error:
        raise UnwritableFileError(f"cannot write {str(path)!r}: {error.strerror or error}") from None
