"""Designations of standard threads as people write them, and the limits that they name.

A designation is a size, its form where the size does not say it, and classes of bolt and nut after a hyphen, both
separated by a slash; ``LH`` at the end is a left-hand thread, ``2 starts`` one of several starts, of which ISO threads
may have lead and pitch instead (``M6xPh2P1``, ``Tr 8x3(P1.5)``). Case does not matter, nor do blanks round its parts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, partial

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.numbers import number, number_text
from threadstate.thread.hand import MOST_STARTS
from threadstate.thread.standards import acme, metric, trapezoidal, unified, whitworth
from threadstate.thread.standards.limits import Limits
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


@dataclass(frozen=True, slots=True)
class _Size:
    """A size: its name without classes, the classes that are usual, and how limits and given classes are read."""

    name: str
    form: str
    unit: LengthUnit
    diameter: float
    pitch: float
    classes: tuple[str, str]
    bolt: Callable[[str], Limits]
    nut: Callable[[str], Limits]
    chosen: Callable[[list[str]], tuple[str, str]]
    source: str
    aliases: tuple[str, ...] = ()


UNIFIED_SOURCE = "ASME B1.1: formulas, rounded as its tables are; checked against published limits"
METRIC_SOURCE = (
    "ISO 965-1: formulas with the smoothing and the exceptions of its tables; checked against published limits"
)
ACME_SOURCE = (
    "ASME B1.5: formulas, rounded as its tables are; checked against published limits; fillets of roots from memory"
)
STUB_SOURCE = "ASME B1.8: diameters from one source; tolerances, those of ASME B1.5, and fillets of roots from memory"
TRAPEZOIDAL_SOURCE = "ISO 2903: tables from one source; no published limits to check against"
WHITWORTH_SOURCE = "BS 84: formulas from two sources, allowances from memory; no published limits to check against"

OF_ONE_START = "tolerances of one start"
"""Added to the source of a thread of several: what standards change for these is not applied."""

_STARTS = re.compile(r"[\s,-]*(?<![\w.])(?P<starts>\d+)[\s-]*starts?\b", re.IGNORECASE)
_LEAD_AND_PITCH = re.compile(
    r"^(?P<size>\s*(?:M|Tr)\s*[\d.]+)\s*x\s*(?:Ph)?\s*(?P<lead>[\d.]+)\s*\(?\s*P\s*(?P<pitch>[\d.]+)\s*\)?",
    re.IGNORECASE,
)
_LEFT_HAND = re.compile(r"[\s-]*(?<![A-Z])LH\s*(?=-|$)", re.IGNORECASE)
_BLANKS = re.compile(r"\s+")
EXAMPLES = "1/4-20 UNC-2A/2B, M6x1-6g/6H, M6, 1/4-16 ACME-2G, Tr 8x1.5-7e/7H or 1/4-20 BSW"


def standard_threads() -> Iterator[StandardThread]:
    """All sizes of the catalogue with the classes that are usual for them, form by form, the smallest first."""
    for size in catalogue():
        yield _thread(size, size.classes, left_hand=False, starts=1)


def standard_thread(designation: str) -> StandardThread:
    """The thread of a designation; without classes with those that are usual for its form.

    Raises:
        UnknownNameError: no such size.
        InvalidValueError: a class that its form does not have, or a number of starts that is none.
    """
    of_one_start, starts = _without_starts(designation)
    text = _LEFT_HAND.sub("", of_one_start)
    by_key = _by_key()
    for name, classes in _splits(text):
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
    return _BLANKS.sub("", found) if found.startswith(("M", "TR")) else found


@cache
def _by_key() -> dict[str, _Size]:
    return {_key(name): size for size in catalogue() for name in (size.name, *size.aliases)}


def _classes(size: _Size, text: str | None) -> tuple[str, str]:
    """The classes of bolt and nut; of one alone the other is the same, or the usual one of its form."""
    if text is None:
        return size.classes
    given = [part.strip() for part in text.split("/")]
    if len(given) > 2 or not all(given):
        raise InvalidValueError("tolerance class", text, f"classes of bolt and nut, such as {'/'.join(size.classes)}")
    return size.chosen(given)


def _unified_classes(given: list[str]) -> tuple[str, str]:
    upper = [one.upper() for one in given]
    bolt = next((one for one in upper if one.endswith("A")), None)
    nut = next((one for one in upper if one.endswith("B")), None)
    if len(upper) == 1:
        grade = upper[0][:-1]
        return (bolt or f"{grade}A", nut or f"{grade}B")
    return (bolt or upper[0], nut or upper[1])


def _metric_classes(bolt: str, nut: str) -> Callable[[list[str]], tuple[str, str]]:
    """Of two the bolt's is the first, unless cases say otherwise; of one, the other is the usual one."""

    def chosen(given: list[str]) -> tuple[str, str]:
        if len(given) == 1:
            is_nut = given[0].upper() == given[0]
            return (bolt, given[0]) if is_nut else (given[0], nut)
        first, last = given
        if first.upper() == first and last.lower() == last and first.lower() != first:
            first, last = last, first
        return first.lower(), last.upper()

    return chosen


