"""A compliant hand turns a bolt: what happens on the way, and whether the thread engages."""

from __future__ import annotations

import argparse
import sys

from threadstate.client import Client
from threadstate.client.models.assemblies import AssemblyProgress
from threadstate.errors import ThreadstateError


def main(roll: float, pitch: float, phase: float, strategy: str, k_tilt: float) -> None:
    """Print the falls and the snap as the path is computed, then how it ends."""
    device = {"unit": "mm", "k_tilt": k_tilt}
    with Client() as client:
        path = client.assemble(
            roll, pitch, phase, strategy=strategy, device=device, unit="mm", progress=print_what_falls
        )
    print(f"{path.outcome}{''.join(f', {flag}' for flag in path.flags)}: {len(path.path.phase)} equilibria")
    if path.travel is not None:
        print(f"the hand gives way by up to {path.travel.tilt:.2f} deg and {path.travel.shift:.3f} mm")


def print_what_falls(seen: AssemblyProgress) -> None:
    """Print the falls and snaps among new events."""
    for event in seen.events:
        if event.drop is not None:
            print(f"phase {event.phase:8.3f} deg: {event.kind}, down by {event.drop:.4f} mm")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("roll", nargs="?", type=float, default=0.0, help="deg (default 0)")
    parser.add_argument("pitch", nargs="?", type=float, default=-4.0, help="deg (default -4)")
    parser.add_argument("phase", nargs="?", type=float, default=300.0, help="where it settles, deg (default 300)")
    parser.add_argument("--strategy", default="ccw_then_cw", help="ccw_then_cw (default) or cw")
    parser.add_argument("--k-tilt", type=float, default=500.0, help="against tilts, N mm/rad (default 500)")
    try:
        main(**vars(parser.parse_args()))
    except ThreadstateError as error:
        sys.exit(str(error))
