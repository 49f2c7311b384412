"""Bolt and nut of a pair as solids (method, section 1; the paper, section 4)."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from threadstate.mesh.chamfered import chamfered_side, whole_thread
from threadstate.mesh.end_face import SIDES, end_face
from threadstate.mesh.presets import Tessellation
from threadstate.mesh.solid import Face, Floats, Ints, Solid
from threadstate.mesh.thread_surface import thread_surface
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.pair import Pair, Part
from threadstate.thread.profile import Profile

BORE = 0.5
"""Inradius of the bolt's bore in minor radii: a nut's edge comes no nearer to the axis within 45 deg of tilt."""
WALL = 1.0
"""How far, in thread pitches, the nut's prism extends beyond its major radius: farther than a bolt's edge slides."""


@lru_cache(maxsize=8)
def part_solid(pair: Pair, part: Part, tessellation: Tessellation) -> Solid:
    """The bolt, 0 <= z <= p, hollow; or the nut, -p <= z <= 0, cut from a prism of 16 sides.

    With a chamfer both are as many pitches longer as it is high, so that a whole pitch of thread is beyond it.
    """
    inradius = cut_inradius(pair, part)
    pitches = pitches_long(pair)
    if part is Part.BOLT:
        return _solid(pair.bolt, 0.0, inradius, tessellation, pitches, pair.chamfer, outward=True)
    return _solid(pair.nut, -pitches * pair.thread_pitch, inradius, tessellation, pitches, None, outward=False)


def pitches_long(pair: Pair) -> int:
    """How many thread pitches long the solids are: one, and as many as hold the bolt's chamfer."""
    if pair.chamfer is None:
        return 1
    return 1 + math.ceil(pair.chamfer.height(pair.fit.bolt_major_diameter) / pair.thread_pitch)


def cut_inradius(pair: Pair, part: Part) -> float:
    """The inradius (in the pair's unit) of the polygon that a part's cut ends extend to: inward to the bolt's bore, or
    outward to the sides of the nut's prism.
    """
    if part is Part.BOLT:
        return BORE * pair.fit.bolt_minor_diameter / 2.0
    return pair.fit.nut_major_diameter / 2.0 + WALL * pair.thread_pitch


def part_size(profile: Profile, inradius: float) -> float:
    """The diagonal of the box about a part whose cut ends extend to a polygon of that inradius."""
    width = 2.0 * max(inradius, profile.major_diameter / 2.0)
    return math.sqrt(2.0 * width * width + profile.thread_pitch**2)


def _solid(
    profile: Profile,
    z_low: float,
    inradius: float,
    tessellation: Tessellation,
    pitches: int,
    chamfer: Chamfer | None,
    *,
    outward: bool,
) -> Solid:
    surface = thread_surface(profile, z_low, tessellation, part_size(profile, inradius), pitches=pitches)
    thread = whole_thread(surface) if chamfer is None else chamfered_side(surface, profile, chamfer)
    low = end_face(thread.vertices[thread.low], thread.low, inradius, len(thread.vertices))
    first = len(thread.vertices) + len(low.vertices)
    high = end_face(thread.vertices[thread.high], thread.high, inradius, first)

    walls = _wall(low.polygon, high.polygon)
    cut, far = (Face.CUT, Face.FAR_END) if outward else (Face.FAR_END, Face.CUT)
    patches = (
        (thread.triangles if outward else _turned_over(thread.triangles), thread.faces),
        (_turned_over(low.triangles), cut),
        (high.triangles, far),
        (_turned_over(walls) if outward else walls, Face.WALL),
    )
    edge = thread.low if outward else thread.high
    return Solid(
        vertices=np.vstack([thread.vertices, low.vertices, high.vertices]),
        triangles=np.vstack([triangles for triangles, _ in patches]),
        faces=np.concatenate([np.broadcast_to(np.asarray(face, dtype=np.int8), len(of)) for of, face in patches]),
        edge=_by_azimuth(thread.vertices, edge),
    )


def _wall(low: Ints, high: Ints) -> Ints:
    """The sides between two polygons, normals away from the axis."""
    after = (np.arange(SIDES) + 1) % SIDES
    return np.vstack([np.column_stack([low, low[after], high[after]]), np.column_stack([low, high[after], high])])


def _turned_over(triangles: Ints) -> Ints:
    return triangles[:, ::-1]


def _by_azimuth(vertices: Floats, ring: Ints) -> Ints:
    azimuths = np.arctan2(vertices[ring, 1], vertices[ring, 0]) % (2.0 * math.pi)
    return np.roll(ring, -int(np.argmin(azimuths)))
