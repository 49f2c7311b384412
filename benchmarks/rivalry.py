"""All three exact contacts against the mesh's first, on the same poses in the same run, one core against one core."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.mesh_descent import FASTER, SAFE, Descent, MeshDescent, mesh_first_heights
from benchmarks.sample import Poses
from threadstate.thread.pair import Pair

TUNNELLED_INCH = 5e-4
"""A mesh height this far below the exact one is a descent that went through the nut: meshes alone cost 7e-5 at most."""


@dataclass(frozen=True)
class Rival:
    """A mesh descent on the sample.

    ``ratio`` is how many times as many poses the exact method solves in the same time. Differences are mesh - exact, in
    inches: of their absolute values the median and the largest, and the difference itself at the ``worst_pose`` (roll,
    pitch, phase in degrees). ``tunnelled`` counts the poses whose mesh height is far too low.
    """

    name: str
    poses_per_second: float
    ratio: float
    median_difference: float
    largest_difference: float
    worst_pose: tuple[float, float, float]
    tunnelled: int


def rivals(pair: Pair, poses: Poses, exact_heights: Poses, exact_seconds: float) -> list[Rival]:
    """Every descent on poses whose exact heights (in) are known and were found with the rest in ``exact_seconds``."""
    meshes = MeshDescent(pair)
    return [_rival(meshes, poses, exact_heights, exact_seconds, descent) for descent in (SAFE, *FASTER)]


def _rival(meshes: MeshDescent, poses: Poses, exact_heights: Poses, exact_seconds: float, descent: Descent) -> Rival:
    heights, seconds = mesh_first_heights(meshes, poses, descent)
    difference = heights - exact_heights
    worst = int(np.argmax(np.abs(difference)))
    roll, pitch, phase = poses[worst].tolist()
    return Rival(
        name=_name(descent),
        poses_per_second=len(poses) / seconds,
        ratio=seconds / exact_seconds,
        median_difference=float(np.median(np.abs(difference))),
        largest_difference=float(difference[worst]),
        worst_pose=(roll, pitch, phase),
        tunnelled=int(np.count_nonzero(difference < -TUNNELLED_INCH)),
    )


def _name(descent: Descent) -> str:
    probe = ", plane first" if descent.probe_plane else ""
    plain = " (plain)" if descent == SAFE else ""
    return f"march by {descent.march_step_inch:g} in{probe}{plain}"
