"""Formations from which the window is sure to come, by how far the bolt has to be turned at most.

usage: python examples/shortest_turn.py [HOW_MANY]
"""

from __future__ import annotations

import sys

from threadstate.client import Client


def main(how_many: int = 10) -> None:
    """Print the formations nearest to the window, and every step from the farthest."""
    with Client() as client:
        formations = client.formations().formations
        sure = [one for one in formations if 0 < one.to_window.occurrences == one.to_window.reaching]
        near = sorted((one.to_window.most or 0.0, one.key, one.text) for one in sure)
        print(f"after {len(near)} of {len(formations)} formations a window comes wherever they occur")
        for turning, key, text in near[:how_many]:
            print(f"{turning:10.3f} deg  {key}  {text}")
        _, farthest, _ = near[-1]
        path = client.path(farthest).path
    print("\nfrom the farthest:")
    for step in path.steps if path else ():
        print(f"{step.turning:10.3f} deg  {step.formation}  {step.text}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
