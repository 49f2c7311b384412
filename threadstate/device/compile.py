"""Loads the kernels of settled states, compiling those that the cache lacks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numba import typeof
from numpy.typing import NDArray

from threadstate.device import _friction_kernel as fk
from threadstate.device import _settle_kernel as sk
from threadstate.device import _turn_kernel as tk
from threadstate.device.assemble import assemble_pose
from threadstate.device.model import default_device
from threadstate.device.settle import device_numbers, new_rows, settle_poses
from threadstate.device.strategy import Strategy
from threadstate.device.turned_leg import new_leg
from threadstate.thread.catalogue import quarter_twenty_unc

Floats = NDArray[np.float64]

POSES_DEG = ((0.0, 3.0, 250.0), (1.0, 0.5, 120.0), (0.0, 0.0, 0.0))
"""Poses that end on contacts, flush, and on threads from a level start: each kernel that Python calls is called."""

ENGAGING_DEG, LITTLE_FRICTION = (1.0, -2.0, 10.0), 0.01
"""A pose that is turned clockwise at once, and a friction with which another settles."""


def load_device() -> None:
    """Call each kernel of settled states without friction that is called from Python."""
    settle_poses(quarter_twenty_unc(), POSES_DEG)


def load_turning() -> None:
    """The same for bolts that are turned, and those with friction."""
    pair = quarter_twenty_unc()
    assemble_pose(pair, *ENGAGING_DEG, strategy=Strategy.CW)
    settle_poses(pair, POSES_DEG[:1], mu=LITTLE_FRICTION)


def compile_device() -> None:
    """Compile what settles poses."""
    pair = quarter_twenty_unc()
    numbers = device_numbers(pair, default_device().in_unit(pair.unit))
    none = np.empty((0, 9)), np.empty(0), np.empty((0, 3))
    sk.settle_rows(*none, 1.0, numbers, pair.bolt.packed, pair.nut.packed, new_rows(0))


def compile_turning() -> None:
    """Compile what turns a bolt without friction."""
    ends = (0, 0.0, 0.0, False)
    tk.turn_with.compile(tuple(typeof(one) for one in (np.empty(0), *ends, *_setting(), new_leg())))


def compile_friction() -> None:
    """Compile what follows a bolt with friction."""
    row, rows, path = np.empty(0), np.empty((0, 0)), (np.empty((0, 0)), np.empty((0, 0, 0)))
    branches = (*path, np.empty(0, dtype=np.int64))
    arguments = (row, row, row, 0.0, False, 0, rows, *_setting(), 0, path, branches)
    fk.follow_friction.compile(tuple(typeof(one) for one in arguments))


def _setting() -> tuple[Floats, ...]:
    """Arrays of the kinds that kernels take: command, device, strip, bolt and nut."""
    pair = quarter_twenty_unc()
    return np.empty(0), np.empty(0), np.empty(0), pair.bolt.packed, pair.nut.packed


def device_is_compiled() -> bool:
    """Whether the cache contains the kernels of settled states without friction."""
    return _is_compiled(sk.settle_rows, "_settle_kernel.settle_rows")


def turning_is_compiled() -> bool:
    """Whether the cache contains the kernels of turning and friction."""
    return _is_compiled(tk.turn_with, "_turn_kernel.turn_with") and _is_compiled(
        fk.follow_friction, "_friction_kernel.follow_friction"
    )


def _is_compiled(kernel: Any, name: str) -> bool:
    return any(Path(str(kernel.stats.cache_path)).glob(f"{name}-*.nbc"))
