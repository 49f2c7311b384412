"""The exact method with settings that no user has: proved threads, another density of brackets."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from threadstate.contact import _initial_box_kernel as initial_box
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.state.decode import decoded_states
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair
from threadstate.thread.profile import outline_is_convex

Pose = tuple[float, float, float]


def proved_state(pair: Pair, pose: Pose, options: SolveOptions) -> ContactState:
    """The state of a tilted pose, thread on thread searched by branch and bound in every stage: as tight as it gets.

    Raises:
        UnresolvedPoseError: boxes stay undecided.
    """
    packed = np.zeros(sk.OPTIONS_SIZE)
    packed[sk.S_TURN_LIMIT] = math.radians(options.turn_limit_deg)
    packed[sk.S_TIE] = options.tie_tolerance * pair.thread_pitch
    packed[sk.S_CONVEX] = float(outline_is_convex(pair.bolt) and outline_is_convex(pair.nut))
    packed[sk.S_PROVE] = 1.0
    poses = np.array([pose])
    row = np.empty((1, rk.RECORD_SIZE))
    sk.solve_rows(np.radians(poses), packed, pair.bolt.packed, pair.nut.packed, sk.NONE_BESIDE, row)
    return decoded_states(pair, options, poses, row)[0]


def run_with_boxes(boxes: int, job: bytes) -> bytes:
    """What ``studies.chart.bracketing`` answers to a pickled job, its kernels compiled for that many boxes round.

    The number is a constant of the kernels, so that they lose no time to it; another one takes a process and a cache of
    compiled kernels of its own.
    """
    compiled = Path(os.environ["NUMBA_CACHE_DIR"]).parent / f"bracketing-{boxes}"
    environment = os.environ | {"THREADSTATE_NUMBA_CACHE_DIR": str(compiled)}
    command = [sys.executable, "-m", "studies.chart.bracketing", str(boxes)]
    return subprocess.run(command, input=job, env=environment, check=True, capture_output=True).stdout


def use_boxes(boxes: int) -> None:
    """Make kernels that are not compiled yet begin with that many boxes."""
    initial_box.INITIAL_BOXES = boxes
