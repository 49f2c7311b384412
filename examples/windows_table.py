"""Where does the bolt fall into the thread? Windows and drops of all orientations, the most tolerant first.

usage: python examples/windows_table.py [UNIT]    (in or mm)
"""

from __future__ import annotations

import sys

from threadstate.client import Client


def main(unit: str | None = None) -> None:
    """Print a line for each clearance window."""
    with Client() as client:
        answer = client.windows(unit=unit)
    print(f"roll  pitch  width (deg)  drop ({answer.unit})     falls at once")
    for one in sorted(answer.windows, key=lambda window: -window.width):
        falls = f"{one.snap.fall:.6f}" if one.snap else "-"
        print(f"{one.roll:>4g}  {one.pitch:>5g}  {one.width:>11.3f}  {one.drop:z12.6f}  {falls:>13}")


if __name__ == "__main__":
    main(*sys.argv[1:])
