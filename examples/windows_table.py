"""How far does the bolt fall, and where? Snaps and clearance windows of all orientations, the largest fall first."""

from __future__ import annotations

import argparse
import sys

from threadstate.client import Client
from threadstate.errors import ThreadstateError
from threadstate.responses.documents import OrientationWindowsDocument


def order(one: OrientationWindowsDocument) -> tuple[bool, float]:
    """Orientations that snap first, the largest fall first."""
    return one.snap is None, -(one.steepest if one.snap is None else one.snap.fall)


def main(unit: str | None, library: str) -> None:
    """Print a line for each orientation."""
    with Client() as client:
        answer = client.windows(library=library, unit=unit)
    print(f"lengths in {answer.unit}, angles in deg")
    print("roll  pitch  snap from        to  whole fall      jump  within 3 deg  windows, width")
    for one in sorted(answer.orientations, key=order):
        snap = one.snap
        cells = f"{'no snap':>9}  {'':>8}  {'':>10}  {'':>8}"
        if snap is not None:
            cells = f"{snap.start:9.3f}  {snap.end % 360.0:8.3f}  {snap.fall:10.6f}  {snap.jump:8.6f}"
        windows = ", ".join(f"{window.width:.3f}" for window in one.windows)
        print(f"{one.roll:>4g}  {one.pitch:>5g}  {cells}  {one.steepest:12.6f}  {windows}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("unit", nargs="?", choices=("in", "mm"), help="of lengths (default: the library's)")
    parser.add_argument("--library", default="latest", help="its number, its designation, or latest")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
