"""Contacts of a chamfered bolt: its side is thread and cone, and so are the region and the normal of a contact.

The features are those of a bolt that is cut flat: ``edge`` is the outline of the base, ``thread`` all of the side. On
the cone, and where the cone cuts the outline, the bolt's region is ``chamfer``; on the edge between cone and thread it
is the thread's.
"""

from __future__ import annotations

import math

import numpy as np

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._geometry_kernel import edge_point, phi_and_gradient
from threadstate.mesh.solid import Floats
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.pair import Pair
from threadstate.thread.regions import SIDE_REGIONS, Region

STEPS = 256
"""Steps along the cone in which its upper boundary is looked for."""

CHAMFER = SIDE_REGIONS.index(Region.CHAMFER)
_EDGES = (stage.EDGE_EDGE, stage.EDGE_SURFACE, stage.EDGE_THREAD, stage.FLUSH)


def set_side(pair: Pair, chamfer: Chamfer, pose: Floats, contact: Floats, near: float) -> None:
    """Set point, normal, region and margin of a recorded contact on the bolt's side; ``pose`` as in a record.

    A contact that is no farther than ``near`` (in the pair's unit) from both cone and thread is on their edge.
    """
    features = int(contact[rk.P_PAIR])
    on_outline = features in _EDGES
    if features == stage.BASE_EDGE:
        return
    x, y, z = rk.in_bolt_frame(pose, *contact[rk.P_POINT : rk.P_POINT + 3])
    z = 0.0 if on_outline else z
    contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 3] = x, y, z
    azimuth = math.atan2(y, x)
    s = z - pair.bolt.advance * azimuth
    excess = pair.bolt.radius(s) - chamfer.radius(z)
    near = 0.0 if on_outline else near
    if excess > near:
        contact[rk.P_BOLT_REGION] = CHAMFER
        contact[rk.P_BOLT_MARGIN] = _margin(pair, chamfer, azimuth, z)
        _set_normal(pair, pose, contact, _cone_normal(x, y, chamfer), on_outline)
    else:
        index, margin = pair.bolt.region_index(s)
        contact[rk.P_BOLT_REGION] = index
        contact[rk.P_BOLT_MARGIN] = min(margin, max(0.0, -excess))
        if abs(excess) <= near:
            contact[rk.P_BOLT_MARGIN] = 0.0
            _set_normal_of_edge(pair, chamfer, pose, contact)


def edge_tangent(pair: Pair, chamfer: Chamfer, pose: Floats, point: Floats, near: float) -> Floats | None:
    """The unit tangent, in the nut's frame, of the cone's edge that a point there is on, to ``near``; None on none."""
    x, y, z = rk.in_bolt_frame(pose, *point)
    azimuth = math.atan2(y, x)
    excess = pair.bolt.radius(z - pair.bolt.advance * azimuth) - chamfer.radius(z)
    if excess < -near or (excess > near and z > near):
        return None
    if excess > near:
        tangent = np.array([-y, x, 0.0])
    else:
        tangent = np.cross(_cone_normal(x, y, chamfer), _thread_normal(pair, x, y, z))
    return np.asarray(pose[:9].reshape(3, 3) @ (tangent / np.linalg.norm(tangent)))


def _margin(pair: Pair, chamfer: Chamfer, azimuth: float, z: float) -> float:
    """How far, along the cone, its boundaries above and below are; from the outline the one above."""
    top = chamfer.height(pair.bolt.major_diameter)
    heights = np.linspace(z, top, STEPS + 1)
    side = 1.0 / math.sin(math.radians(chamfer.angle_deg))

    def is_cone(height: float) -> bool:
        return pair.bolt.radius(height - pair.bolt.advance * azimuth) > chamfer.radius(height)

    above = next((height for height in heights.tolist() if not is_cone(height)), top)
    low, high = max(z, above - (top - z) / STEPS), above
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if is_cone(middle) else (low, middle)
    below = z if z > 0.0 else math.inf
    return float(min(below, high - z) * side)


def _cone_normal(x: float, y: float, chamfer: Chamfer) -> Floats:
    """The outward unit normal of the cone."""
    r = math.hypot(x, y)
    angle = math.radians(chamfer.angle_deg)
    return np.array([x / r * math.sin(angle), y / r * math.sin(angle), -math.cos(angle)])


def _thread_normal(pair: Pair, x: float, y: float, z: float) -> Floats:
    """The outward unit normal of the thread."""
    _, *gradient = phi_and_gradient(x, y, z, pair.bolt.packed, 1.0)
    return np.array(gradient) / float(np.linalg.norm(gradient))


def _set_normal(pair: Pair, pose: Floats, contact: Floats, outward: Floats, on_outline: bool) -> None:
    """The normal of a contact on the cone, where the bolt decides it."""
    features = int(contact[rk.P_PAIR])
    if features == stage.THREAD_EDGE:
        contact[rk.P_NORMAL : rk.P_NORMAL + 3] = -pose[:9].reshape(3, 3) @ outward
    elif features == stage.EDGE_EDGE and on_outline:
        x, y, _ = contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 3]
        _cross_edges(pair, pose, contact, np.array([-y, x, 0.0]))


def _set_normal_of_edge(pair: Pair, chamfer: Chamfer, pose: Floats, contact: Floats) -> None:
    """The normal of a contact on the edge between cone and thread, where the nut's edge meets it."""
    if int(contact[rk.P_PAIR]) == stage.THREAD_EDGE:
        x, y, z = contact[rk.P_BOLT_POINT : rk.P_BOLT_POINT + 3].tolist()
        _cross_edges(pair, pose, contact, np.cross(_cone_normal(x, y, chamfer), _thread_normal(pair, x, y, z)))


def _cross_edges(pair: Pair, pose: Floats, contact: Floats, bolt_tangent: Floats) -> None:
    """The normal of two edges that cross, into the bolt; it stays as it is where they are parallel."""
    point = contact[rk.P_POINT : rk.P_POINT + 3]
    rotation = pose[:9].reshape(3, 3)
    _, _, dx, dy = edge_point(math.atan2(point[1], point[0]), pair.nut.packed)
    normal = np.cross(rotation @ bolt_tangent, np.array([dx, dy, 0.0]))
    size = float(np.linalg.norm(normal))
    if size > 0.0:
        into_bolt = pose[9:12] + 0.5 * pair.thread_pitch * rotation[:, 2] - point
        contact[rk.P_NORMAL : rk.P_NORMAL + 3] = math.copysign(1.0, float(normal @ into_bolt)) * normal / size
