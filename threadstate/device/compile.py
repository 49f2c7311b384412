"""Loads the kernels of settled states, compiling those that the cache lacks."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from threadstate.device import _settle_kernel as sk
from threadstate.device.model import default_device
from threadstate.device.settle import device_numbers, new_rows, settle_poses
from threadstate.thread.catalogue import quarter_twenty_unc

POSES_DEG = ((0.0, 3.0, 250.0), (1.0, 0.5, 120.0), (0.0, 0.0, 0.0))
"""Poses that end on contacts, flush, and on threads from a level start: each kernel that Python calls is called."""


def load_device() -> None:
    """Call each kernel that is called from Python."""
    settle_poses(quarter_twenty_unc(), POSES_DEG)


def compile_without_search() -> None:
    """Compile what settles poses, but for the search that it is given the address of: for no pose there is none."""
    pair = quarter_twenty_unc()
    numbers = device_numbers(pair, default_device().in_unit(pair.unit))
    none = np.empty((0, 9)), np.empty(0), np.empty((0, 3))
    sk.settle_with(*none, 1.0, numbers, pair.bolt.packed, pair.nut.packed, 0, new_rows(0))


def device_is_compiled() -> bool:
    """Whether the cache contains the kernels."""
    return any(Path(str(sk.settle_with.stats.cache_path)).glob("_settle_kernel.settle_with-*.nbc"))
