"""Loads the kernels of settled states, compiling those that the cache lacks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from threadstate._compile import Ahead, ahead, is_cached
from threadstate.device import _chart_kernel as ck
from threadstate.device import _flush_kernel as flush
from threadstate.device import _friction_kernel as fk
from threadstate.device import _patch_kernel as pk
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


def device_ahead() -> Ahead:
    """What settles poses."""
    pair = quarter_twenty_unc()
    numbers = device_numbers(pair, default_device().in_unit(pair.unit))
    none = np.empty((0, 9)), np.empty(0), np.empty((0, 3))
    return ahead(sk.settle_rows, *none, 1.0, numbers, pair.bolt.packed, pair.nut.packed, new_rows(0))


def beside_ahead() -> list[Ahead]:
    """What is called beside that, for single results: little of it calls what settles."""
    row, rows = np.empty(0), np.empty((0, 0))
    pair = quarter_twenty_unc()
    both = pair.bolt.packed, pair.nut.packed
    return [
        ahead(sk.set_command, row, 0.0, row, row),
        ahead(ck.set_place, row, row, row),
        ahead(ck.elastic_energy, row, row, row),
        ahead(flush.set_flush, row, row),
        ahead(flush.centre_of_pressure, row, 0.0, row, row, row),
        ahead(pk.set_patch_hull, 0.0, 0.0, row, *both, rows, rows),
    ]


def turning_ahead() -> Ahead:
    """What turns a bolt without friction."""
    return ahead(tk.turn_with, np.empty(0), 0, 0.0, 0.0, False, *_setting(), new_leg())


def friction_ahead() -> Ahead:
    """What follows a bolt with friction."""
    row, rows, path = np.empty(0), np.empty((0, 0)), (np.empty((0, 0)), np.empty((0, 0, 0)))
    branches = (*path, np.empty(0, dtype=np.int64))
    return ahead(fk.follow_friction, row, row, row, 0.0, False, 0, rows, *_setting(), 0, path, branches)


def _setting() -> tuple[Floats, ...]:
    """Arrays of the kinds that kernels take: command, device, strip, bolt and nut."""
    pair = quarter_twenty_unc()
    return np.empty(0), np.empty(0), np.empty(0), pair.bolt.packed, pair.nut.packed


def turning_is_compiled() -> bool:
    """Whether the cache contains the kernels of turning and friction."""
    return is_cached(tk.turn_with) and is_cached(fk.follow_friction)
