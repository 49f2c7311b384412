"""Compiles the oracle's loops into the cache, so that no test waits for it: ``python -m oracle.warm_up``."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from oracle.chamfer import chamfered_height
from oracle.first_height import first_height
from oracle.follow import Follower, Hand
from oracle.lift import least_lift
from oracle.overlap import overlap_components
from oracle.pose import pose_rotation
from oracle.rest import HeldBolt
from oracle.turn import contact_components_along_turn
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.chamfer import Chamfer

POSE_DEG = (-4.0, 0.0, 131.0)
BELOW_INCH = 1e-4


def main() -> None:
    """Ask each brute force about one pose."""
    pair = quarter_twenty_unc()
    rotation = pose_rotation(*POSE_DEG)
    first = first_height(pair, *POSE_DEG)
    inside = np.array([0.0, 0.0, first.height - BELOW_INCH])
    chamfered_height(replace(pair, chamfer=Chamfer(pair.fit.bolt_minor_diameter)), *POSE_DEG)
    least_lift(pair, rotation, inside)
    overlap_components(pair, rotation, inside)
    # So stiff that it rests where it begins.
    held = HeldBolt(pair, rotation, 1e6 * np.eye(6), centre=0.0, push=1e-6, first=first.height)
    held.overlap(np.zeros(5), first.height)
    held.free_beside(np.zeros(5), first.height, np.full((1, 5), 1e-6), 1e-9)
    held.lowest_by_programs(np.zeros(5), first.height, 1e-5)
    Follower(pair, Hand(np.eye(6), centre=0.0, push=1.0), POSE_DEG, mu=0.1).step(0.0, 0.1)
    point = np.array(first.point)
    contact_components_along_turn(
        pair,
        rotation,
        np.array([0.0, 0.0, first.height]),
        point,
        np.array([0.0, 1.0, 0.0]),
        1.0,
        point.reshape(1, 3),
        steps=2,
    )


if __name__ == "__main__":
    main()
