"""Compiles the numba kernels once and leaves them in the cache: ``python -m threadstate.warm_up``."""

from __future__ import annotations

import fcntl
import time
from contextlib import ExitStack
from pathlib import Path

from threadstate.contact._solve_kernel import solve_rows
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

POSES_DEG = ((0.0, 0.0, 0.0), (0.0, 0.0, 90.0), (-4.0, 0.0, 131.0))
"""Poses (roll, pitch, phase) whose solution calls every kernel that is called from Python, in each way it is: level and
in phase (a strip of flank), level and out of phase (a patch), tilted (all that the three stages may need)."""


def kernels_are_compiled() -> bool:
    """Whether the cache has the kernels, so that to load them takes a moment and not a minute."""
    return any(_cache().glob("_solve_kernel.solve_rows-*.nbc"))


def load_kernels() -> None:
    """Load every kernel into this process; those that the cache has not are compiled."""
    solve_poses(quarter_twenty_unc(), POSES_DEG)


def load_kernels_exclusively() -> None:
    """As :func:`load_kernels`; where they are still to be compiled, one process of a machine does and others wait."""
    with ExitStack() as stack:
        if not kernels_are_compiled():
            _cache().mkdir(parents=True, exist_ok=True)
            turn = stack.enter_context((_cache() / "compiling").open("w"))
            fcntl.flock(turn, fcntl.LOCK_EX)
        load_kernels()


def main() -> None:
    """Load the kernels, and say what takes so long the first time."""
    if kernels_are_compiled():
        print(f"Loading the kernels from {_cache()} ...", flush=True)
    else:
        print(f"Compiling the kernels into {_cache()}: once, about a minute ...", flush=True)
    start = time.perf_counter()
    load_kernels()
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s.", flush=True)


def _cache() -> Path:
    """Where this checkout's kernels are kept: a folder of its own below the one that was chosen."""
    return Path(str(solve_rows.stats.cache_path))


if __name__ == "__main__":
    main()
