"""A sensor told what touches: where the bolt can be, and how far it is to the window.

usage: python examples/where_am_i.py CONTACT...    (stage:bolt_region:nut_region:features, * where not observed)
"""

from __future__ import annotations

import sys

from threadstate.client import Client


def main(*contacts: str) -> None:
    """Print what remains of all orientations and phases, and the way to the window from the middle of each stretch."""
    with Client() as client:
        location = client.locate(contact=contacts).location
        print(f"{location.share:.3%} of all phases remain, at {location.orientations} orientations")
        for one in location.stretches:
            middle = (one.start + one.end) / 2 % 360
            found = client.intervals(one.roll, one.pitch).history.intervals
            here = next(each for each in found if 0 <= (middle - each.start) % 360 < each.end - each.start)
            path = client.path(here.formation.key, roll=one.roll, pitch=one.pitch, phase=middle).path
            way = f"{path.turning:.3f} deg, {path.transitions} transitions" if path else "no window this way"
            print(f"roll {one.roll:g}, pitch {one.pitch:g}, phase {one.start:.3f} to {one.end:.3f}: {way}")


if __name__ == "__main__":
    main(*sys.argv[1:])
