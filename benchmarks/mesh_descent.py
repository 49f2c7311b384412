"""The rival: a plain descent to the first contact alone by a mesh collision library.

Both parts are closed meshes (``threadstate.mesh``) of some 60,000 triangles, each in a search tree built once.
For every pose the bolt starts where its lowest vertex is in the plane of the nut's surface (nothing can touch above),
goes down by a fixed step until the meshes collide, and the last step is bisected to ``TOLERANCE_INCH``. Queries are
boolean: one contact ends them and none is computed.

A step tunnels where the meshes part again below the first contact before the step has ended: it passes a barrier that
is thinner than the step. Over 10,212 poses with roll and pitch within 4 deg (6,000 at random, half of them within
20 deg of phase 0, and the grid of whole degrees at every seventh phase) the thinnest barrier, searched in steps of
1e-4 in, was 1.0e-3 in thick. That is a measurement and no bound: near a jump a barrier can be as thin as one likes, and
no fixed step is proven.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from threadstate.mesh.collision import Collider
from threadstate.mesh.frames import fixed_from_bolt
from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Tessellation
from threadstate.mesh.solid import Floats
from threadstate.thread.pair import Pair, Part

TESSELLATION = Tessellation(2.6e-4, 0.5)
"""60,100 triangles for the bolt of 1/4-20 UNC and 62,828 for the nut."""
TOLERANCE_INCH = 1e-6


@dataclass(frozen=True)
class Descent:
    """How to descend.

    ``march_step_inch`` is the step of the march. ``probe_plane`` first asks whether the bolt's lowest vertex meets the
    nut's surface at once, as it does in about half of all poses; a plain descent does not know that.
    """

    march_step_inch: float
    probe_plane: bool = False


SAFE = Descent(1e-4)
"""The plain descent: its step is a tenth of the thinnest barrier that was found, and the step it was searched in."""
FASTER = (Descent(1e-4, probe_plane=True), Descent(5e-4), Descent(5e-4, probe_plane=True))
"""With what is known of this geometry: a step of half the thinnest barrier, the plane first, both."""


class MeshDescent:
    """Bolt and nut of a pair as meshes with their search trees."""

    def __init__(self, pair: Pair) -> None:
        bolt, nut = (part_solid(pair, part, TESSELLATION) for part in Part)
        self._lowest_candidates = bolt.vertices[bolt.vertices[:, 2] <= 0.5 * pair.thread_pitch]
        self._collider = Collider(bolt, nut)

    def first_height(self, roll_deg: float, pitch_deg: float, phase_deg: float, descent: Descent = SAFE) -> float:
        """Height of the bolt's origin (in) at which the descending meshes first touch, at most 1e-6 in too high."""
        roll, pitch, phase = np.radians([roll_deg, pitch_deg, phase_deg]).tolist()
        pose = fixed_from_bolt(roll, pitch, phase, np.zeros(3))

        def collides(height: float) -> bool:
            pose[2, 3] = height
            return self._collider.collides(pose)

        free = float(-(self._lowest_candidates @ pose[2, :3]).min()) + 0.5 * TOLERANCE_INCH
        if descent.probe_plane and collides(free - TOLERANCE_INCH):
            return free
        return _descend(collides, free, descent.march_step_inch)


def _descend(collides: Callable[[float], bool], free: float, step: float) -> float:
    """The lowest free height found: march down from a free one until there is a collision, then bisect."""
    blocked = free - step
    while not collides(blocked):
        free, blocked = blocked, blocked - step
    while free - blocked > TOLERANCE_INCH:
        middle = 0.5 * (free + blocked)
        if collides(middle):
            blocked = middle
        else:
            free = middle
    return free


def mesh_first_heights(meshes: MeshDescent, poses: ArrayLike, descent: Descent = SAFE) -> tuple[Floats, float]:
    """First heights (in) of poses, shape (n, 3) of roll, pitch, phase in degrees; and the seconds the descents took.

    Measured is the wall time of the descents alone, on one core: meshes and search trees are built before, as the exact
    method's kernels are compiled before. The contact's place is not computed, nor are the second and third contacts.
    """
    rows = np.asarray(poses, dtype=np.float64).reshape(-1, 3)
    heights = np.empty(len(rows))
    start = time.perf_counter()
    for i, (roll, pitch, phase) in enumerate(rows):
        heights[i] = meshes.first_height(roll, pitch, phase, descent)
    return heights, time.perf_counter() - start
