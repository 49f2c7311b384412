"""How far a solid's mesh is from the true surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from threadstate.mesh.solid import Face, Solid
from threadstate.thread.profile import Profile


@dataclass(frozen=True, slots=True)
class Deviation:
    """Largest distances from the mesh: ``surface`` to the thread, ``edge`` to the edge curve; in the pair's unit."""

    surface: float
    edge: float


def deviation(solid: Solid, profile: Profile) -> Deviation:
    """The deviation of a part of that profile, by the closed form of the profile.

    Every triangle of the thread is sampled at 15 points, every segment of the edge at 4; flat faces are exact.
    """
    from threadstate.mesh import _deviation_kernel as kernel

    threads = np.ascontiguousarray(solid.triangles[solid.faces == Face.THREAD])
    vertices = np.array(solid.vertices)
    return Deviation(
        surface=float(kernel.largest_of_triangles(vertices, threads, profile.packed)),
        edge=float(kernel.largest_of_outline(vertices[solid.edge], profile.packed)),
    )
