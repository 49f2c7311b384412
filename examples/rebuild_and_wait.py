"""A library that is not there yet: ask for it, watch it being computed, look at what it holds.

The environment's THREADSTATE_KEY is a key that `threadstate key create` has made.
"""

from __future__ import annotations

import argparse
import sys

from rich.progress import Progress

from threadstate.client import Client
from threadstate.errors import ThreadstateError


def main(tilt_max: float, phase_step: float) -> None:
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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tilt_max", nargs="?", type=float, default=4.0, help="largest roll and pitch, deg (default 4)")
    parser.add_argument("phase_step", nargs="?", type=float, default=5.0, help="from phase to phase, deg (default 5)")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
