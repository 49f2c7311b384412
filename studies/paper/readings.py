"""How the paper's three angles can be read, and the declared pose that each reading comes to; other geometries.

The paper writes ``P_F = T^-1 P_b`` with ``T = Rot_Z(phase) Rot_Y(pitch) Rot_X(roll) Trans(t)`` (Eqs. 2 and 3). The
method declares ``Rz(phase) Ry(pitch) Rx(roll)``: the bolt is tilted first, and its tilt goes round with the phase. By
the letter of Eq. 2 the bolt is first turned about its own axis, then tilted about axes of the nut: ``Rx(roll)
Ry(pitch) Rz(phase)`` where ``Rot`` turns the axes, the same with all angles negative where it turns the body. The last
equals ``Rx(roll) Ry(pitch) Rz(-phase)`` on threads turned by 180 deg about z, as they must be for a positive roll to
make the crest lead (section 5, case 1).

The paper gives neither fit nor fillet radii: its words allow other geometries.
"""

from __future__ import annotations

import math
from dataclasses import replace
from enum import Enum

from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.fit import Fit
from threadstate.thread.pair import Pair

Angles = tuple[float, float, float]
"""Roll, pitch and phase in degrees."""


class Reading(Enum):
    """A reading of Eqs. 2 and 3."""

    DECLARED = "as declared"
    TURN_FIRST = "the bolt is turned before it is tilted"
    TURN_FIRST_REVERSED = "the bolt is turned, the other way round, before it is tilted"


TURNING = (Reading.DECLARED, Reading.TURN_FIRST)
"""The readings that differ in what a revolution counter-clockwise is; how its phases are counted is the same to it."""


def turned_first(roll_deg: float, pitch_deg: float, phase_deg: float) -> Angles:
    """The declared angles (degrees) of the rotation ``Rx(roll) Ry(pitch) Rz(phase)``."""
    sin_roll, cos_roll = math.sin(math.radians(roll_deg)), math.cos(math.radians(roll_deg))
    sin_pitch, cos_pitch = math.sin(math.radians(pitch_deg)), math.cos(math.radians(pitch_deg))
    sin_phase, cos_phase = math.sin(math.radians(phase_deg)), math.cos(math.radians(phase_deg))
    xx = cos_pitch * cos_phase
    yx = sin_roll * sin_pitch * cos_phase + cos_roll * sin_phase
    zx = sin_roll * sin_phase - cos_roll * sin_pitch * cos_phase
    zy = cos_roll * sin_pitch * sin_phase + sin_roll * cos_phase
    zz = cos_roll * cos_pitch
    return math.degrees(math.atan2(zy, zz)), -math.degrees(math.asin(zx)), math.degrees(math.atan2(yx, xx))


def declared_angles(reading: Reading, roll_deg: float, pitch_deg: float, phase_deg: float) -> Angles:
    """The declared angles (degrees) of the pose that the paper calls by these."""
    match reading:
        case Reading.DECLARED:
            return roll_deg, pitch_deg, phase_deg
        case Reading.TURN_FIRST:
            return turned_first(roll_deg, pitch_deg, phase_deg)
        case Reading.TURN_FIRST_REVERSED:
            return turned_first(roll_deg, pitch_deg, -phase_deg)


LOOSEST = Fit(
    name="2A/2B, least material",
    bolt_major_diameter=0.2408,
    bolt_pitch_diameter=0.2127,
    bolt_minor_diameter=0.1857,
    nut_major_diameter=0.2500,
    nut_pitch_diameter=0.2223,
    nut_minor_diameter=0.2070,
)
"""The other end of the tolerances of 1/4-20 UNC, in inches.

The bolt's minor diameter is as far below its pitch diameter as in the declared fit.
"""

ROUNDED_ROOT = 0.144
"""Fillet of a bolt's root that is one arc from flank to flank, nearly, in thread pitches."""


def other_geometries() -> dict[str, Pair]:
    """The pairs by what is different in them, to be read after "if"."""
    pair = quarter_twenty_unc()
    form = pair.form
    halved = replace(
        form,
        bolt_root_fillet=form.bolt_root_fillet / 2.0,
        bolt_crest_fillet=form.bolt_crest_fillet / 2.0,
        nut_root_fillet=form.nut_root_fillet / 2.0,
        nut_crest_fillet=form.nut_crest_fillet / 2.0,
    )
    return {
        "the fit is in the middle of its tolerances": replace(pair, fit=_between(pair.fit, LOOSEST)),
        "the fit is at its loosest": replace(pair, fit=LOOSEST),
        "all fillets are half as large": replace(pair, form=halved),
        "the bolt's root is rounded throughout": replace(pair, form=replace(form, bolt_root_fillet=ROUNDED_ROOT)),
    }


def _between(tight: Fit, loose: Fit) -> Fit:
    return Fit(
        name="2A/2B, middle",
        bolt_major_diameter=(tight.bolt_major_diameter + loose.bolt_major_diameter) / 2.0,
        bolt_pitch_diameter=(tight.bolt_pitch_diameter + loose.bolt_pitch_diameter) / 2.0,
        bolt_minor_diameter=(tight.bolt_minor_diameter + loose.bolt_minor_diameter) / 2.0,
        nut_major_diameter=(tight.nut_major_diameter + loose.nut_major_diameter) / 2.0,
        nut_pitch_diameter=(tight.nut_pitch_diameter + loose.nut_pitch_diameter) / 2.0,
        nut_minor_diameter=(tight.nut_minor_diameter + loose.nut_minor_diameter) / 2.0,
    )
