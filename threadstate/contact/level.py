"""The pose without tilt: the one whose contact is a patch from the start (method, section 5).

With roll = pitch = 0 the base is level. Unless the threads are in phase its outline overlaps the nut's surface and the
bolt comes to rest on it at height 0. In phase it drops through until the flanks meet along a strip: with the profiles
shifted by ``delta`` along the axis, f_bolt(s + delta) <= f_nut(s) for all s exactly while delta is at most the axial
play of the positive flanks and -delta that of the negative ones, and delta = k phase - h.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from threadstate.contact import _flush_kernel as fk
from threadstate.contact import _record_kernel as rk
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._stage_kernel import FLUSH, rotation
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits


@dataclass(frozen=True, slots=True)
class LevelContact:
    """Where a level bolt comes to rest: whether on the thread (else on the surface), and the height of its origin.

    ``height`` is a length in the pair's unit, in the nut's frame.
    """

    height: float
    on_thread: bool


def level_contact(pair: Pair, phase: float) -> LevelContact:
    """The first contact of a level bolt at ``phase`` (rad); lengths in the pair's unit."""
    p = pair.thread_pitch
    shift = pair.lead * phase / TWO_PI
    shift -= p * math.floor(shift / p + 0.5)
    down, up = axial_limits(pair)
    if -up < shift < down:
        return LevelContact(shift - down, True)
    return LevelContact(0.0, False)


def solve_level(pair: Pair, phase: float, record: np.ndarray) -> None:
    """Fills the record of a level pose; see ``_record_kernel`` for its layout. ``phase`` in rad."""
    record[:] = 0.0
    for i in (rk.O_LAMBDA, rk.O_MU, rk.O_DROP, rk.O_EMBEDMENT, rk.O_PIVOT):
        record[i] = math.nan
    contact = level_contact(pair, phase)
    pose = np.zeros(12)
    rotation(0.0, 0.0, phase, pose)
    pose[11] = contact.height
    rk.append_pose(pose, record)
    record[rk.O_FLAGS] = rk.FLAG_FLUSH
    bolt, nut = pair.bolt.packed, pair.nut.packed
    if contact.on_thread:
        for x, y, z in strip_extremes(pair, contact.height):
            rk.append_strip_corner(np.array([0.0, FLUSH, 0.0, 0.0, x, y, z]), pose, bolt, nut, record)
        return
    extremes = np.empty((4, fk.EXTREME_SIZE))
    for i in range(fk.extreme_points(pose, bolt, nut, 1.0, 0.0, extremes)):
        theta, corner, x, y = extremes[i]
        rk.append_flush_point(1, theta, corner > 0.0, x, y, bolt, nut, record)


def strip_extremes(pair: Pair, height: float) -> tuple[tuple[float, float, float], ...]:
    """The corners of the strips of flank on which a level bolt in phase rests, one a start: four points each.

    They are in the nut's frame; lengths, ``height`` of the bolt's origin too, are in the pair's unit.

    A strip is where the nut's positive flank lies between the bolt's base and the nut's surface, over the radii at
    which both profiles are straight: at each end of that range, at its top and at its bottom.
    """
    k, period = pair.nut.advance, TWO_PI / pair.starts
    low = max(pair.bolt.radius(pair.bolt.boundaries[1]), pair.nut.radius(pair.nut.boundaries[1]))
    high = min(pair.bolt.radius(pair.bolt.boundaries[2]), pair.nut.radius(pair.nut.boundaries[2]))
    corners = []
    for start in range(pair.starts):
        for radius in (low, high):
            s = pair.nut.inverse(radius)
            for z in (0.0, height):
                theta = (z - s) / k + start * period
                corners.append((radius * math.cos(theta), radius * math.sin(theta), z))
    return tuple(corners)
