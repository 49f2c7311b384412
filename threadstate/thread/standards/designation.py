"""Designations of standard threads as people write them, and the limits that they name.

A designation is a size, its form where the size does not say it, and classes of bolt and nut after a hyphen, both
separated by a slash or a hyphen; ``LH`` at the end is a left-hand thread, ``2 starts`` one of several starts, of which
ISO threads may have lead and pitch instead (``M6xPh2P1``, ``Tr 8x3(P1.5)``). A diameter in inches may be a decimal
(``.2500-28 UNJF``). Case does not matter, nor do blanks round its parts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.numbers import number, number_text
from threadstate.thread.hand import MOST_STARTS
from threadstate.thread.standards.limits import Limits
from threadstate.thread.standards.sizes import Size, catalogue
from threadstate.units import LengthUnit


@dataclass(frozen=True, slots=True)
class StandardThread:
    """A thread of a standard, with tolerance classes.

    Attributes:
        designation: as this project writes it.
        form: of the thread.
        classes: of bolt and nut.
        unit: of all lengths.
        nominal_diameter, thread_pitch: of the size.
        bolt, nut: limits of the diameters.
        source: the standard, and on what the numbers rest.
        left_hand: whether it turns the other way.
        starts: how many threads run side by side; the lead is so many thread pitches.
    """

    designation: str
    form: str
    classes: str
    unit: LengthUnit
    nominal_diameter: float
    thread_pitch: float
    bolt: Limits
    nut: Limits
    source: str
    left_hand: bool
    starts: int


_STARTS = re.compile(r"[\s,-]*(?<![\w.])(?P<starts>\d+)[\s-]*starts?\b", re.IGNORECASE)
_LEAD_AND_PITCH = re.compile(
    r"^(?P<size>\s*(?:MJ?|Tr)\s*[\d.]+)\s*x\s*(?:Ph)?\s*(?P<lead>[\d.]+)\s*\(?\s*P\s*(?P<pitch>[\d.]+)\s*\)?",
    re.IGNORECASE,
)
_LEFT_HAND = re.compile(r"[\s-]*(?<![A-Z])LH\s*(?=-|$)", re.IGNORECASE)
_BLANK_BEFORE_CLASSES = re.compile(
    r"^(?P<size>\s*(?:MJ?|Tr)\s*[\d.]+(?:\s*x\s*[\d.]+)?)\s+(?P<classes>\d[a-z].*)$", re.IGNORECASE | re.DOTALL
)
"""ISO threads with classes after a blank: ``MJ6x1 4h6h - 4H5H``."""
_DECIMAL = re.compile(r"(?P<diameter>\d*\.\d+)-")
"""How a size begins that has its diameter in inches as a decimal."""
_BLANKS = re.compile(r"\s+")
EXAMPLES = "1/4-20 UNC-2A/2B, M6x1-6g/6H, M6, 1/4-16 ACME-2G, Tr 8x1.5-7e/7H or 1/4-20 BSW"


def standard_threads() -> Iterator[StandardThread]:
    """All sizes of the catalogue with the classes that are usual for them, form by form, the smallest first."""
    yield from _usual_threads()


@cache
def _usual_threads() -> tuple[StandardThread, ...]:
    return tuple(_thread(size, size.classes, left_hand=False, starts=1) for size in catalogue())


def standard_thread(designation: str) -> StandardThread:
    """The thread of a designation; without classes with those that are usual for its form.

    Raises:
        UnknownNameError: no such size.
        InvalidValueError: a class that its form does not have, or a number of starts that is none.
    """
    of_one_start, starts = _without_starts(designation)
    text = _LEFT_HAND.sub("", of_one_start)
    by_key = _by_key()
    for name, classes in _splits(_BLANK_BEFORE_CLASSES.sub(r"\g<size>-\g<classes>", text)):
        if (size := by_key.get(_key(name))) is not None:
            return _thread(size, _classes(size, classes), left_hand=text != of_one_start, starts=starts)
    raise UnknownNameError("designation", designation, f"a standard thread, such as {EXAMPLES}")


def found_threads(search: str | None) -> list[StandardThread]:
    """The threads of the catalogue that a search means: all, that of a designation, or those that hold all its words.

    Raises:
        InvalidValueError: a class that the form of a designation does not have.
        UnknownNameError: nothing is found.
    """
    if search is None:
        return list(standard_threads())
    try:
        return [standard_thread(search)]
    except UnknownNameError:
        words = search.lower().split()
        found = [one for one in standard_threads() if all(word in one.designation.lower() for word in words)]
        if not found or not words:
            raise
        return found


def _without_starts(designation: str) -> tuple[str, int]:
    """The designation of one start, and how many there are.

    Raises:
        InvalidValueError: no thread has so many, or the lead is no multiple of the pitch.
    """
    text, starts = designation, 1
    if found := _STARTS.search(text):
        text, starts = _STARTS.sub("", text, count=1), int(found["starts"])
    if found := _LEAD_AND_PITCH.match(text):
        lead, pitch = (number(found[name]) for name in ("lead", "pitch"))
        if starts != 1 or not pitch > 0.0 or not math.isclose(lead / pitch, round(lead / pitch), abs_tol=1e-9):
            raise InvalidValueError("lead", found["lead"], "a whole number of pitches, which are the starts")
        text, starts = f"{found['size']}x{found['pitch']}{text[found.end() :]}", round(lead / pitch)
    if not 1 <= starts <= MOST_STARTS:
        raise InvalidValueError("starts", starts, f"1 to {MOST_STARTS}")
    return text, starts


def _splits(text: str) -> Iterator[tuple[str, str | None]]:
    """A designation as a size alone, then as a size and classes, cut at each hyphen from the right."""
    yield text, None
    for cut in reversed([match.start() for match in re.finditer("-", text)]):
        yield text[:cut], text[cut + 1 :]


def _key(name: str) -> str:
    found = _BLANKS.sub(" ", name.strip()).upper().removeprefix("#")
    if decimal := _DECIMAL.match(found):
        found = f"{number_text(number(decimal['diameter']))}{found[decimal.end('diameter') :]}"
    return _BLANKS.sub("", found) if found.startswith(("M", "TR")) else found


@cache
def _by_key() -> dict[str, Size]:
    return {_key(name): size for size in catalogue() for name in (size.name, *size.aliases, *_decimal_names(size))}


def _decimal_names(size: Size) -> Iterator[str]:
    """The names of a size in inches with its diameter as a decimal."""
    if size.unit is LengthUnit.INCH:
        for name in (size.name, *size.aliases):
            yield f"{number_text(size.diameter)}{name[name.index('-') :]}"


def _classes(size: Size, text: str | None) -> tuple[str, str]:
    """The classes of bolt and nut; of one alone the other is the same, or the usual one of its form."""
    if text is None:
        return size.classes
    given = [part.strip() for part in re.split("[/-]", text)]
    if len(given) > 2 or not all(given):
        raise InvalidValueError("tolerance class", text, f"classes of bolt and nut, such as {'/'.join(size.classes)}")
    return size.chosen(given)


def _thread(size: Size, classes: tuple[str, str], *, left_hand: bool, starts: int) -> StandardThread:
    bolt, nut = classes
    size = size.of_starts(starts)
    written = bolt if bolt == nut else f"{bolt}/{nut}"
    ending = f"{' LH' if left_hand else ''}{f' {starts} starts' if starts > 1 else ''}"
    return StandardThread(
        designation=f"{size.name}-{written}{ending}",
        form=size.form,
        classes=written,
        unit=size.unit,
        nominal_diameter=size.diameter,
        thread_pitch=size.pitch,
        bolt=size.bolt(bolt),
        nut=size.nut(nut),
        source=size.source,
        left_hand=left_hand,
        starts=starts,
    )
