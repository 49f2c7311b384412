"""Pairs of several units, sizes and shapes to be meshed."""

from __future__ import annotations

from dataclasses import replace

from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit

UNC = quarter_twenty_unc()

M6 = Pair(
    designation="M6",
    unit=LengthUnit.MILLIMETRE,
    nominal_diameter=6.0,
    thread_pitch=1.0,
    form=Form("ISO", 30.0, 0.125, 0.02, 0.05, 0.06),
    fit=Fit("6g/6H", 5.974, 5.324, 4.75, 6.1, 5.45, 5.0),
)
"""A metric pair; its fillets are small and differ from each other."""

SHARP = replace(UNC, designation="sharp", form=Form("sharp", 30.0, 0.0, 0.0, 0.0, 0.0))
"""No fillets at all."""

FINE_PITCH = Pair(
    designation="fine pitch",
    unit=LengthUnit.MILLIMETRE,
    nominal_diameter=80.0,
    thread_pitch=0.5,
    form=Form("fine", 30.0, 0.108, 0.054, 0.054, 0.108),
    fit=Fit("loose", 79.99, 79.68, 79.43, 80.05, 79.74, 79.5),
)
"""Many times as wide as its pitch."""

LEFT_OF_TWO_STARTS = replace(M6, designation="left, two starts", starts=2, hand=Hand.LEFT)

PAIRS = (UNC, M6, SHARP, FINE_PITCH, LEFT_OF_TWO_STARTS)
