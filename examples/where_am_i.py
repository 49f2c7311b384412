"""A sensor told what touches: where the bolt can be, and how far it is to the window."""

from __future__ import annotations

import argparse
import sys

from threadstate.client import Client
from threadstate.errors import ThreadstateError


def main(contacts: list[str], library: str) -> None:
    """Print what remains of all orientations and phases, and the way to the window from the middle of each stretch."""
    with Client() as client:
        location = client.locate(contact=contacts, library=library).location
        print(f"{location.share:.3%} of all phases remain, at {location.orientations} orientations")
        for one in location.stretches:
            middle = (one.start + one.end) / 2 % 360
            found = client.intervals(one.roll, one.pitch, library=library).history.intervals
            here = next(each for each in found if 0 <= (middle - each.start) % 360 < each.end - each.start)
            path = client.path(here.formation.key, library=library, roll=one.roll, pitch=one.pitch, phase=middle).path
            way = f"{path.turning:.3f} deg, {path.transitions} transitions" if path else "no window this way"
            print(f"roll {one.roll:g}, pitch {one.pitch:g}, phase {one.start:.3f} to {one.end:.3f}: {way}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "contacts", nargs="+", metavar="CONTACT", help="stage:bolt_region:nut_region:features, * where not observed"
    )
    parser.add_argument("--library", default="latest", help="its number, its designation, or latest")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
