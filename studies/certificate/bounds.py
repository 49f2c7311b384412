"""What the kernels claim of a box: ranges and a class, as intervals for quantities that balls can be put beside."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from studies.certificate.cases import Box
from threadstate.contact import _box_kernel, _range_kernel
from threadstate.contact._branchless_kernel import profile_numbers
from threadstate.contact._frame_kernel import motion_numbers

Interval = tuple[float, float]

OVER_BOX = (
    "phi_theta_theta",
    "phi_theta_tau",
    "phi_tau_tau",
    "phi_theta",
    "phi_tau",
    "g_theta_theta",
    "g_theta_tau",
    "g_tau_tau",
    "g_theta",
    "phi",
    "depth",
)
"""Quantities whose ranges over a box are claimed."""

IN_MIDDLE = ("phi, middle", "phi_theta, middle", "phi_tau, middle", "g, middle", "g_theta, middle", "g_tau, middle")
"""Quantities whose values in the middle of a box are claimed, with their round-off."""


@dataclass(frozen=True)
class Claims:
    """The half-widths a box was evaluated with and its middle time; the claimed intervals, and the class."""

    theta: float
    a: float
    tau: float
    b: float
    over_box: tuple[Interval, ...]
    in_middle: tuple[Interval, ...]
    box_class: int
    thread_pitch: float


Kernels = tuple[Callable[..., Any], Callable[..., Any]]
COMPILED: Kernels = (_range_kernel.ranges, _box_kernel.classify_box)


def claims(one: Box, kernels: Kernels = COMPILED) -> Claims:
    """What the kernels (``ranges`` and ``classify_box``) say of a box, evaluated as the search evaluates it."""
    ranges, classify_box = kernels
    motion, curve, solid = one.search.motion, one.search.curve.packed, one.search.solid.packed
    a = one.half
    tau = 0.5 * (one.start + one.end)
    b = 0.5 * (one.end - one.start) + _box_kernel.OVERLAP * abs(one.end)
    sizes = _range_kernel.size_numbers(motion, curve, solid)
    numbers = motion_numbers(motion), profile_numbers(curve), profile_numbers(solid)
    phi, g, depth = ranges(one.theta, a, tau, b, *numbers[0], *numbers[1:], sizes)
    p = one.search.solid.thread_pitch
    box_class, *_ = classify_box(a, b, phi, g, depth, p)
    phi_low, phi_high, _, _ = _box_kernel.phi_over(a, b, phi, _box_kernel.sizes_over(a, b, phi))
    near_axis = phi.tt_low == phi.tt_high == 0.0  # of phi only a bound from one side is claimed there
    return Claims(
        one.theta,
        a,
        tau,
        b,
        (
            (phi.tt_low, phi.tt_high),
            (phi.tv - phi.tv_var, phi.tv + phi.tv_var),
            (-phi.vv, phi.vv),
            (
                max(phi.by_theta - phi.theta_change, phi.theta_low),
                min(phi.by_theta + phi.theta_change, phi.theta_high),
            ),
            (phi.by_tau - phi.tau_change, phi.by_tau + phi.tau_change),
            (g.tt_low, g.tt_high),
            (g.tv - g.tv_var, g.tv + g.tv_var),
            (-g.vv, g.vv),
            (g.by_theta - g.theta_change, g.by_theta + g.theta_change),
            (-math.inf, math.inf) if near_axis else (phi_low, phi_high),
            (depth, math.inf),
        ),
        tuple(
            (value - error, value + error) for one in (phi, g) for value, error in zip(one[:3], one[-3:], strict=True)
        ),
        int(box_class),
        p,
    )
