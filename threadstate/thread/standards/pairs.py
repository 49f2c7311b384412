"""Pairs of standard threads: diameters at a position within their tolerances, with roots and crests of the form.

A position is a fraction of each tolerance, 0 at maximum material. The fillets are those that a standard bounds, or half
of the largest that fit the basic form where it leaves them open; none is larger than fits at its position.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from enum import StrEnum

from threadstate.errors import InvalidValueError
from threadstate.numbers import number, number_text
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form, flank_half_angles
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.thread.standards.acme import AcmeForm
from threadstate.thread.standards.buttress import CLEARANCE_FLANK_DEG, LOAD_FLANK_DEG, ButtressForm
from threadstate.thread.standards.designation import StandardThread, standard_thread
from threadstate.thread.standards.limits import Diameter
from threadstate.thread.standards.trapezoidal import crest_clearance_mm

_CORNERS = re.compile(r"[\s,]+(?:with\s+)?sharp\s+(?P<which>corners|crests)\b", re.IGNORECASE)
_CHAMFER = re.compile(r"[\s,]+(?:with\s+)?chamfer\b", re.IGNORECASE)
_POSITION = re.compile(r"\s+at\s+(?P<position>.*)$", re.IGNORECASE | re.DOTALL)
_NAMED = {"maximum": 0.0, "middle": 0.5, "minimum": 1.0}
POSITIONS = (
    "maximum material, middle, minimum material, or two numbers from 0 to 1 such as 0.25/0.75: the fractions of the "
    "bolt's and the nut's tolerances, from maximum material on"
)


@dataclass(frozen=True, slots=True)
class Position:
    """Where the diameters of bolt and nut lie within their tolerances: 0 at maximum, 1 at minimum material.

    Raises:
        InvalidValueError: a number outside 0 to 1.
    """

    bolt: float
    nut: float

    def __post_init__(self) -> None:
        for value in (self.bolt, self.nut):
            if not 0.0 <= value <= 1.0:
                raise InvalidValueError("position in the tolerance", value, POSITIONS)

    @property
    def name(self) -> str:
        """As it ends a designation; empty at maximum material."""
        if self.bolt == self.nut and self.bolt in _NAMED.values():
            (word,) = (word for word, value in _NAMED.items() if value == self.bolt)
            return {"maximum": "", "middle": " at middle"}.get(word, f" at {word} material")
        return f" at {number_text(self.bolt)}/{number_text(self.nut)}"


MAXIMUM_MATERIAL = Position(0.0, 0.0)


class Corners(StrEnum):
    """Which corners of a pair are sharp, and how it ends a designation; by default none is."""

    ROUNDED = ""
    SHARP_CRESTS = " with sharp crests"
    SHARP = " with sharp corners"


@dataclass(frozen=True, slots=True)
class Rounding:
    """Flank half-angle and wanted fillet radii of a form, over the thread pitch; infinite: the largest that fits."""

    flank_half_angle_deg: float
    bolt_root: float
    bolt_crest: float
    nut_root: float
    nut_crest: float
    flank_half_angle_neg_deg: float | None = None

    @property
    def half_angles(self) -> tuple[float, float]:
        """Those of the positive and of the negative flank (rad)."""
        return flank_half_angles(self.flank_half_angle_deg, self.flank_half_angle_neg_deg)


def rounding(thread: StandardThread, corners: Corners = Corners.ROUNDED) -> Rounding:
    """Those of a thread's form, with fillets of 0 where its corners are sharp.

    Unified: the root's as in method, section 1. ISO metric: a full root radius, from H / 6 at maximum material to P / 8
    at minimum material; UNJ, MJ: full, too, from the greatest to the least controlled radius. Acme: roots at the limit
    from memory. Trapezoidal: the standard's greatest radii, the bolt's for the nut's crest, too. Whitworth: its one
    radius. Buttress: full roots; the negative flank, towards the head, bears the load of a screw that is pulled.

    Raises:
        InvalidValueError: sharp corners of a form that is round.
    """
    of_form = _rounding_of_form(thread)
    if corners is Corners.ROUNDED:
        return of_form
    if of_form.bolt_crest == WHITWORTH:
        raise InvalidValueError("corners", corners.strip(), f"none of {thread.form} threads, which are round")
    sharp = replace(of_form, bolt_crest=0.0, nut_crest=0.0)
    return sharp if corners is Corners.SHARP_CRESTS else replace(sharp, bolt_root=0.0, nut_root=0.0)


def _rounding_of_form(thread: StandardThread) -> Rounding:
    pitch = thread.thread_pitch
    match thread.form:
        case "UN":
            return Rounding(30.0, 0.108, 0.054, 0.054, 0.108)
        case "M":
            return Rounding(30.0, math.inf, 0.054, 0.054, 0.108)
        case "UNJ" | "MJ":
            return Rounding(30.0, math.inf, 0.054, 0.054, 0.135)
        case ButtressForm.PULL:
            return _buttress(CLEARANCE_FLANK_DEG, LOAD_FLANK_DEG)
        case ButtressForm.PUSH:
            return _buttress(LOAD_FLANK_DEG, CLEARANCE_FLANK_DEG)
        case AcmeForm.ACME | AcmeForm.STUB:
            return Rounding(14.5, ACME_ROOT, ACME_CREST, ACME_ROOT, ACME_CREST)
        case "Tr":
            play = crest_clearance_mm(pitch) / pitch
            return Rounding(15.0, play, 0.5 * play, play, 0.5 * play)
        case _:
            return Rounding(27.5, WHITWORTH, WHITWORTH, WHITWORTH, WHITWORTH)


def _buttress(positive_deg: float, negative_deg: float) -> Rounding:
    return Rounding(positive_deg, math.inf, BUTTRESS_CREST, math.inf, BUTTRESS_CREST, negative_deg)


ACME_ROOT, ACME_CREST = 0.06, 0.02
WHITWORTH = 0.137329
BUTTRESS_CREST = 0.062
METRIC_ROOT = 0.577350
"""Below the greatest pitch diameter, over the pitch: the minor diameter of a full root radius of H / 6."""


CHAMFER_BELOW_MINOR = 0.1
"""In thread pitches, how much less the end diameter of the chamfer of 45 deg of a designation is than the minor one."""

OF_CHAMFER = "the chamfer a choice here"
"""Added to the source of a pair whose bolt has one."""


def standard_pair(designation: str) -> Pair:
    """The pair of a designation, with sharp corners or crests or a chamfer where it says so, a position after ``at``.

    Without these at maximum material, with the fillets of its form.

    Raises:
        UnknownNameError: no such size.
        InvalidValueError: a class or corners that its form does not have, or a position that is none.
    """
    cut_flat = _CHAMFER.sub("", designation, count=1)
    size, corners, position = _parts(cut_flat)
    at = MAXIMUM_MATERIAL if position is None else parsed_position(position)
    pair = pair_at(standard_thread(size), at, corners)
    return pair if cut_flat == designation else _chamfered(pair, at)


def _chamfered(pair: Pair, position: Position) -> Pair:
    """The pair with a chamfer of 45 deg, whose name comes before the position's."""
    size = pair.designation.removesuffix(position.name)
    end = pair.fit.bolt_minor_diameter - CHAMFER_BELOW_MINOR * pair.thread_pitch
    return replace(pair, designation=f"{size} with chamfer{position.name}", chamfer=Chamfer(end))


