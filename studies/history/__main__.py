"""``make histories``: checks boundaries of random orientations by states beside them, the grid's by a denser start."""

from __future__ import annotations

import argparse

import numpy as np
from rich.console import Console
from rich.progress import track

from studies.history.boundaries import SAME_DEG, check_boundaries, check_density
from studies.history.steadiness import check_steadiness
from threadstate.history.build import history_of
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

SEED = 20
TILT_DEG = 4.0
GRID_DEG = range(-4, 5)


def main() -> None:
    """Compute histories, solve states beside their boundaries or start them denser, print what was found."""
    parser = argparse.ArgumentParser(prog="python -m studies.history", description=__doc__)
    parser.add_argument("--orientations", type=int, default=20, help="how many, off the grid [%(default)s]")
    parser.add_argument("--seed", type=int, default=SEED, help="of their choice [%(default)s]")
    parser.add_argument("--phases", type=int, default=50, help="on either side of close contacts [%(default)s]")
    parser.add_argument("--times", type=int, help="instead, start the grid's 81 histories this many times as dense")
    arguments = parser.parse_args()
    pair = quarter_twenty_unc()
    if arguments.times:
        _print_density(pair, arguments.times)
    else:
        _print_boundaries(pair, arguments.orientations, arguments.seed, arguments.phases)


def _print_boundaries(pair: Pair, orientations: int, seed: int, phases: int) -> None:
    chosen = np.random.default_rng(seed).uniform(-TILT_DEG, TILT_DEG, (orientations, 2)).tolist()
    console = Console(stderr=True)
    histories = [history_of(pair, *one) for one in track(chosen, "histories", console=console)]
    check = check_boundaries(pair, histories)
    print(
        f"{check.boundaries} boundaries of {len(histories)} orientations; {check.undecided} beside an undecided stretch"
    )
    print(f"{check.alike} with the same labels on both sides and nothing that happens in between")
    print(f"{len(check.failures)} of {check.sides} sides with other labels than the interval there:")
    for one in check.failures:
        print(f"  roll {one.roll_deg!r}, pitch {one.pitch_deg!r}, phase {one.phase_deg!r}")
    steady = check_steadiness(pair, histories, phases)
    print(f"{steady.boundaries} boundaries with contacts close to each other; {steady.phases} phases beside these:")
    print(f"{len(steady.changes)} changes within intervals")
    for change in steady.changes:
        place = f"roll {change.roll_deg!r}, pitch {change.pitch_deg!r}"
        print(f"  {place}, phase {change.low_deg!r} to {change.high_deg!r}")


def _print_density(pair: Pair, times: int) -> None:
    check = check_density(pair, [(float(roll), float(pitch)) for roll in GRID_DEG for pitch in GRID_DEG], times)
    print(f"{check.boundaries} boundaries from {check.solves} poses")
    print(f"{check.dense_boundaries} boundaries from {check.dense_solves} poses, the start {times} times as dense")
    undecided = sum(one.undecided for one in check.unmatched)
    print(f"{undecided} elsewhere beside undecided stretches")
    print(f"{len(check.unmatched) - undecided} others that only one of both has within {SAME_DEG:g} deg:")
    for one in check.unmatched:
        if not one.undecided:
            place = f"roll {one.roll_deg:g}, pitch {one.pitch_deg:g}, phase {one.phase_deg:.7f}"
            print(f"  {place}, {'dense' if one.dense else 'usual'}, {one.nearest_deg:.1e} deg from the other's nearest")


if __name__ == "__main__":
    main()
