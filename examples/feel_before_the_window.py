"""The device holds the bolt tilted, its phase is not known: what will be felt, for how long, and where does it snap.

Any tilt within 10 deg may be asked about: one that the library does not hold is computed.
"""

from __future__ import annotations

import argparse
import sys

from threadstate.client import Client, NotFoundError
from threadstate.client.models.network import ComputedIntervals, IntervalsAnswer
from threadstate.errors import ThreadstateError
from threadstate.responses.documents import FallsDocument

MOST = 12


def intervals(client: Client, roll: float, pitch: float, library: str) -> IntervalsAnswer | ComputedIntervals:
    """What the library holds of a tilt of its grid, what is computed of any other."""
    try:
        return client.intervals(roll, pitch, library=library)
    except NotFoundError:
        return client.computed_intervals(roll, pitch, library=library)


def snap_in_words(falls: FallsDocument) -> str:
    """How far the bolt goes down where it goes down most steeply, and over which phases."""
    snap = falls.snap
    if snap is None:
        where = "" if falls.steepest_from is None else f", from phase {falls.steepest_from:.3f} deg on"
        return f"no snap: falls by {falls.steepest:.6f} within 3 deg at most{where}"
    jump = f"{snap.jump:.6f} of it at once at {snap.jump_at:.3f} deg" if snap.jump_at is not None else "without a jump"
    return f"snap: falls by {snap.fall:.6f} from phase {snap.start:.3f} to {snap.end % 360.0:.3f} deg, {jump}"


def main(roll: float, pitch: float, library: str) -> None:
    """Print what the sensors can tell apart at this tilt, the snap, and where the bolt can go on down."""
    with Client() as client:
        answer = intervals(client, roll, pitch, library)
    print(f"roll {roll:g}, pitch {pitch:g} deg; lengths in {answer.unit}")
    shares: dict[str, float] = {}
    for one in answer.history.intervals:
        felt = one.formation.text + (" [window]" if one.in_window else "")
        shares[felt] = shares.get(felt, 0.0) + (one.end - one.start) / 360.0
    by_share = sorted(shares.items(), key=lambda share: -share[1])
    for felt, share in by_share[:MOST]:
        print(f"{share:7.2%}  {felt}")
    print(f"{sum(share for _, share in by_share[MOST:]):7.2%}  {len(by_share[MOST:])} others")
    print(snap_in_words(answer.history))
    for window in answer.history.windows:
        print(f"window: can go on down from phase {window.enter:.3f} to {window.leave % 360.0:.3f} deg")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("roll", nargs="?", type=float, default=4.0, help="degrees (default 4)")
    parser.add_argument("pitch", nargs="?", type=float, default=0.0, help="degrees (default 0)")
    parser.add_argument("--library", default="latest", help="its number, its designation, or latest")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
