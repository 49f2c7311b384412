"""Where a first contact of edge on edge ends: the bolt's edge, seen along the nut's axis, slips into the nut's outline.

Straight down, a point of the bolt's edge moves on a line parallel to the nut's axis. It meets the nut's edge where its
distance from that axis is the radius of the nut's outline in the same direction: g(theta, phase) = 0, where theta is
its azimuth on the bolt. As the bolt turns, the two crossings at the ends of an arc beyond the outline approach each
other; where they meet, dg/dtheta = 0 as well, and behind that phase neither is there. The height of first contact falls
towards it as the root of the phase that is left, so that no phase beside it gives the height there: both equations are
solved together, where they are as regular as any.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass

from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile

MAX_STEPS = 20
SETTLED = 1e-12
"""Most steps of Newton's method, and the size of the last one (rad): the next would be within round-off."""

ROUND_OFF = 8.0 * sys.float_info.epsilon
"""Relative error of g and its derivatives as they are computed."""


@dataclass(frozen=True, slots=True)
class Fold:
    """The phase, in degrees, at which two contacts of edge on edge meet, and the bolt's height there.

    Heights are in the pair's unit. Errors are estimates: what round-off in the two equations does to their solution.
    """

    phase_deg: float
    phase_error_deg: float
    height: float
    height_error: float


@dataclass(frozen=True, slots=True)
class _Polar:
    """A plane curve about the origin in polar coordinates, with both derivatives of each by the curve's parameter."""

    radius: tuple[float, float, float]
    azimuth: tuple[float, float, float]


def fold_near(pair: Pair, roll_deg: float, pitch_deg: float, phase_deg: float, azimuth: float) -> Fold | None:
    """The fold near a phase and an azimuth (rad) on the bolt's edge, by Newton's method; None where it finds none."""
    roll, pitch = math.radians(roll_deg), math.radians(pitch_deg)
    theta, phase = azimuth, math.radians(phase_deg)
    for _ in range(MAX_STEPS):
        bolt = _edge_from_above(pair.bolt, roll, pitch, theta)
        radius, slope, bend = _outline(pair.nut, bolt.azimuth[0] + phase)
        g = bolt.radius[0] - radius
        g_theta = bolt.radius[1] - slope * bolt.azimuth[1]
        g_theta_theta = bolt.radius[2] - bend * bolt.azimuth[1] ** 2 - slope * bolt.azimuth[2]
        g_phase, g_theta_phase = -slope, -bend * bolt.azimuth[1]
        determinant = g_theta * g_theta_phase - g_phase * g_theta_theta
        if determinant == 0.0:
            return None
        theta_step = (g_phase * g_theta - g_theta_phase * g) / determinant
        phase_step = (g_theta_theta * g - g_theta * g_theta) / determinant
        theta += theta_step
        phase += phase_step
        if abs(theta_step) + abs(phase_step) < SETTLED:
            round_off = ROUND_OFF * radius
            theta_error = abs(theta_step) + round_off * (abs(g_phase) + abs(g_theta_phase)) / abs(determinant)
            phase_error = abs(phase_step) + round_off * (abs(g_theta_theta) + abs(g_theta)) / abs(determinant)
            height, height_slope = _height(pair.bolt, roll, pitch, theta)
            return Fold(
                math.degrees(phase),
                math.degrees(phase_error + ROUND_OFF * abs(phase)),
                height,
                abs(height_slope) * theta_error + round_off,
            )
    return None


def _outline(profile: Profile, azimuth: float) -> tuple[float, float, float]:
    """The radius of a part's edge at an azimuth (rad), and its first and second derivative."""
    k = profile.advance
    radius, slope, bend = profile.derivatives(-k * azimuth)
    return radius, -k * slope, k * k * bend


def _edge_from_above(bolt: Profile, roll: float, pitch: float, theta: float) -> _Polar:
    """The bolt's edge at phase 0, seen along the nut's axis."""
    radius, slope, bend = _outline(bolt, theta)
    c, s = math.cos(theta), math.sin(theta)
    x = (radius * c, slope * c - radius * s, bend * c - 2.0 * slope * s - radius * c)
    y = (radius * s, slope * s + radius * c, bend * s + 2.0 * slope * c - radius * s)
    (px, dx, ddx), (py, dy, ddy) = (
        tuple(math.cos(pitch) * a + math.sin(pitch) * math.sin(roll) * b for a, b in zip(x, y, strict=True)),
        tuple(math.cos(roll) * b for b in y),
    )
    r = math.hypot(px, py)
    r_1 = (px * dx + py * dy) / r
    r_2 = (dx * dx + dy * dy + px * ddx + py * ddy - r_1 * r_1) / r
    a_1 = (px * dy - py * dx) / (r * r)
    a_2 = (px * ddy - py * ddx) / (r * r) - 2.0 * a_1 * r_1 / r
    return _Polar((r, r_1, r_2), (math.atan2(py, px), a_1, a_2))


def _height(bolt: Profile, roll: float, pitch: float, theta: float) -> tuple[float, float]:
    """The height of the bolt's origin at which its edge at ``theta`` is in the nut's surface plane, and its slope."""
    radius, slope, _ = _outline(bolt, theta)
    c, s = math.cos(theta), math.sin(theta)
    across, along = math.sin(pitch), math.cos(pitch) * math.sin(roll)
    height = across * radius * c - along * radius * s
    return height, across * (slope * c - radius * s) - along * (slope * s + radius * c)
