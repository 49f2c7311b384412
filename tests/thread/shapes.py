"""Profiles of many shapes that a thread can have."""

from __future__ import annotations

import math

from hypothesis import strategies as st

from threadstate.thread.profile import Profile


@st.composite
def profiles(draw: st.DrawFn) -> Profile:
    """A possible profile: flanks first, then fillets that fit them."""
    p = draw(st.sampled_from([0.05, 1.0, 1.5, 25.4]))
    half_angle = draw(st.floats(15.0, 45.0))
    # How far the flank's straight extension reaches to either side of the pitch radius, in quarters of a pitch.
    below, above = draw(st.floats(0.2, 0.85)), draw(st.floats(0.2, 0.85))
    slope = 1.0 / math.tan(math.radians(half_angle))
    pitch_diameter = draw(st.floats(4.0, 40.0)) * p
    turn = math.pi / 2 - math.radians(half_angle)
    room_below, room_above = (min(1 - reach, reach) * p / 4 / math.tan(turn / 2) for reach in (below, above))
    return Profile(
        thread_pitch=p,
        minor_diameter=pitch_diameter - below * p / 2 * slope,
        pitch_diameter=pitch_diameter,
        major_diameter=pitch_diameter + above * p / 2 * slope,
        flank_half_angle_deg=half_angle,
        minor_fillet_radius=draw(st.floats(0.05, 0.95)) * room_below,
        major_fillet_radius=draw(st.floats(0.05, 0.95)) * room_above,
    )


PROFILES = profiles()
