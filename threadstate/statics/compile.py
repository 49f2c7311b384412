"""Compiles the kernels of the statics into the cache: ``python -m threadstate.statics.compile``."""

from __future__ import annotations

import numpy as np

from threadstate.statics import _friction_kernel as fk
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics._patch_kernel import OUTLINE_SAMPLES, patch_hull
from threadstate.statics._program_kernel import program_address, solve_with
from threadstate.statics._support_kernel import depth_in_simplex, distance_to_rays, patch_margin
from threadstate.thread.catalogue import quarter_twenty_unc


def load_kernels() -> None:
    """Call each kernel that is called from Python, on three contacts of a plane and on a level patch."""
    points, normals = np.eye(3), np.tile([0.0, 0.0, 1.0], (3, 1))
    load, forces, twist = np.array([0.0, 0.0, 0.1, 0.0, 0.0, -1.0]), np.zeros(9), np.zeros(6)
    _, _, wedge = fk.wedge_friction(points, normals, forces, twist)
    fk.hold_friction(load, points, normals, wedge, np.zeros(9), np.zeros(6), forces, twist)
    fk.least_forces(load, 1.0, points, normals, forces)
    distance_to_rays(load, np.hstack([np.cross(points, normals), normals]))
    depth_in_simplex(load, np.eye(3, 6))
    turn_effort(1.0, 0.0, points, normals, 0.1, 1.0)
    solve_with(program_address(), np.zeros(1), -np.eye(1), np.ones(1), np.ones(1, np.intp), np.zeros(1), np.zeros(1))
    pair = quarter_twenty_unc()
    pose = np.array([*np.ravel(np.eye(3)), 0.0, 0.0, 0.0])
    hull = np.empty((2 * OUTLINE_SAMPLES + 1, 2))
    count = patch_hull(pose, pair.bolt.packed, pair.nut.packed, hull)
    patch_margin(load, hull[:count])


if __name__ == "__main__":
    load_kernels()
