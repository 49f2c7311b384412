"""A library that is not there yet: ask for it, watch it being computed, look at what it holds.

usage: THREADSTATE_KEY=... python examples/rebuild_and_wait.py [TILT_MAX] [PHASE_STEP]    (degrees; default 4 5)
"""

from __future__ import annotations

import sys

from rich.progress import Progress

from threadstate.client import Client


def main(tilt_max: float = 4.0, phase_step: float = 5.0) -> None:
    """Print the counts of a library once workers have computed it."""
    with Client() as client:
        job = client.ask(grid={"tilt_max": tilt_max, "tilt_step": 1.0, "phase_step": phase_step})
        with Progress() as bar:
            task = bar.add_task(f"job {job.id}")
            done = job.wait(lambda seen: bar.update(task, completed=seen.committed, total=seen.chunks))
        library = client.library(done.library or "latest")
    print(f"library {library.id}: {library.state_count} states")
    for name, count in library.counts.classes.items():
        print(f"{count:>8}  {name}")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
