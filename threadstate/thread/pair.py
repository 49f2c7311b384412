"""A pair: one bolt and one nut of the same form, fit and thread pitch."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from enum import StrEnum
from functools import cached_property

from threadstate.errors import ImpossibleThreadError
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.hand import Hand
from threadstate.thread.profile import Profile
from threadstate.units import LengthUnit, conversion_factor

LEAST_END = 0.6
"""Of the bolt's minor diameter, the least end diameter of a chamfer: meshes have a bore within it."""


class Part(StrEnum):
    """Which of the pair."""

    BOLT = "bolt"
    NUT = "nut"


@dataclass(frozen=True)
class Pair:
    """A bolt and a nut, each one thread pitch long (method, section 1); lengths in ``unit``.

    The bolt's base is cut flat, or has a ``chamfer``; a document of a pair without one does not name it.

    Raises:
        ImpossibleThreadError: the dimensions contradict each other.
    """

    designation: str
    unit: LengthUnit
    nominal_diameter: float
    thread_pitch: float
    form: Form
    fit: Fit
    starts: int = 1
    hand: Hand = Hand.RIGHT
    chamfer: Chamfer | None = None

    def __post_init__(self) -> None:
        for name in ("nominal_diameter", "thread_pitch"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise ImpossibleThreadError(name, value, "a finite length > 0")
        least = LEAST_END * self.fit.bolt_minor_diameter
        if self.chamfer is not None and self.chamfer.end_diameter < least:
            valid = f"at least {least!r}, {LEAST_END} of the bolt's minor diameter"
            raise ImpossibleThreadError("end_diameter", self.chamfer.end_diameter, valid)
        _ = self.bolt, self.nut

    def in_unit(self, unit: LengthUnit) -> Pair:
        """The same pair with its lengths in ``unit``."""
        factor = conversion_factor(self.unit, unit)
        diameters = {
            field.name: getattr(self.fit, field.name) * factor for field in fields(self.fit) if field.name != "name"
        }
        chamfer = self.chamfer and replace(self.chamfer, end_diameter=self.chamfer.end_diameter * factor)
        return replace(
            self,
            unit=unit,
            chamfer=chamfer,
            nominal_diameter=self.nominal_diameter * factor,
            thread_pitch=self.thread_pitch * factor,
            fit=replace(self.fit, **diameters),
        )

    @property
    def lead(self) -> float:
        """How far the helix advances along the axis in a turn, in the pair's unit; negative of a left-hand pair."""
        return self.bolt.lead

    @cached_property
    def bolt(self) -> Profile:
        """The bolt's profile."""
        return Profile(
            thread_pitch=self.thread_pitch,
            minor_diameter=self.fit.bolt_minor_diameter,
            pitch_diameter=self.fit.bolt_pitch_diameter,
            major_diameter=self.fit.bolt_major_diameter,
            flank_half_angle_deg=self.form.flank_half_angle_deg,
            minor_fillet_radius=self.form.bolt_root_fillet * self.thread_pitch,
            major_fillet_radius=self.form.bolt_crest_fillet * self.thread_pitch,
            starts=self.starts,
            hand=self.hand,
            flank_half_angle_neg_deg=self.form.flank_half_angle_neg_deg,
        )

    @cached_property
    def nut(self) -> Profile:
        """The nut's profile; its small-radius fillet is the nut's crest fillet."""
        return Profile(
            thread_pitch=self.thread_pitch,
            minor_diameter=self.fit.nut_minor_diameter,
            pitch_diameter=self.fit.nut_pitch_diameter,
            major_diameter=self.fit.nut_major_diameter,
            flank_half_angle_deg=self.form.flank_half_angle_deg,
            minor_fillet_radius=self.form.nut_crest_fillet * self.thread_pitch,
            major_fillet_radius=self.form.nut_root_fillet * self.thread_pitch,
            starts=self.starts,
            hand=self.hand,
            flank_half_angle_neg_deg=self.form.flank_half_angle_neg_deg,
        )
