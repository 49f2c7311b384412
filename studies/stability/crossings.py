"""Where both edges cross, seen along the nut's axis, to fifty digits.

Beside a jump the edges overlap in such a view by less than what doubles can tell: whether they do decides if the bolt
rests on their crossing.
"""

from __future__ import annotations

import math

from flint import arb, ctx

from studies.certificate.balls import ZERO
from studies.certificate.exact import (
    PRECISION,
    Parts,
    UncoveredError,
    clearance,
    equations,
    first_pose,
    parts_of,
    place,
    solved,
)
from studies.certificate.functions import Function, variables
from studies.certificate.placements import Motion
from threadstate.contact import _stage_kernel as sk
from threadstate.state.model import Contact
from threadstate.thread.pair import Pair

MOST_STEPS = 40
SETTLED = arb(2) ** -150
"""Steps (rad) after which the azimuth of the widest overlap is known."""


def crossing_height(
    pair: Pair, pose_deg: tuple[float, float, float], contact: Contact, half_width_deg: float
) -> float | None:
    """The greatest height of the bolt's origin at which its edge meets the nut's near a contact of both.

    None: where the overlap of the edges, seen along the axis, is widest there is none. That place is within
    ``half_width_deg`` of the contact's azimuth on the bolt. In the pair's unit.

    Raises:
        UncoveredError: neither is proved.
    """
    with ctx.workprec(PRECISION):
        # The solver takes angles in radians, rounded: of a phase that is up to 4e-16.
        roll, pitch, phase = (arb(one * (math.pi / 180.0)) for one in pose_deg)
        parts, motion = parts_of(pair), Motion(first_pose((roll, pitch, phase)))
        start = arb(math.atan2(contact.point_bolt[1], contact.point_bolt[0]))
        widest = stationary(start, parts, motion)
        if not abs(widest - start) < math.radians(half_width_deg):
            raise UncoveredError("the overlap is not widest near the contact")
        at = overlap(widest, parts, motion)
        bend = at.second[0][0]
        if not bend < 0 or at.value.contains(ZERO):
            raise UncoveredError("edges that bend alike, or touch in a single place")
        if at.value < 0:
            return None
        away = (-2 * at.value / at.second[0][0]).sqrt()
        system = equations(sk.EDGE_EDGE, parts, motion)
        heights = []
        for azimuth in (widest - away, widest + away):
            lowest = -place(sk.EDGE_EDGE, variables((azimuth.mid(), ZERO)), parts, motion)[2].value
            _, height = solved(system, (azimuth.mid(), lowest.mid()), parts.pitch)
            heights.append(float(height.mid()))
        return max(heights)


def overlap(azimuth: arb, parts: Parts, motion: Motion) -> Function:
    """How far a point of the bolt's edge, seen along the axis, is outside of the nut's edge, by its azimuth."""
    at = variables((azimuth,))
    x, y, _ = place(sk.EDGE_EDGE, (at[0], at[0].scaled(ZERO)), parts, motion)
    return clearance((x, y, x.scaled(ZERO)), parts.nut, parts.advance)


def stationary(start: arb, parts: Parts, motion: Motion) -> arb:
    """The azimuth near ``start`` at which the overlap is widest, by Newton's method.

    Raises:
        UncoveredError: it does not settle.
    """
    azimuth = start
    for _ in range(MOST_STEPS):
        here = overlap(azimuth, parts, motion)
        step = (here.first[0] / here.second[0][0]).mid()
        azimuth = (azimuth - step).mid()
        if abs(step) < SETTLED:
            return azimuth
    raise UncoveredError("Newton's method does not settle")