def standard_source(designation: str) -> str:
    """On what the numbers of a designation's pair rest, whatever its corners and its position.

    Raises:
        UnknownNameError: no such size.
        InvalidValueError: a class that its form does not have.
    """
    cut_flat = _CHAMFER.sub("", designation, count=1)
    source = standard_thread(_parts(cut_flat)[0]).source
    return source if cut_flat == designation else f"{source}; {OF_CHAMFER}"


def _parts(designation: str) -> tuple[str, Corners, str | None]:
    """The designation of a thread, its corners, and what is written of a position."""
    corners = Corners.ROUNDED
    if found := _CORNERS.search(designation):
        corners = Corners.SHARP if found["which"].lower() == "corners" else Corners.SHARP_CRESTS
        designation = _CORNERS.sub("", designation, count=1)
    found = _POSITION.search(designation)
    return _POSITION.sub("", designation), corners, None if found is None else found["position"]


def parsed_position(text: str) -> Position:
    """A position as it is written.

    Raises:
        InvalidValueError: it is none.
    """
    words = text.lower().split()
    if words and words[0] in _NAMED and words[1:] in ([], ["material"]):
        return Position(_NAMED[words[0]], _NAMED[words[0]])
    try:
        bolt, nut = (number(part.strip()) for part in text.split("/"))
    except ValueError:
        raise InvalidValueError("position in the tolerance", text, POSITIONS) from None
    return Position(bolt, nut)


