"""Compiles the numba kernels once and leaves them in the cache: ``python -m threadstate.warm_up``."""

from __future__ import annotations

import time
from pathlib import Path

from threadstate.contact._solve_kernel import solve_rows
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

POSES_DEG = ((0.0, 0.0, 0.0), (0.0, 0.0, 90.0), (-4.0, 0.0, 131.0))
"""Poses (roll, pitch, phase) whose solution calls every kernel that is called from Python, in each way it is: level and
in phase (a strip of flank), level and out of phase (a patch), tilted (all that the three stages may need)."""


def main() -> None:
    """Solve a few poses, and say what takes so long the first time."""
    # A folder of its own for each checkout, below the one that was chosen.
    cache = Path(str(solve_rows.stats.cache_path))
    if any(cache.glob("_solve_kernel.solve_rows-*.nbc")):
        print(f"Loading the kernels from {cache} ...", flush=True)
    else:
        print(f"Compiling the kernels into {cache}: once, about a minute ...", flush=True)
    start = time.perf_counter()
    solve_poses(quarter_twenty_unc(), POSES_DEG)
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s.", flush=True)


if __name__ == "__main__":
    main()
