"""The device holds the bolt tilted, its phase is not known: what will be felt, and for how long.

usage: python examples/feel_before_the_window.py [ROLL] [PITCH]    (degrees, of the library's grid; default 4 0)
"""

from __future__ import annotations

import sys

from threadstate.client import Client

MOST = 12


def main(roll: float = 4.0, pitch: float = 0.0) -> None:
    """Print what the sensors can tell apart at this tilt, and where the bolt falls in."""
    with Client() as client:
        answer = client.intervals(roll, pitch)
    print(f"roll {roll:g}, pitch {pitch:g} deg; lengths in {answer.unit}")
    shares: dict[str, float] = {}
    for interval in answer.history.intervals:
        felt = interval.formation.text + (" [window]" if interval.in_window else "")
        shares[felt] = shares.get(felt, 0.0) + (interval.end - interval.start) / 360.0
    by_share = sorted(shares.items(), key=lambda one: -one[1])
    for felt, share in by_share[:MOST]:
        print(f"{share:7.2%}  {felt}")
    print(f"{sum(share for _, share in by_share[MOST:]):7.2%}  {len(by_share[MOST:])} others")
    for window in answer.history.windows:
        snap = f"a snap of {window.snap.fall:.6f} at {window.snap.phase:.3f}" if window.snap else "no snap"
        print(f"falls in from {window.enter:.3f} to {window.leave:.3f} deg, {window.drop:.6f} deep, with {snap}")


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