def pair_at(thread: StandardThread, position: Position, corners: Corners = Corners.ROUNDED) -> Pair:
    """The pair of a thread at a position.

    Raises:
        InvalidValueError: its form has no such corners.
    """
    bolt, nut, pitch = thread.bolt, thread.nut, thread.thread_pitch
    wanted = rounding(thread, corners)
    fit = Fit(
        name=f"{thread.classes}{position.name}",
        bolt_major_diameter=_outer(bolt.major, position.bolt),
        bolt_pitch_diameter=_outer(bolt.pitch, position.bolt),
        bolt_minor_diameter=_bolt_minor(thread, position.bolt),
        nut_major_diameter=_inner(nut.major, position.nut),
        nut_pitch_diameter=_inner(nut.pitch, position.nut),
        nut_minor_diameter=_inner(nut.minor, position.nut),
    )

    def fitting(radius: float, height: float) -> float:
        """A fillet over the pitch, no larger than fits at a flat this high above or below the pitch radius."""
        room = 0.5 - height * sum(math.tan(angle) for angle in wanted.half_angles) / pitch
        return min(radius, room / sum(math.tan(math.pi / 4.0 - angle / 2.0) for angle in wanted.half_angles))

    bolt_radius, nut_radius = fit.bolt_pitch_diameter / 2.0, fit.nut_pitch_diameter / 2.0
    form = Form(
        name=thread.form,
        flank_half_angle_deg=wanted.flank_half_angle_deg,
        flank_half_angle_neg_deg=wanted.flank_half_angle_neg_deg,
        bolt_root_fillet=fitting(wanted.bolt_root, bolt_radius - fit.bolt_minor_diameter / 2.0),
        bolt_crest_fillet=fitting(wanted.bolt_crest, fit.bolt_major_diameter / 2.0 - bolt_radius),
        nut_root_fillet=fitting(wanted.nut_root, fit.nut_major_diameter / 2.0 - nut_radius),
        nut_crest_fillet=fitting(wanted.nut_crest, nut_radius - fit.nut_minor_diameter / 2.0),
    )
    return Pair(
        designation=f"{thread.designation}{corners}{position.name}",
        unit=thread.unit,
        nominal_diameter=thread.nominal_diameter,
        thread_pitch=pitch,
        form=form,
        fit=fit,
        starts=thread.starts,
        hand=Hand.LEFT if thread.left_hand else Hand.RIGHT,
    )


def _bolt_minor(thread: StandardThread, position: float) -> float:
    """Of ISO metric threads from a full root radius of H / 6, which the boundary of a flat root leaves room for."""
    minor = thread.bolt.minor
    if thread.form == "M":
        minor = Diameter(minor.least, _limit(thread.bolt.pitch.greatest) - METRIC_ROOT * thread.thread_pitch)
    return _outer(minor, position)


def _outer(diameter: Diameter, position: float) -> float:
    """A bolt's diameter: from the greatest to the least."""
    greatest = _limit(diameter.greatest)
    return greatest if diameter.least is None else greatest + position * (diameter.least - greatest)


def _inner(diameter: Diameter, position: float) -> float:
    """A nut's diameter: from the least on; the least one at any position where there is no greatest."""
    least = _limit(diameter.least)
    return least if diameter.greatest is None else least + position * (diameter.greatest - least)


def _limit(value: float | None) -> float:
    if value is None:
        raise AssertionError("every standard here limits the material")
    return value
