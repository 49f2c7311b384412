"""``make histories``: the boundaries of random orientations looked at from outside."""

from __future__ import annotations

import argparse

import numpy as np
from rich.console import Console
from rich.progress import track

from studies.history.boundaries import check_boundaries
from threadstate.history.build import history_of
from threadstate.thread.catalogue import quarter_twenty_unc

SEED = 20
TILT_DEG = 4.0


def main() -> None:
    """Compute histories, solve states beside their boundaries, print what was found."""
    parser = argparse.ArgumentParser(prog="python -m studies.history", description=__doc__)
    parser.add_argument("--orientations", type=int, default=20, help="how many, off the grid [%(default)s]")
    parser.add_argument("--seed", type=int, default=SEED, help="of their choice [%(default)s]")
    arguments = parser.parse_args()
    pair = quarter_twenty_unc()
    chosen = np.random.default_rng(arguments.seed).uniform(-TILT_DEG, TILT_DEG, (arguments.orientations, 2)).tolist()
    console = Console(stderr=True)
    histories = [history_of(pair, *one) for one in track(chosen, "histories", console=console)]
    check = check_boundaries(pair, histories)
    print(
        f"{check.boundaries} boundaries of {len(histories)} orientations; {check.undecided} beside an undecided stretch"
    )
    print(f"{check.alike} with the same labels on both sides and nothing that happens in between")
    print(f"{check.flickering} hidden by round-off, over {check.flicker_deg:.4f} deg in all")
    print(f"{len(check.failures)} of {check.sides} sides with other labels than the interval there:")
    for one in check.failures:
        print(f"  roll {one.roll_deg!r}, pitch {one.pitch_deg!r}, phase {one.phase_deg!r}")


if __name__ == "__main__":
    main()