def _both(given: list[str]) -> tuple[str, str]:
    return given[0].upper(), given[-1].upper()


def _named(given: list[str]) -> tuple[str, str]:
    return given[0].lower(), given[-1].lower()


def _thread(size: _Size, classes: tuple[str, str], *, left_hand: bool, starts: int) -> StandardThread:
    bolt, nut = classes
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
        source=size.source if starts == 1 else f"{size.source}; {OF_ONE_START}",
        left_hand=left_hand,
        starts=starts,
    )


@cache
def catalogue() -> tuple[_Size, ...]:
    """All sizes, form by form, the smallest first."""
    return (*_unified(), *_metric(), *_acme(), *_trapezoidal(), *_whitworth())


def _unified() -> Iterator[_Size]:
    for series in unified.Series:
        for one in unified.sizes(series):
            yield _Size(
                name=f"{one.name} {series}",
                form="UN",
                unit=LengthUnit.INCH,
                diameter=one.diameter,
                pitch=one.thread_pitch,
                classes=("2A", "2B"),
                bolt=partial(unified.bolt_limits, one),
                nut=partial(unified.nut_limits, one),
                chosen=_unified_classes,
                source=UNIFIED_SOURCE,
            )


def _metric() -> Iterator[_Size]:
    for diameter, pitch in metric.sizes_mm():
        coarse = metric.COARSE_MM.get(diameter) == pitch
        yield _Size(
            name=f"M{number_text(diameter)}x{number_text(pitch)}",
            form="M",
            unit=LengthUnit.MILLIMETRE,
            diameter=diameter,
            pitch=pitch,
            classes=("6g", "6H"),
            bolt=partial(metric.bolt_limits, diameter, pitch),
            nut=partial(metric.nut_limits, diameter, pitch),
            chosen=_metric_classes("6g", "6H"),
            source=METRIC_SOURCE,
            aliases=(f"M{number_text(diameter)}",) if coarse else (),
        )


def _acme() -> Iterator[_Size]:
    for form in acme.AcmeForm:
        for one in acme.sizes():
            yield _Size(
                name=f"{one.name} {form.upper()}",
                form=form,
                unit=LengthUnit.INCH,
                diameter=one.diameter,
                pitch=one.thread_pitch,
                classes=("2G", "2G"),
                bolt=partial(acme.screw_limits, one, form=form),
                nut=partial(acme.nut_limits, one, form=form),
                chosen=_both,
                source=ACME_SOURCE if form is acme.AcmeForm.ACME else STUB_SOURCE,
            )


def _trapezoidal() -> Iterator[_Size]:
    for diameter, pitch in trapezoidal.SIZES_MM:
        yield _Size(
            name=f"Tr {number_text(diameter)}x{number_text(pitch)}",
            form="Tr",
            unit=LengthUnit.MILLIMETRE,
            diameter=float(diameter),
            pitch=float(pitch),
            classes=("7e", "7H"),
            bolt=partial(trapezoidal.bolt_limits, diameter, pitch),
            nut=partial(trapezoidal.nut_limits, diameter, pitch),
            chosen=_metric_classes("7e", "7H"),
            source=TRAPEZOIDAL_SOURCE,
        )


def _whitworth() -> Iterator[_Size]:
    for series in whitworth.Series:
        for one in whitworth.sizes(series):
            yield _Size(
                name=f"{one.name} {series}",
                form="Whitworth",
                unit=LengthUnit.INCH,
                diameter=one.diameter,
                pitch=one.thread_pitch,
                classes=("medium", "normal"),
                bolt=partial(whitworth.bolt_limits, one),
                nut=partial(whitworth.nut_limits, one),
                chosen=_named,
                source=WHITWORTH_SOURCE,
            )
