"""The catalogue of sizes: what is usual of each, how its classes are read, and on what its numbers rest."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial

from threadstate.numbers import number_text
from threadstate.thread.standards import acme, buttress, controlled_root, metric, trapezoidal, unified, whitworth
from threadstate.thread.standards.limits import Limits
from threadstate.units import LengthUnit

UNIFIED_SOURCE = "ASME B1.1: formulas, rounded as its tables are; checked against published limits"
UNJ_SOURCE = (
    "ASME B1.15: major and pitch diameters of ASME B1.1; root radii and the nut's least minor diameter from one "
    "source, the bolt's minor diameters from these radii; no published limits to check against; the nut's greatest "
    "minor diameter was not found, its least one stands for it"
)
METRIC_SOURCE = (
    "ISO 965-1: formulas with the smoothing and the exceptions of its tables; checked against published limits"
)
MJ_SOURCE = (
    "ISO 5855: formulas from one source, with the tolerances of ISO 965-1; root radii from one source, the bolt's "
    "minor diameters from these radii; no published limits to check against"
)
ACME_SOURCE = (
    "ASME B1.5: formulas, rounded as its tables are; checked against published limits; fillets of roots from memory"
)
STUB_SOURCE = "ASME B1.8: diameters from one source; tolerances, those of ASME B1.5, and fillets of roots from memory"
TRAPEZOIDAL_SOURCE = (
    "ISO 2903: tables from one source; deviations and tolerances of bolts checked against published ones, no published "
    "limits of nuts to check against"
)
WHITWORTH_SOURCE = "BS 84: formulas from two sources, allowances from memory; no published limits to check against"
BUTTRESS_SOURCE = (
    "ASME B1.9: formulas from one source, tolerances of class 2 checked against published ones; those of class 3, the "
    "allowance and which flank leads from memory"
)

OF_ONE_START = "tolerances of one start"
"""Added to the source of a thread of several: what standards change for these is not applied."""
WIDER_OF_SEVERAL = "wider tolerances of several starts from memory"
"""Added to the source of a trapezoidal thread of several starts."""


@dataclass(frozen=True, slots=True)
class Size:
    """A size: its name without classes, the classes that are usual, and how limits and given classes are read.

    Attributes:
        name: with the symbol of its form.
        form: of the thread.
        unit: of all lengths.
        diameter, pitch: of the size.
        classes: of bolt and nut that are usual.
        bolt, nut: limits of a class.
        chosen: the classes of bolt and nut that one or two given ones mean.
        source: the standard, and on what the numbers rest.
        aliases: other names.
        of_several: the size with limits of so many starts; None where those of one start stand.
    """

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
    of_several: Callable[[int], Size] | None = None

    def of_starts(self, starts: int) -> Size:
        """The size with so many starts."""
        if starts == 1:
            return self
        if self.of_several is not None:
            return self.of_several(starts)
        return replace(self, source=f"{self.source}; {OF_ONE_START}")


@cache
def catalogue() -> tuple[Size, ...]:
    """All sizes, form by form, the smallest first."""
    return (*_unified(), *_unj(), *_metric(), *_mj(), *_acme(), *_trapezoidal(), *_whitworth(), *_buttress())


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


def _unified() -> Iterator[Size]:
    for series in unified.Series:
        for one in unified.sizes(series):
            yield Size(
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


def _unj() -> Iterator[Size]:
    for series in unified.Series:
        for one in unified.sizes(series):
            yield Size(
                name=f"{one.name} {series.replace('UN', 'UNJ')}",
                form="UNJ",
                unit=LengthUnit.INCH,
                diameter=one.diameter,
                pitch=one.thread_pitch,
                classes=("3A", "3B"),
                bolt=partial(controlled_root.unj_bolt_limits, one),
                nut=partial(controlled_root.unj_nut_limits, one),
                chosen=_unified_classes,
                source=UNJ_SOURCE,
            )


def _metric() -> Iterator[Size]:
    for diameter, pitch in metric.sizes_mm():
        yield Size(
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
            aliases=_coarse("M", diameter, pitch),
        )


def _mj() -> Iterator[Size]:
    for diameter, pitch in metric.sizes_mm():
        classes = controlled_root.mj_classes(diameter)
        yield Size(
            name=f"MJ{number_text(diameter)}x{number_text(pitch)}",
            form="MJ",
            unit=LengthUnit.MILLIMETRE,
            diameter=diameter,
            pitch=pitch,
            classes=classes,
            bolt=partial(controlled_root.mj_bolt_limits, diameter, pitch),
            nut=partial(controlled_root.mj_nut_limits, diameter, pitch),
            chosen=_metric_classes(*classes),
            source=MJ_SOURCE,
            aliases=_coarse("MJ", diameter, pitch),
        )


def _coarse(symbol: str, diameter: float, pitch: float) -> tuple[str, ...]:
    """The name without the pitch, where that is the coarse one."""
    return (f"{symbol}{number_text(diameter)}",) if metric.COARSE_MM.get(diameter) == pitch else ()


def _acme() -> Iterator[Size]:
    for form in acme.AcmeForm:
        for one in acme.sizes():
            yield Size(
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


def _trapezoidal() -> Iterator[Size]:
    for diameter, pitch in trapezoidal.SIZES_MM:
        one = Size(
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
        yield replace(one, of_several=partial(_trapezoidal_of_several, one))


def _trapezoidal_of_several(one: Size, starts: int) -> Size:
    return replace(
        one,
        bolt=partial(trapezoidal.bolt_limits, one.diameter, one.pitch, starts=starts),
        nut=partial(trapezoidal.nut_limits, one.diameter, one.pitch, starts=starts),
        source=f"{one.source}; {WIDER_OF_SEVERAL}",
    )


def _whitworth() -> Iterator[Size]:
    for series in whitworth.Series:
        for one in whitworth.sizes(series):
            yield Size(
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


def _buttress() -> Iterator[Size]:
    for form in buttress.ButtressForm:
        for one in buttress.sizes():
            yield Size(
                name=f"{one.name} {buttress.SYMBOL[form]}",
                form=form,
                unit=LengthUnit.INCH,
                diameter=one.diameter,
                pitch=one.thread_pitch,
                classes=("2A", "2B"),
                bolt=partial(buttress.screw_limits, one),
                nut=partial(buttress.nut_limits, one),
                chosen=_unified_classes,
                source=BUTTRESS_SOURCE,
                aliases=(f"{one.name} PULL-BUTT",) if form is buttress.ButtressForm.PULL else (),
            )
