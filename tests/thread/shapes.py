"""Profiles of many shapes that a thread can have."""

from __future__ import annotations

import math
from dataclasses import replace

from hypothesis import strategies as st

from threadstate.thread.fit import Fit
from threadstate.thread.form import Form, flank_half_angles
from threadstate.thread.pair import Pair
from threadstate.thread.profile import Profile
from threadstate.units import LengthUnit

BUTTRESS = Pair(
    designation="buttress",
    unit=LengthUnit.INCH,
    nominal_diameter=0.25,
    thread_pitch=0.05,
    form=Form("buttress", 45.0, 0.06, 0.01, 0.02, 0.01, flank_half_angle_neg_deg=7.0),
    fit=Fit("loose", 0.2480, 0.2180, 0.1810, 0.2500, 0.2200, 0.1900),
)
"""Flanks of 45 and 7 deg; the bolt's root is nearly round."""
TURNED_BUTTRESS = replace(
    BUTTRESS,
    designation="turned buttress",
    form=replace(BUTTRESS.form, flank_half_angle_deg=7.0, flank_half_angle_neg_deg=45.0),
)


@st.composite
def profiles(draw: st.DrawFn) -> Profile:
    """A possible profile: flanks of one angle or of two first, then fillets that fit them."""
    p = draw(st.sampled_from([0.05, 1.0, 1.5, 25.4]))
    positive, negative = draw(st.floats(15.0, 45.0)), draw(st.none() | st.floats(7.0, 50.0))
    angles = flank_half_angles(positive, negative)
    # How much of the thread pitch the straight flanks take below and above the pitch radius.
    below, above = draw(st.floats(0.2, 0.85)), draw(st.floats(0.2, 0.85))
    deep, high = (share * p / 2 / sum(math.tan(angle) for angle in angles) for share in (below, above))
    pitch_diameter = draw(st.floats(4.0, 40.0)) * p
    turns = [math.tan((math.pi / 2 - angle) / 2) for angle in angles]
    rooms = (
        min(
            (1 - share) * p / 2 / sum(turns),
            *(height * math.tan(angle) / turn for angle, turn in zip(angles, turns, strict=True)),
        )
        for share, height in ((below, deep), (above, high))
    )
    room_below, room_above = rooms
    return Profile(
        thread_pitch=p,
        minor_diameter=pitch_diameter - 2 * deep,
        pitch_diameter=pitch_diameter,
        major_diameter=pitch_diameter + 2 * high,
        flank_half_angle_deg=positive,
        minor_fillet_radius=draw(st.floats(0.05, 0.95)) * room_below,
        major_fillet_radius=draw(st.floats(0.05, 0.95)) * room_above,
        flank_half_angle_neg_deg=None if negative == positive else negative,
    )


PROFILES = profiles()
