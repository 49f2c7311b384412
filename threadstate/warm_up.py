"""Compiles the numba kernels into the cache: ``python -m threadstate.warm_up``."""

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
    """Whether the cache contains the kernels, so that loading them is fast."""
    return any(_cache().glob("_solve_kernel.solve_rows-*.nbc"))


def load_kernels() -> None:
    """Load every kernel into this process, compiling those that the cache lacks."""
    solve_poses(quarter_twenty_unc(), POSES_DEG)


def load_kernels_exclusively() -> None:
    """As :func:`load_kernels`; if they must be compiled one process of the machine compiles them while others wait."""
    with ExitStack() as stack:
        if not kernels_are_compiled():
            _cache().mkdir(parents=True, exist_ok=True)
            lock = stack.enter_context((_cache() / "compiling").open("w"))
            fcntl.flock(lock, fcntl.LOCK_EX)
        load_kernels()


def main() -> None:
    """Load the kernels and report the progress."""
    if kernels_are_compiled():
        print(f"Loading the kernels from {_cache()} ...", flush=True)
    else:
        print(f"Compiling the kernels into {_cache()}: once, about a minute ...", flush=True)
    start = time.perf_counter()
    load_kernels()
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s.", flush=True)


def _cache() -> Path:
    """The cache directory of this checkout's kernels, below the chosen one."""
    return Path(str(solve_rows.stats.cache_path))


if __name__ == "__main__":
    main()
