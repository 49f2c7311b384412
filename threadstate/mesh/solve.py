"""Contact states of poses by the collision of meshes: the paper's method."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.mesh.method import mesh_method
from threadstate.mesh.options import MeshOptions
from threadstate.state.decode import decoded_states
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair


def solve_poses_by_mesh(
    pair: Pair, poses: ArrayLike, mesh: MeshOptions | None = None, options: SolveOptions | None = None
) -> list[ContactState]:
    """The contact states of poses of shape (n, 3): roll, pitch and phase in degrees, in their order.

    The same object as :func:`threadstate.state.solve.solve_poses` returns, its numbers as accurate as the meshes and
    the final step. Poses are those in which the meshes collide, so that contacts are overlaps of up to the final step;
    an embedment below the meshes' noise counts as none. The same pose gives the same bits whatever the others are.

    Raises:
        InvalidValueError: poses not of shape (n, 3), a value not finite, roll or pitch beyond 10 deg.
        MeshUndecidedError: the meshes cannot answer for a pose; the reason is named.
    """
    method = mesh_method(pair, mesh or MeshOptions())
    wanted = checked_poses(poses)
    chosen = method.solve_options(options or SolveOptions())
    records = np.empty((len(wanted), RECORD_SIZE))
    for i, (roll, pitch, phase) in enumerate(wanted.tolist()):
        records[i] = method.solve((roll, pitch, phase), chosen)
    return decoded_states(pair, chosen, wanted, records)
