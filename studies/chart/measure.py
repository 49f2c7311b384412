"""A contestant on poses: its answers, and the time that each took."""

from __future__ import annotations

import pickle
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from studies.chart.contestant import ByMesh, Contestant, Engine, Exactly
from studies.chart.exact import Pose, proved_state, run_with_boxes
from threadstate.errors import UnresolvedPoseError
from threadstate.mesh.collision import Collider
from threadstate.mesh.curve_procedure import CurveProcedure
from threadstate.mesh.options import Scene
from threadstate.mesh.procedure import MeshProcedure
from threadstate.mesh.scene import scene_part
from threadstate.mesh.solve import state_by
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_pose
from threadstate.thread.pair import Pair, Part

REPEATS = 5
"""How many times what takes a millisecond is timed; the least counts."""
WHOLE_TURN_DEG = 360.0
"""The exact method is given the phase a turn on: the same pose but for round-off, so that its own shows."""

Solve = Callable[[Pose], ContactState]


@dataclass(frozen=True)
class Run:
    """A contestant's states (None: undecided) and CPU seconds by pose; ``setup_s`` before the first.

    ``triangles`` is how many there are of both parts together, ``reach`` what its meshes and steps can be off (length),
    ``segment`` the longest segment of its edges (length); all 0 of the exact method.
    """

    contestant: Contestant
    states: tuple[ContactState | None, ...]
    seconds: tuple[float, ...]
    setup_s: float
    triangles: int
    reach: float
    segment: float


def run(contestant: Contestant, pair: Pair, poses: list[Pose]) -> Run:
    """Solve poses one by one on one thread."""
    way = contestant.way
    if isinstance(way, Exactly) and way.boxes is not None:
        plain = replace(contestant, way=replace(way, boxes=None))
        found: Run = pickle.loads(run_with_boxes(way.boxes, pickle.dumps((plain, pair, poses))))
        return replace(found, contestant=contestant)
    began = time.process_time()
    triangles, reach, segment = 0, 0.0, 0.0
    if isinstance(way, ByMesh):
        method = mesh_procedure(way, pair)
        parts = [scene_part(pair, part, way.options.tessellation, way.options.scene) for part in Part]
        triangles = sum(len(part.triangles) for part in parts)
        reach = method.edge_deviation + way.options.final_step * pair.thread_pitch
        segment = method.segment

        solve: Solve = partial(_by_mesh, method, contestant)
        repeats = REPEATS if way.options.scene is Scene.CURVES else 1
    else:
        solve, repeats = _exactly(way, contestant, pair), REPEATS
    _answer(solve, poses[0])
    setup = time.process_time() - began
    answers = [_timed(solve, pose, repeats) for pose in poses]
    states, seconds = tuple(state for state, _ in answers), tuple(spent for _, spent in answers)
    return Run(contestant, states, seconds, setup, triangles, reach, segment)


def mesh_procedure(way: ByMesh, pair: Pair) -> MeshProcedure:
    """The method, its meshes and search trees."""
    if way.options.scene is Scene.CURVES:
        return CurveProcedure(pair, way.options)
    if way.engine is Engine.COAL:
        from studies.chart.coal_engine import CoalEngine

        return MeshProcedure(pair, way.options, CoalEngine)
    return MeshProcedure(pair, way.options, Collider)


def _by_mesh(method: MeshProcedure, contestant: Contestant, pose: Pose) -> ContactState:
    return state_by(method, contestant.options, pose)


def _exactly(way: Exactly, contestant: Contestant, pair: Pair) -> Solve:
    def solve(pose: Pose) -> ContactState:
        roll, pitch, phase = pose
        if way.proved:
            return proved_state(pair, (roll, pitch, phase + WHOLE_TURN_DEG), contestant.options)
        return solve_pose(pair, roll, pitch, phase + WHOLE_TURN_DEG, contestant.options)

    return solve


def _timed(solve: Solve, pose: Pose, repeats: int) -> tuple[ContactState | None, float]:
    best = float("inf")
    for _ in range(repeats):
        began = time.process_time()
        state = _answer(solve, pose)
        best = min(best, time.process_time() - began)
    return state, best


def _answer(solve: Solve, pose: Pose) -> ContactState | None:
    try:
        return solve(pose)
    except UnresolvedPoseError:
        return None
