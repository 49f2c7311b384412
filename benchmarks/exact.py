"""The exact method's pace: all contacts of poses, in processes whose kernels are loaded before the clock starts."""

from __future__ import annotations

import multiprocessing
import time
from functools import partial
from multiprocessing.connection import Connection

import numpy as np

from benchmarks.sample import Poses
from threadstate.contact._record_kernel import O_POSE
from threadstate.errors import UnresolvedPoseError
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
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


def seconds_to_solve(pair: Pair, poses: Poses, processes: int, *, first_contact_only: bool = False) -> float:
    """Wall time to solve poses in that many processes, one a core, each with its share of them and ready to start.

    All contacts as states, or the first alone, which is all that a mesh's descent finds, as its height.
    """
    # forkserver, as for a library: the same code runs on one core and on two.
    context = multiprocessing.get_context("forkserver")
    ends: list[Connection] = []
    for k in range(processes):
        ours, theirs = context.Pipe()
        arguments = (theirs, pair, poses[k::processes], first_contact_only)
        context.Process(target=_solve_share, args=arguments, daemon=True).start()
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


def _solve_share(connection: Connection, pair: Pair, poses: Poses, first_contact_only: bool) -> None:
    collect_rarely()  # as the processes of a rebuild do
    solve = partial(_solve_first, pair) if first_contact_only else partial(solve_poses, pair)
    solve(poses[:BATCH])
    connection.send(None)
    connection.recv()
    for start in range(0, len(poses), BATCH):
        solve(poses[start : start + BATCH])
    connection.send(None)


def _solve_first(pair: Pair, poses: Poses) -> Poses:
    return solve_records(pair, SolveOptions(), poses, first_contact_only=True)[:, O_POSE + 11]
