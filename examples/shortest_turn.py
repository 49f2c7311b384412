"""Formations from which the window is sure to come, by how far the bolt has to be turned at most."""

from __future__ import annotations

import argparse
import sys

from threadstate.client import Client
from threadstate.errors import ThreadstateError


def main(how_many: int, library: str) -> None:
    """Print the formations nearest to the window, and every step from the farthest."""
    with Client() as client:
        formations = client.formations(library=library).formations
        sure = [one for one in formations if 0 < one.to_window.occurrences == one.to_window.reaching]
        near = sorted((one.to_window.most or 0.0, one.key, one.text) for one in sure)
        print(f"after {len(near)} of {len(formations)} formations a window comes wherever they occur")
        for turning, key, text in near[:how_many]:
            print(f"{turning:10.3f} deg  {key}  {text}")
        if not near:
            return
        _, farthest, _ = near[-1]
        path = client.path(farthest, library=library).path
    print("\nfrom the farthest:")
    for step in path.steps if path else ():
        print(f"{step.turning:10.3f} deg  {step.formation}  {step.text}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("how_many", nargs="?", type=int, default=10, help="formations shown (default 10)")
    parser.add_argument("--library", default="latest", help="its number, its designation, or latest")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
