"""Compiles the numba kernels into the cache: ``python -m threadstate.warm_up``.

With ``--serving`` only those that a service and its workers call: not those of bolts that are turned, or with friction.
"""

from __future__ import annotations

import fcntl
import gc
import os
import sys
import time
import traceback
from collections.abc import Callable
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from threading import Thread

import numpy as np

from threadstate._compile import Ahead, ahead, is_cached
from threadstate.contact._record_kernel import RECORD_SIZE
from threadstate.contact._solve_kernel import NONE_BESIDE, solve_rows
from threadstate.device.compile import (
    beside_ahead,
    device_ahead,
    friction_ahead,
    load_device,
    load_turning,
    turning_ahead,
    turning_is_compiled,
)
from threadstate.history.estimates import estimates_ahead, load_estimates
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options
from threadstate.state.solve import solve_poses
from threadstate.statics._effort_kernel import turn_effort
from threadstate.statics.compile import load_statics
from threadstate.thread.catalogue import quarter_twenty_unc

LEVEL_DEG = ((0.0, 0.0, 0.0), (0.0, 0.0, 90.0))
"""Level poses (roll, pitch, phase): one in phase, on a strip of flank, and one that is not, on a patch."""

POSES_DEG = (*LEVEL_DEG, (-4.0, 0.0, 131.0))
"""Poses whose solution calls every kernel that is called from Python, in each way it is: with a tilted one, which calls
all that the three stages may need."""

LOOKS_S = 0.5
"""How often a copy of the process looks whether it is wanted still."""


def kernels_are_compiled() -> bool:
    """Whether the cache contains the kernels that :func:`load_kernels` loads, so that this is fast."""
    served = (*kernels_ahead(serving=True), *beside_ahead())
    return is_cached(turn_effort) and all(is_cached(one.kernel) for one in served)


def load_kernels() -> None:
    """Load what serving needs into this process, compiling what the cache lacks: all but turning and friction."""
    pair = quarter_twenty_unc()
    states = solve_poses(pair, POSES_DEG)
    load_estimates(pair)
    load_statics(pair, states[1:])
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
    """Load the kernels and report the progress; where the cache has none, compile them by all cores."""
    start = time.perf_counter()
    if kernels_are_compiled() and (serving or turning_is_compiled()):
        print(f"Loading the kernels from {_cache()} ...", flush=True)
    else:
        duration = "one to two minutes" if serving else "one to three minutes"
        print(f"Compiling the kernels into {_cache()}: once, {duration} ...", flush=True)
        wait_for([in_a_copy(compile_level), in_a_copy(partial(compile_tilted, serving=serving))])
    load_kernels()
    if not serving:
        load_turning()
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s.", flush=True)


def in_a_copy(compile_kernels: Callable[[], None]) -> int:
    """Compile in a copy of this process, and return its number; what fails there is compiled where it is called first.

    The copy looks for no garbage: there is little, and each look at all that numba has made takes a second. It ends
    with this process, if that is killed meanwhile.
    """
    original = os.getpid()
    process = os.fork()
    if process == 0:
        failed = 1
        try:
            Thread(target=_end_with, args=(original,), daemon=True).start()
            gc.disable()
            compile_kernels()
            failed = 0
        except Exception:
            traceback.print_exc()
        finally:
            os._exit(failed)
    return process


def _end_with(process: int) -> None:
    """End this process when the one that made it has ended."""
    while os.getppid() == process:
        time.sleep(LOOKS_S)
    os._exit(1)


def wait_for(copies: list[int]) -> None:
    """Wait until these copies of the process have ended."""
    for one in copies:
        os.waitpid(one, 0)


def compile_tilted(*, serving: bool) -> None:
    """Compile what solves tilted poses, settles and, not for ``serving`` alone, turns bolts."""
    wait_for([compile_halves(one) for one in kernels_ahead(serving=serving) if not is_cached(one.kernel)])


def compile_halves(one: Ahead) -> int:
    """Type and lower a kernel with all that it calls in this process, and have a copy of it make the machine code.

    The next kernel finds what both call as it was lowered here, and need not wait for the other half. Returns the
    copy's number.
    """
    one.kernel.as_callee().compile(one.types)
    return in_a_copy(partial(one.kernel.compile, one.types))


def kernels_ahead(*, serving: bool) -> list[Ahead]:
    """What solves tilted poses, settles and turns bolts: first what has the most machine code."""
    pair = quarter_twenty_unc()
    both = pair.bolt.packed, pair.nut.packed
    poses, records = np.empty((0, 3)), np.empty((0, RECORD_SIZE))
    solver = ahead(solve_rows, poses, packed_options(pair, SolveOptions()), *both, NONE_BESIDE, records)
    turned = [] if serving else [friction_ahead(), turning_ahead()]
    return [*turned, solver, device_ahead(), estimates_ahead(pair)]


def compile_level() -> None:
    """Compile what solves level poses, the statics and small kernels: what solves tilted ones calls little of it."""
    pair = quarter_twenty_unc()
    load_statics(pair, solve_poses(pair, LEVEL_DEG)[1:])
    for one in beside_ahead():
        one.kernel.compile(one.types)


def _cache() -> Path:
    """The cache directory of this checkout's kernels, below the chosen one."""
    return Path(str(solve_rows.stats.cache_path))


if __name__ == "__main__":
    main(serving="--serving" in sys.argv[1:])
