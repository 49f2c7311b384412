"""The exact method's pace: all contacts of poses, in processes whose kernels are loaded before the clock starts."""

from __future__ import annotations

import multiprocessing
import time
from multiprocessing.connection import Connection

import numpy as np

from benchmarks.sample import Poses
from threadstate.errors import UnresolvedPoseError
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.pair import Pair
from worker.garbage import collect_rarely

BATCH = 256
"""How many poses are solved by a call, and their states then dropped."""


def first_heights(pair: Pair, poses: Poses) -> Poses:
    """Heights of first contact (the bolt's origin, in the pair's unit) of poses; NaN where the solver decides none."""
    heights = np.full(len(poses), np.nan)
    for i, (roll, pitch, phase) in enumerate(poses.tolist()):
        try:
            heights[i] = solve_pose(pair, roll, pitch, phase).poses[0].translation[2]
        except UnresolvedPoseError:
            continue
    return heights


def seconds_to_solve(pair: Pair, poses: Poses, processes: int) -> float:
    """Wall time to solve poses in that many processes, one a core, each with its share of them and ready to start."""
    # forkserver, as for a library: the same code runs on one core and on two.
    context = multiprocessing.get_context("forkserver")
    ends: list[Connection] = []
    for k in range(processes):
        ours, theirs = context.Pipe()
        context.Process(target=_solve_share, args=(theirs, pair, poses[k::processes]), daemon=True).start()
        theirs.close()
        ends.append(ours)
    for end in ends:
        end.recv()
    start = time.perf_counter()
    for end in ends:
        end.send(None)
    for end in ends:
        end.recv()
    return time.perf_counter() - start


def _solve_share(connection: Connection, pair: Pair, poses: Poses) -> None:
    collect_rarely()  # as the processes of a rebuild do
    solve_poses(pair, poses[:BATCH])
    connection.send(None)
    connection.recv()
    for start in range(0, len(poses), BATCH):
        solve_poses(pair, poses[start : start + BATCH])
    connection.send(None)
