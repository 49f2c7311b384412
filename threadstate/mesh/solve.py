"""Contact states of poses by the collision of meshes: the paper's procedure."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.agreement import disagreement, other_tessellation
from threadstate.mesh.curve_procedure import CurveProcedure
from threadstate.mesh.options import MeshOptions, Scene
from threadstate.mesh.procedure import MeshProcedure
from threadstate.state.decode import decoded_states
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import checked_poses
from threadstate.thread.pair import Pair

PoseDeg = tuple[float, float, float]

SEGMENTS = 1.5
"""Contacts of two tessellations are one where they are no farther apart than this many of the longer segments."""


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
    mesh = mesh or MeshOptions()
    chosen = options or SolveOptions()
    wanted = checked_poses(poses)
    solve = _checked if mesh.checked else _unchecked
    return [solve(pair, mesh, chosen, (roll, pitch, phase)) for roll, pitch, phase in wanted.tolist()]


@lru_cache(maxsize=4)
def mesh_procedure(pair: Pair, options: MeshOptions) -> MeshProcedure:
    """The procedure for a pair, by triangles or by edge curves depending on the scene; the last four are cached."""
    return CurveProcedure(pair, options) if options.scene is Scene.CURVES else MeshProcedure(pair, options)


def _checked(pair: Pair, mesh: MeshOptions, options: SolveOptions, pose_deg: PoseDeg) -> ContactState:
    other_mesh = other_tessellation(mesh)
    state = _unchecked(pair, mesh, options, pose_deg)
    try:
        other = _unchecked(pair, other_mesh, options, pose_deg)
    except MeshUndecidedError as error:
        raise MeshUndecidedError(*pose_deg, f"by another tessellation: {error.reason}") from None
    near = SEGMENTS * max(mesh_procedure(pair, one).segment for one in (mesh, other_mesh))
    reason = disagreement(state, other, near)
    if reason is not None:
        raise MeshUndecidedError(*pose_deg, reason)
    return state


def _unchecked(pair: Pair, mesh: MeshOptions, options: SolveOptions, pose_deg: PoseDeg) -> ContactState:
    return state_by(mesh_procedure(pair, mesh), options, pose_deg)


def state_by(procedure: MeshProcedure, options: SolveOptions, pose_deg: PoseDeg) -> ContactState:
    """The state of a valid pose (roll, pitch, phase in degrees) by a given procedure, without the check by a second
    tessellation.

    Raises:
        MeshUndecidedError: the meshes cannot answer.
    """
    chosen = procedure.solve_options(options)
    record = procedure.solve(pose_deg, chosen)
    return decoded_states(procedure.pair, chosen, np.array([pose_deg]), record.reshape(1, RECORD_SIZE))[0]
