"""A thousand poses of one's own: how often a bolt that is held within a tolerance comes to rest.

usage: python examples/solve_own_poses.py [SPREAD] [HOW_MANY]    (degrees of roll and pitch; default 1 1000)
"""

from __future__ import annotations

import random
import sys
from collections import Counter

from threadstate.client import Client


def main(spread: str = "1", how_many: str = "1000") -> None:
    """Print the share of each class, and the steepest first turn."""
    rng = random.Random(1)
    tilt = float(spread)
    poses = [(rng.gauss(0, tilt), rng.gauss(0, tilt), rng.uniform(0, 360)) for _ in range(int(how_many))]
    within = [pose for pose in poses if max(abs(pose[0]), abs(pose[1])) <= 10]
    with Client() as client:
        states = client.solve(within).states
    for name, count in Counter(state.state_class for state in states).most_common():
        print(f"{count / len(states):7.2%}  {name}")
    turned = [(state.turns[0], state) for state in states if state.turns[0] is not None]
    turn, steepest = max(turned, key=lambda one: one[0])
    print(
        f"the largest turn to the second contact, {turn:.3f} deg, is at roll {steepest.roll:.3f}, "
        f"pitch {steepest.pitch:.3f}, phase {steepest.phase:.3f}"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
