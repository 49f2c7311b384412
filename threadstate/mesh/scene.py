"""The parts of a scene: what of bolt and nut is modelled (decision 6)."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from threadstate.errors import InvalidValueError
from threadstate.mesh.edge_zone import edge_zone_part
from threadstate.mesh.options import Scene
from threadstate.mesh.part import cut_inradius, part_size, part_solid
from threadstate.mesh.presets import Tessellation
from threadstate.mesh.solid import Face, Floats, Solid
from threadstate.mesh.thread_surface import outline
from threadstate.thread.pair import Pair, Part

WITH_CHAMFER = (Scene.FULL, Scene.BAND)
"""The scenes that take bolts with a chamfer."""


@lru_cache(maxsize=8)
def scene_part(pair: Pair, part: Part, tessellation: Tessellation, scene: Scene) -> Solid:
    """A part as a scene has it; closed in ``FULL`` alone, without any triangles in ``CURVES``.

    Raises:
        InvalidValueError: a bolt with a chamfer in a scene that has no room for its cone.
    """
    if pair.chamfer is not None and scene not in WITH_CHAMFER:
        raise InvalidValueError("scene", scene.value, f"{' or '.join(WITH_CHAMFER)} of a pair whose bolt has a chamfer")
    profile = pair.bolt if part is Part.BOLT else pair.nut
    inradius = cut_inradius(pair, part)
    size = part_size(profile, inradius)
    if scene is Scene.CURVES:
        return _edge_alone(outline(profile, tessellation, size))
    if scene is Scene.EDGES:
        return edge_zone_part(profile, inradius, size, tessellation, outward=part is Part.BOLT)
    whole = part_solid(pair, part, tessellation)
    return whole if scene is Scene.FULL else _near_side(whole)


def _near_side(whole: Solid) -> Solid:
    """The part without its far end and walls; triangles at the thread's far rim count as far end.

    Nothing is lost by that, as the solids end there without a face (method, section 1): a contact that holds a triangle
    of a far end or of walls does not count.
    """
    far = np.zeros(len(whole.vertices), dtype=bool)
    far[whole.triangles[whole.faces == Face.FAR_END]] = True
    is_near = np.isin(whole.faces, (Face.THREAD, Face.CUT, Face.CHAMFER))
    faces = whole.faces[is_near].copy()
    faces[(faces == Face.THREAD) & far[whole.triangles[is_near]].any(axis=1)] = Face.FAR_END
    used, triangles = np.unique(whole.triangles[is_near], return_inverse=True)
    return Solid(
        vertices=whole.vertices[used],
        triangles=triangles.reshape(-1, 3),
        faces=faces,
        edge=np.searchsorted(used, whole.edge),
    )


def _edge_alone(points: Floats) -> Solid:
    return Solid(
        vertices=points,
        triangles=np.empty((0, 3), dtype=np.int64),
        faces=np.empty(0, dtype=np.int8),
        edge=np.arange(len(points)),
    )
