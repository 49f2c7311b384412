"""How a path ends, by the table of forces, section 5, and how far it is from ending otherwise."""

from __future__ import annotations

import math
from collections.abc import Sequence
from enum import Enum, auto

import numpy as np

from threadstate.device import _leg_kernel as lk
from threadstate.device import _turn_kernel as tk
from threadstate.device.assembly_model import AssemblyMargins, AssemblyOutcome, AssemblyPoint
from threadstate.device.model import Device, Limits
from threadstate.device.strategy import Strategy
from threadstate.state.model import StagePose
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits

FOLLOWED_DEG, FOLLOWED = 90.0, 0.05
"""Over the end of the clockwise turn the height follows the lead within this part of what the lead makes of it."""

PLAY_SLACK = 1e-3
"""Thread pitches beside the play within which the last height counts as in phase: a level bolt rests on its limit."""


class Ending(Enum):
    """How the last leg of a path ends."""

    TURNED = auto()
    """Its turn is done, or it has snapped where that ends it."""
    TORQUE = auto()
    """The torque has passed its limit."""
    SLIPPED = auto()
    """The bolt has left the nut sideways."""
    TRAVEL = auto()
    """The device has passed its limit of tilt or shift."""
    FAILED = auto()
    """A step has no certain end."""


def outcome_of(
    pair: Pair, device: Device, strategy: Strategy, ending: Ending, legs: Sequence[Sequence[AssemblyPoint]]
) -> tuple[AssemblyOutcome, AssemblyMargins]:
    """The outcome of a path, and its margins, from the points of its legs."""
    points = [point for leg in legs for point in leg]
    push_torque = device.push * pair.nominal_diameter / 2.0
    allowed = device.limits.torque
    torque_limit = tk.TORQUE_LIMIT if allowed is None else min(tk.TORQUE_LIMIT, allowed / push_torque)
    torque = torque_limit - max(abs(point.torque) for point in points) / push_torque
    reach = pair.bolt.major_diameter / 2.0
    offset = reach - max(math.hypot(*point.pose.translation[:2]) for point in points)
    snap = snap_margin(pair, legs[0]) if strategy is Strategy.CCW_THEN_CW else None
    if ending is not Ending.TURNED:
        outcome = {
            Ending.SLIPPED: AssemblyOutcome.SLIPPED,
            Ending.TORQUE: AssemblyOutcome.JAMMED,
            Ending.TRAVEL: AssemblyOutcome.OVER_TRAVEL,
            Ending.FAILED: AssemblyOutcome.UNDECIDED,
        }[ending]
        return outcome, AssemblyMargins(None, None, None, torque, offset, snap)
    if strategy is Strategy.CCW_THEN_CW and len(legs) == 1:
        return AssemblyOutcome.NO_SNAP, AssemblyMargins(None, None, None, torque, offset, snap)
    last = points[-1].pose
    lead = lead_margin(pair, legs[-1])
    play = play_margin(pair, last)
    tilt_deg = allowed_tilt_deg(pair, last) - tilt_of(last)
    outcome = AssemblyOutcome.ENGAGED if play >= 0.0 and tilt_deg >= 0.0 else AssemblyOutcome.CROSS_THREADED
    if not lead >= 0.0:
        outcome = AssemblyOutcome.IDLE
    return outcome, AssemblyMargins(lead, play, tilt_deg, torque, offset, snap)


def first_beyond(limits: Limits, points: Sequence[AssemblyPoint]) -> tuple[int, Ending] | None:
    """The first point of a leg that is beyond a device's limits, and how it ends the path; None where there is none."""
    for k, point in enumerate(points):
        if not limits.allow_travel(math.hypot(*point.rotation_deg), math.hypot(*point.shift[:2])):
            return k, Ending.TRAVEL
        if not limits.allow_torque(abs(point.torque)):
            return k, Ending.TORQUE
    return None


def lead_margin(pair: Pair, points: Sequence[AssemblyPoint]) -> float:
    """By how much the height follows the lead better than it has to, over the last 90 deg of a clockwise turn.

    As a part of what the lead makes of it; ``points`` are those of that turn. Between two of them the height is on a
    straight line.
    """
    last = points[-1].pose.translation[2]
    turned = np.array([point.phase_deg - points[-1].phase_deg for point in points])
    heights = np.array([point.pose.translation[2] - last for point in points])
    apart = np.abs(heights - pair.lead * turned / 360.0)
    within = np.abs(turned) <= FOLLOWED_DEG
    worst = float(apart[within].max())
    before = np.flatnonzero(~within)
    if before.size:
        # Where the 90 deg begin lies between two points: what is found must not hang on where points lie.
        k = int(before[-1])
        part = (abs(turned[k]) - FOLLOWED_DEG) / abs(turned[k] - turned[k + 1])
        begin = heights[k] + part * (heights[k + 1] - heights[k])
        worst = max(worst, abs(begin - pair.lead * math.copysign(FOLLOWED_DEG, turned[k]) / 360.0))
    return FOLLOWED - worst / abs(pair.lead * FOLLOWED_DEG / 360.0)


def play_margin(pair: Pair, pose: StagePose) -> float:
    """How far inside the axial play in phase, and what is allowed beside it, a height is; negative outside."""
    p = pair.thread_pitch
    down, up = axial_limits(pair)
    (r00, r01, _), (r10, r11, _), _ = pose.rotation
    turn = math.atan2(r10 - r01, r00 + r11)
    above = pose.translation[2] - (pair.lead * turn / (2.0 * math.pi) - down)
    slack = PLAY_SLACK * p
    # The height repeats with the thread: the nearest one to the middle of the play.
    middle = 0.5 * (down + up)
    above -= p * math.floor((above - middle) / p + 0.5)
    return min(above + slack, down + up + slack - above)


def tilt_of(pose: StagePose) -> float:
    """The tilt of a pose in degrees."""
    return math.degrees(math.atan2(math.hypot(pose.rotation[2][0], pose.rotation[2][1]), pose.rotation[2][2]))


def allowed_tilt_deg(pair: Pair, pose: StagePose) -> float:
    """The tilt that the play allows: its whole axial play across the nut's minor diameter, in degrees.

    Less than a thread pitch deep the bolt has that play over a part of a turn alone, and more tilt by as much.
    """
    p = pair.thread_pitch
    depth = max(-pose.translation[2], 0.0)
    if depth == 0.0:
        return 0.0
    tilt = math.degrees(math.atan2(sum(axial_limits(pair)), pair.nut.minor_diameter))
    return tilt * max(1.0, p / depth)


def snap_margin(pair: Pair, points: Sequence[AssemblyPoint]) -> float:
    """By how much the deepest descent within the snap's span of phase is deeper than a snap has to be; a length."""
    span = math.degrees(lk.SNAP_SPAN) * (1.0 + 1e-9)
    phases = np.array([point.phase_deg for point in points])
    heights = np.array([point.pose.translation[2] for point in points])
    deepest = 0.0
    for i in range(len(points)):
        near = np.abs(phases[i] - phases[: i + 1]) <= span
        deepest = max(deepest, float(heights[: i + 1][near].max() - heights[i]))
    return deepest - lk.SNAP_FALL * pair.thread_pitch
