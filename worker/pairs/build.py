"""The pairs that tables of a file describe."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import Any

from threadstate.errors import InvalidValueError
from threadstate.thread.catalogue import designations, pair_by_designation
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.pair import Pair
from worker.pairs.document import LARGEST_DESIGNATION, FitPart, FormPart, PairPart
from worker.pairs.place import Place


def pairs_of(part: PairPart, place: Place) -> Iterator[Pair]:
    """The pair, or one for each of its ``fits``, whose name ends the designation then.

    Raises:
        InvalidValueError: something is missing or impossible; its name begins with the place.
    """
    own = part.given().keys() - {"designation"}
    if not own:
        with place.at("designation"):
            yield pair_by_designation(part.designation)
        return
    if part.fit is not None and part.fits is not None:
        raise place.invalid("fits", "given", "either `fit` or `fits`")
    base = None
    if part.like is not None:
        with place.at("like"):
            base = pair_by_designation(part.like)
    form = _form(part.form, base, place / "form")
    for number, fit in enumerate(part.fits or [part.fit], 1):
        of_fit = place / "fit" if part.fits is None else place / f"fits[{number}]"
        yield _pair(part, base, form, fit, place, of_fit)


def _pair(part: PairPart, base: Pair | None, form: Form, fit: FitPart | None, place: Place, of_fit: Place) -> Pair:
    values = _values(part.given(), base, ("unit", "nominal_diameter", "thread_pitch"), place)
    fitted = _fit(fit, base, of_fit)
    designation = part.designation if part.fits is None else f"{part.designation} {fitted.name}"
    if designation in designations():
        raise place.invalid("designation", designation, "a designation of one's own, as dimensions are given too")
    if len(designation) > LARGEST_DESIGNATION:
        raise of_fit.invalid("name", fitted.name, f"at most {LARGEST_DESIGNATION} characters with the designation")
    with place:
        return Pair(designation=designation, form=form, fit=fitted, **values)


def _form(part: FormPart | None, base: Pair | None, place: Place) -> Form:
    values = _values({} if part is None else part.given(), base and base.form, _names(Form), place)
    with place:
        return Form(**values)


def _fit(part: FitPart | None, base: Pair | None, place: Place) -> Fit:
    values = _values({} if part is None else part.given(), base and base.fit, _names(Fit), place)
    with place:
        return Fit(**values)


def _values(given: dict[str, Any], base: object, names: tuple[str, ...], place: Place) -> dict[str, Any]:
    """The values of these names: those of the file, else those of the pair that it is like."""
    found = {}
    for name in names:
        value = given.get(name)
        if value is None:
            value = getattr(base, name, None)
        if value is None:
            raise place.invalid(name, None, "a value, or a known pair as `like`")
        found[name] = value
    return found


def _names(of: type[Form] | type[Fit]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(of))


def known(pairs: dict[str, Pair], designation: str) -> Pair:
    """The pair of the file, or else of the catalogue, of that designation.

    Raises:
        InvalidValueError: there is none.
    """
    if designation in pairs:
        return pairs[designation]
    if designation in designations():
        return pair_by_designation(designation)
    raise InvalidValueError("pair", designation, ", ".join(dict.fromkeys((*pairs, *designations()))))
