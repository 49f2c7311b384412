"""How a held bolt ends that is turned by a strategy: the rules of outcomes on a followed path.

Written from docs/forces.md, section 5, and the table of outcomes in docs/device.md, for a right-hand single-start pair.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.follow import Follower, Hand, Point
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

STEP_DEG = 0.5
"""Of the hand."""
PUSH_STEPS = 32
SNAP_DROP, SNAP_SPAN_DEG = 0.05, 3.0
"""A descent by so many thread pitches within so much turn."""
CLOCKWISE_DEG, JUDGED_DEG = 270.0, 90.0
LEAD_SHARE = 0.05
"""How far the height may be from the lead's line, over the lead of the last 90 deg."""
BESIDE_PLAY = 1e-3
"""Beside the axial play, in thread pitches."""
MOST_TORQUE = 20.0
"""Over push times nominal radius."""
MOST_LOOSE = 20
"""Steps of the hand in a row that do not balance, after which nothing is said of the end."""
MOST_LINEAR_STEPS = 100_000
"""Of a path: some go to and fro for an hour."""


@dataclass(frozen=True)
class End:
    """How a path ends, and the margins of the rules: what is allowed less what is, over what is allowed.

    ``lead``, ``play`` and ``tilt`` are nan where the bolt was not turned clockwise to the end; ``snap`` is the largest
    descent within 3 deg over the one that is a snap, nan where the hand does not look for one. ``nearly`` and ``loose``
    are the numbers of steps of the hand that balance nearly and not at all, ``snap_deg`` the phase of the snap.
    """

    outcome: str
    lead: float
    play: float
    tilt: float
    snap: float
    snap_deg: float
    torque: float
    nearly: int
    loose: int


@dataclass(frozen=True)
class Limits:
    """What the rules allow: in nominal radii thread pitch, axial play to either side, the nut's minor diameter, and the
    way across; linear steps of a path.
    """

    pitch: float
    play: float
    minor: float
    slip: float
    linear_steps: int

    @classmethod
    def of(cls, pair: Pair, linear_steps: int = MOST_LINEAR_STEPS) -> Limits:
        """Those of a pair."""
        r = pair.nominal_diameter / 2.0
        slack = (pair.fit.nut_pitch_diameter - pair.fit.bolt_pitch_diameter) / 2.0
        play = slack * math.tan(math.radians(pair.form.flank_half_angle_deg))
        slip = pair.fit.bolt_major_diameter / pair.nominal_diameter
        return cls(pair.thread_pitch / r, play / r, pair.fit.nut_minor_diameter / r, slip, linear_steps)


class StoppedError(Exception):
    """The path ends before its time, with an outcome."""


def followed_to_end(
    pair: Pair,
    hand: Hand,
    pose_deg: tuple[float, float, float],
    mu: float,
    *,
    counter_deg: float,
    step_deg: float = STEP_DEG,
    most_linear_steps: int = MOST_LINEAR_STEPS,
) -> tuple[End, list[Point]]:
    """How a bolt ends that settles at a pose and is turned, by ``counter_deg`` counter-clockwise at most, or by 0.

    Nothing is said of the end, ``undecided``, after so many linear steps, or too many loose steps of the hand.
    """
    follower = Follower(pair, hand, pose_deg, mu)
    limits = Limits.of(pair, most_linear_steps)
    points: list[Point] = []
    snap, snap_deg = math.nan, math.nan
    lead, play, tilt = math.nan, math.nan, math.nan
    try:
        for k in range(1, PUSH_STEPS + 1):
            _stepped(follower, follower.phase, k / PUSH_STEPS, points, limits)
        if counter_deg > 0.0:
            snap, snap_deg = _until_snap(follower, points, limits, counter_deg, step_deg)
        outcome = "no_snap"
        if counter_deg == 0.0 or snap >= 1.0:
            began = len(points)
            phase = follower.phase
            steps = round(CLOCKWISE_DEG / step_deg)
            for k in range(1, steps + 1):
                _stepped(follower, phase - math.radians(k * step_deg), 1.0, points, limits)
            lead, play, tilt = judged(points[began:], limits)
            outcome = _named(lead, play, tilt)
    except StoppedError as stopped:
        outcome = str(stopped)
    nearly, loose = sum(point.nearly for point in points), sum(point.loose for point in points)
    torque = max(abs(point.torque) for point in points)
    return End(outcome, lead, play, tilt, snap, snap_deg, torque, nearly, loose), points


def _stepped(follower: Follower, phase: float, push: float, points: list[Point], limits: Limits) -> None:
    point = follower.step(phase, push)
    points.append(point)
    if math.hypot(point.origin[0], point.origin[1]) > limits.slip:
        raise StoppedError("slipped")
    if abs(point.torque) > MOST_TORQUE:
        raise StoppedError("jammed")
    if len(points) >= MOST_LOOSE and all(one.loose for one in points[-MOST_LOOSE:]):
        raise StoppedError("undecided")
    if sum(one.linear_steps for one in points) > limits.linear_steps:
        raise StoppedError("undecided")


def _until_snap(
    follower: Follower, points: list[Point], limits: Limits, counter_deg: float, step_deg: float
) -> tuple[float, float]:
    """The largest descent over the one of a snap, and the phase (deg) of the snap if there is one."""
    began, phase = len(points), follower.phase
    span = round(SNAP_SPAN_DEG / step_deg)
    largest = 0.0
    for k in range(1, round(counter_deg / step_deg) + 1):
        _stepped(follower, phase + math.radians(k * step_deg), 1.0, points, limits)
        recent = points[max(began - 1, len(points) - 1 - span) :]
        drop = max(float(point.origin[2]) for point in recent) - float(points[-1].origin[2])
        if points[-1].below:
            largest = max(largest, drop / (SNAP_DROP * limits.pitch))
        if largest >= 1.0:
            return largest, math.degrees(follower.phase)
    return largest, math.nan


def judged(points: list[Point], limits: Limits) -> tuple[float, float, float]:
    """The margins of lead, play and tilt at the end of a clockwise turn."""
    last = points[-1]
    beginning = last.phase + math.radians(JUDGED_DEG)
    judged_points = [point for point in points if point.phase <= beginning + 1e-9]
    away = max(
        abs(float(point.origin[2] - last.origin[2]) - limits.pitch * (point.phase - last.phase) / (2.0 * math.pi))
        for point in judged_points
    )
    allowed = LEAD_SHARE * limits.pitch * JUDGED_DEG / 360.0
    level = limits.pitch * (last.phase + last.turn) / (2.0 * math.pi)
    beside = abs(math.remainder(float(last.origin[2]) - level, limits.pitch))
    play = limits.play + BESIDE_PLAY * limits.pitch
    steepest = 2.0 * limits.play / limits.minor * max(1.0, limits.pitch / max(-float(last.origin[2]), 1e-9))
    return 1.0 - away / allowed, 1.0 - beside / play, 1.0 - last.tilt / steepest


def _named(lead: float, play: float, tilt: float) -> str:
    if lead < 0.0:
        return "idle"
    return "engaged" if play >= 0.0 and tilt >= 0.0 else "cross_threaded"
