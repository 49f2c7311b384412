"""A thousand poses of one's own: which states a bolt meets that is held within a tolerance."""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter

from threadstate.client import Client
from threadstate.errors import ThreadstateError


def main(spread: float, how_many: int, library: str | None) -> None:
    """Print the share of each class, and the steepest first turn."""
    rng = random.Random(1)
    poses = [(rng.gauss(0, spread), rng.gauss(0, spread), rng.uniform(0, 360)) for _ in range(how_many)]
    within = [pose for pose in poses if max(abs(pose[0]), abs(pose[1])) <= 10]
    with Client() as client:
        states = client.solve(within, library=library).states
    for name, count in Counter(state.state_class for state in states).most_common():
        print(f"{count / len(states):7.2%}  {name}")
    turned = [(state.turns[0], state) for state in states if state.turns[0] is not None]
    if not turned:
        return
    turn, steepest = max(turned, key=lambda one: one[0])
    print(
        f"the largest turn to the second contact, {turn:.3f} deg, is at roll {steepest.roll:.3f}, "
        f"pitch {steepest.pitch:.3f}, phase {steepest.phase:.3f}"
    )


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("spread", nargs="?", type=float, default=1.0, help="of roll and pitch, deg (default 1)")
    parser.add_argument("how_many", nargs="?", type=int, default=1000, help="poses, 1 to 1000 (default 1000)")
    parser.add_argument("--library", help="whose pair and tolerances (default: a 1/4-20 UNC and the usual ones)")
    arguments = parser.parse_args()
    if not (0.0 <= arguments.spread <= 10.0 and 1 <= arguments.how_many <= 1000):
        parser.error("the spread is 0 to 10 deg, the number of poses 1 to 1000")
    try:
        main(**vars(arguments))
    except ThreadstateError as error:
        sys.exit(str(error))
