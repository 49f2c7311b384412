"""The outline that a cut across the axis leaves of a thread: r = f(-p theta / 2 pi)."""

from __future__ import annotations

import math

from threadstate.thread.profile import Profile


def outline_is_convex(profile: Profile) -> bool:
    """Whether the outline is convex, by a bound: False may also mean that the bound does not say.

    A polar curve is convex where r^2 + 2 r'^2 - r r'' >= 0. With k = p / 2 pi, r'' = k^2 f'' is positive on the fillet
    at the small radius alone, and largest where it meets the flank; elsewhere the sum is positive. On that fillet
    with r = R + rho (1 - cos a), f' = tan a and f'' = 1 / (rho cos^3 a) the sum is at least
    R^2 - r k^2 / (rho cos^3 a), taken over steps of the angle a with r and f'' at each step's far end.
    """
    rho = profile.minor_fillet_radius
    if rho == 0.0:
        return False
    k = profile.thread_pitch / (2.0 * math.pi)
    small = profile.minor_diameter / 2.0
    full = math.pi / 2.0 - math.radians(profile.flank_half_angle_deg)
    steps = 400
    for i in range(steps):
        near, far = full * i / steps, full * (i + 1) / steps
        r_near = small + rho * (1.0 - math.cos(near))
        r_far = small + rho * (1.0 - math.cos(far))
        bend = k * k / (rho * math.cos(far) ** 3)
        if r_near * r_near + 2.0 * (k * math.tan(near)) ** 2 - r_far * bend < 0.0:
            return False
    return True
