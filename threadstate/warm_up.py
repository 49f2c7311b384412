"""Compiles the numba kernels once and leaves them in the cache: ``python -m threadstate.warm_up``."""

from __future__ import annotations

import os
import time

from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

POSES = ((0.0, 0.0, 0.0), (4.0, 0.0, 185.0), (-4.0, 0.0, 131.0), (1.0, -2.0, 10.0))
"""Poses whose solution runs through every kernel: in phase, flush, three contacts apart, near the snap."""


def main() -> None:
    """Solve a few poses, and say what takes so long the first time."""
    print("Compiling the kernels, once (about a minute; kept in the cache) ...", flush=True)
    start = time.perf_counter()
    solve_poses(quarter_twenty_unc(), POSES)
    print(f"Kernels ready after {time.perf_counter() - start:.1f} s in {os.environ['NUMBA_CACHE_DIR']}", flush=True)


if __name__ == "__main__":
    main()
