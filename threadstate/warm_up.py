"""Compiles the numba kernels into the cache: ``python -m threadstate.warm_up``.

With ``--serving`` only those that a service and its workers call: not those of bolts that are turned, or with friction.
"""

from __future__ import annotations

import fcntl
import subprocess  # nosec B404
import sys
import time
from contextlib import ExitStack
from pathlib import Path

import numpy as np

from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.contact._solve_kernel import solve_with
from threadstate.device.compile import device_is_compiled, load_device, load_turning, turning_is_compiled
from threadstate.history.estimates import estimates_are_compiled, load_estimates
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options
from threadstate.state.solve import solve_poses
from threadstate.statics.compile import load_statics, statics_are_compiled
from threadstate.thread.catalogue import quarter_twenty_unc

POSES_DEG = ((0.0, 0.0, 0.0), (0.0, 0.0, 90.0), (-4.0, 0.0, 131.0))
"""Poses (roll, pitch, phase) whose solution calls every kernel that is called from Python, in each way it is: level and
in phase (a strip of flank), level and out of phase (a patch), tilted (all that the three stages may need)."""

COMPILE_SEARCH = "from threadstate.contact._search_kernel import search_address; search_address()"
COMPILE_DEVICE = "from threadstate.device.compile import compile_without_search; compile_without_search()"
COMPILE_TURNING = "from threadstate.device.compile import compile_turning; compile_turning()"
COMPILE_FRICTION = "from threadstate.device.compile import compile_friction; compile_friction()"
COMPILE_STATICS = "from threadstate.statics.compile import compile_without_states; compile_without_states()"

_LAST_COMPILED = ("_solve_kernel.solve_with-*.nbc", "_stage_kernel.earliest-*.nbc")


def kernels_are_compiled() -> bool:
    """Whether the cache contains the kernels that :func:`load_kernels` loads, so that this is fast."""
    solver_is_compiled = all(any(_cache().glob(name)) for name in _LAST_COMPILED)
    return solver_is_compiled and estimates_are_compiled() and statics_are_compiled() and device_is_compiled()


def load_kernels() -> None:
    """Load what serving needs into this process, compiling what the cache lacks: all but turning and friction."""
    pair = quarter_twenty_unc()
    states = solve_poses(pair, POSES_DEG)
    load_estimates(pair)
    load_statics(pair, states)
    load_device()


def load_kernels_exclusively() -> None:
    """As :func:`load_kernels`; if they must be compiled one process of the machine compiles them while others wait."""
    with ExitStack() as stack:
        if not kernels_are_compiled():
            _cache().mkdir(parents=True, exist_ok=True)
            lock = stack.enter_context((_cache() / "compiling").open("w"))
            fcntl.flock(lock, fcntl.LOCK_EX)
        load_kernels()


def main(*, serving: bool = False) -> None:
    """Load the kernels and report the progress; where the cache has none, processes beside this one compile them."""
    start = time.perf_counter()
    others: tuple[str, ...] = (COMPILE_SEARCH, COMPILE_DEVICE, COMPILE_STATICS)
    if not serving:
        others += (COMPILE_TURNING, COMPILE_FRICTION)
    if kernels_are_compiled() and (serving or turning_is_compiled()):
        print(f"Loading the kernels from {_cache()} ...", flush=True)
    else:
        duration = "a minute or two" if serving else "some minutes"
        print(f"Compiling the kernels into {_cache()}: once, {duration} ...", flush=True)
        # Each finds in the cache what the other has compiled by then; what fails there is compiled here.
        with ExitStack() as stack:
            for code in others:
                stack.enter_context(subprocess.Popen([sys.executable, "-c", code]))  # nosec B603 - fixed code
            compile_all_but_search()
    load_kernels()
    if not serving:
        load_turning()
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s.", flush=True)


def compile_all_but_search() -> None:
    """Compile what solves poses, but for the search that it is given the address of: for no pose there is no search.

    With it what follows contacts between two states.
    """
    pair = quarter_twenty_unc()
    none = np.empty((0, 3))
    options = packed_options(pair, SolveOptions())
    solve_with(none, options, pair.bolt.packed, pair.nut.packed, 0, np.empty((0, RECORD_SIZE)))
    load_estimates(pair)


def _cache() -> Path:
    """The cache directory of this checkout's kernels, below the chosen one."""
    return Path(str(solve_with.stats.cache_path))


if __name__ == "__main__":
    main(serving="--serving" in sys.argv[1:])
