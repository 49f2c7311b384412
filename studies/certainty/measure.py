"""Solves poses with the kernels of the folder that it is started in; a process of its own for each setting."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options
from threadstate.thread.catalogue import pair_by_designation

COLUMNS = [rk.O_STATUS, rk.O_POSE + 11, rk.O_LAMBDA, rk.O_MU, rk.O_EMBEDMENT]
"""Status, height of the first pose, second and third turn (rad), embedment."""


def main() -> None:
    """Solve the poses of one file into another: per pose the numbers of ``COLUMNS`` and processor seconds."""
    given, results, prove = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3] == "prove"
    found: dict[str, np.ndarray] = {}
    for name, poses_deg in np.load(given).items():
        pair = pair_by_designation(name)
        options = packed_options(pair, SolveOptions()).copy()
        options[sk.S_PROVE] = float(prove)
        record = np.empty((1, rk.RECORD_SIZE))
        poses = np.radians(poses_deg)
        sk.solve_rows(poses[:1], options, pair.bolt.packed, pair.nut.packed, sk.NONE_BESIDE, record)
        rows = np.empty((len(poses), len(COLUMNS) + 1))
        for row, pose in zip(rows, poses, strict=True):
            start = time.process_time()
            sk.solve_rows(pose[None], options, pair.bolt.packed, pair.nut.packed, sk.NONE_BESIDE, record)
            row[-1] = time.process_time() - start
            row[:-1] = record[0, COLUMNS]
        found[name] = rows
    with results.open("wb") as file:
        np.savez(file, **found)  # type: ignore[arg-type]


if __name__ == "__main__":
    main()
