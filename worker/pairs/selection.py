"""The pair of a command: by designation, by file, or by dimensions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.numbers import number
from threadstate.settings import PAIR, read_settings
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, VALID_DESIGNATIONS, is_known, pair_by_designation
from threadstate.thread.chamfer import Chamfer
from threadstate.thread.fit import Fit
from threadstate.thread.form import Form
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from worker.pairs.document import (
    LARGEST_DESIGNATION,
    TABLES,
    ChamferPart,
    FileLocation,
    FitPart,
    FormPart,
    PairPart,
    PairsPart,
    Part,
    checked,
    read_toml,
)

FILE_ENDING = ".toml"

_WORDS = ("like", "unit", "hand", "form.name", "fit.name")
_NESTED: dict[str, type[Part]] = {"form": FormPart, "fit": FitPart, "chamfer": ChamferPart}


_TABLES: tuple[list[str], ...] = ([], *([name] for name in _NESTED))
"""Where a key may be: outside of any table, or in one."""


def chosen_pair(name: str | None, dimensions: Sequence[str] = ()) -> Pair:
    """The pair of a command.

    Args:
        name: a designation of the catalogue, or the path of a TOML file, which ends in ``.toml``; None:
            ``THREADSTATE_PAIR``, else the default pair. With dimensions: the designation of the pair that they make.
        dimensions: ``KEY=VALUE`` each, keys of a file's pair, those of its tables behind a dot (``fit.name=6g/6H``).

    Raises:
        InvalidValueError: something is missing or impossible; its name says file or option, and key.
        UnknownNameError: no such designation.
    """
    if dimensions:
        return _pair_of_dimensions(name, dimensions)
    if name is not None:
        return named_pair(name, "designation")
    return named_pair(read_settings().pair or DEFAULT_DESIGNATION, PAIR)


def named_pair(name: str, called: str) -> Pair:
    """The pair of a known designation or of a file; ``called`` is the designation's name in errors.

    Raises:
        InvalidValueError: the file cannot be read, or something in it is not valid.
        UnknownNameError: no such designation.
    """
    if name.endswith(FILE_ENDING):
        return pair_of_file(Path(name))
    try:
        return pair_by_designation(name)
    except UnknownNameError:
        valid = f"{VALID_DESIGNATIONS}, or the path of a file that ends in {FILE_ENDING}"
        raise UnknownNameError(called, name, valid) from None


def pair_of_file(path: Path) -> Pair:
    """The one pair of a TOML file: its keys at the top, or as the only ``[[pair]]`` of a sweep.

    Raises:
        InvalidValueError: the file cannot be read, something in it is not valid, or it has another number of pairs.
    """
    location = FileLocation(f"{path}: ")
    values = read_toml(path)
    if "pair" not in values:
        return _only_pair(checked(PairPart, values, TABLES, location), location)
    listed = checked(PairsPart, {"pair": values["pair"]}, TABLES, location).pair
    if len(listed) != 1:
        raise location.invalid("pair", f"{len(listed)} pairs", "one pair alone; `threadstate sweep` takes several")
    return _only_pair(listed[0], location / "pair[1]")


def _pair_of_dimensions(name: str | None, dimensions: Sequence[str]) -> Pair:
    location = FileLocation("--dimension: ")
    if name is None or name.endswith(FILE_ENDING):
        raise InvalidValueError("--pair", name, "with --dimension, a name for the pair of these dimensions")
    values: dict[str, Any] = {"designation": name}
    for one in dimensions:
        key, equals, value = one.partition("=")
        if not equals:
            raise InvalidValueError("--dimension", one, "KEY=VALUE, such as thread_pitch=1 or fit.name=6g/6H")
        *outside, last = key.split(".")
        if key == "designation" or outside not in _TABLES or last in (*_NESTED, "fits"):
            raise InvalidValueError("--dimension", one, f"one of the keys {', '.join(_keys())}")
        table = values.setdefault(outside[0], {}) if outside else values
        if last in table:
            raise location.invalid(key, value, "each key once")
        table[last] = value if key in _WORDS else _number(value)
    return _only_pair(checked(PairPart, values, TABLES, location), location)


def _only_pair(part: PairPart, location: FileLocation) -> Pair:
    pairs = list(pairs_of(part, location))
    if len(pairs) != 1:
        raise location.invalid("fits", f"{len(pairs)} fits", "one fit alone, as `fit`")
    return pairs[0]


def _keys() -> list[str]:
    own = [key for key in PairPart.model_fields if key not in ("designation", "fits", *_NESTED)]
    return own + [f"{table}.{key}" for table, part in _NESTED.items() for key in part.model_fields]


def _number(text: str) -> float | str:
    """A number, or the text itself if it is not one, which validation then rejects."""
    try:
        return number(text)
    except ValueError:
        return text


def pairs_of(part: PairPart, location: FileLocation) -> Iterator[Pair]:
    """The pair, or one for each of its ``fits``, whose name ends the designation then.

    Raises:
        InvalidValueError: something is missing or impossible; its name begins with the location.
    """
    own = part.given().keys() - {"designation"}
    if not own:
        with location.at("designation"):
            yield pair_by_designation(part.designation)
        return
    if part.fit is not None and part.fits is not None:
        raise location.invalid("fits", "given", "either `fit` or `fits`")
    base = None
    if part.like is not None:
        with location.at("like"):
            base = pair_by_designation(part.like)
    form = _form(part.form, base, location / "form")
    for position, fit in enumerate(part.fits or [part.fit], 1):
        of_fit = location / "fit" if part.fits is None else location / f"fits[{position}]"
        yield _pair_of_fit(part, base, form, fit, location, of_fit)


def _pair_of_fit(
    part: PairPart, base: Pair | None, form: Form, fit: FitPart | None, location: FileLocation, of_fit: FileLocation
) -> Pair:
    given = {"starts": 1, "hand": Hand.RIGHT} | part.given() if base is None else part.given()
    values = _values(given, base, ("unit", "nominal_diameter", "thread_pitch", "starts", "hand"), location)
    fitted = _fit(fit, base, of_fit)
    designation = part.designation if part.fits is None else f"{part.designation} {fitted.name}"
    if is_known(designation):
        raise location.invalid("designation", designation, "a designation of one's own, as dimensions are given too")
    if len(designation) > LARGEST_DESIGNATION:
        raise of_fit.invalid("name", fitted.name, f"at most {LARGEST_DESIGNATION} characters with the designation")
    with location:
        pair = Pair(designation=designation, form=form, fit=fitted, **values)
    known_chamfer = None if base is None else base.chamfer
    of_chamfer = location / "chamfer"
    with of_chamfer:
        return replace(pair, chamfer=known_chamfer if part.chamfer is None else _chamfer(part.chamfer, known_chamfer))


def _chamfer(part: ChamferPart, like: Chamfer | None) -> Chamfer:
    """The chamfer of a file; what it does not give is that of the pair that it is like, or 45 deg."""
    given = {name: value for name, value in part.given().items() if value is not None}
    if like is not None:
        return replace(like, **given)
    if "end_diameter" not in given:
        raise InvalidValueError("end_diameter", None, "a value, or as `like` a pair that has a chamfer")
    return Chamfer(**given)


_NEGATIVE = "flank_half_angle_neg_deg"


def _form(part: FormPart | None, base: Pair | None, location: FileLocation) -> Form:
    # Without it both flanks have one angle.
    given = {_NEGATIVE: getattr(base and base.form, _NEGATIVE, None)} | ({} if part is None else part.given())
    names = tuple(name for name in _names(Form) if name != _NEGATIVE)
    values = _values(given, base and base.form, names, location) | {_NEGATIVE: given[_NEGATIVE]}
    with location:
        return Form(**values)


def _fit(part: FitPart | None, base: Pair | None, location: FileLocation) -> Fit:
    values = _values({} if part is None else part.given(), base and base.fit, _names(Fit), location)
    with location:
        return Fit(**values)


def _values(given: dict[str, Any], base: object, names: tuple[str, ...], location: FileLocation) -> dict[str, Any]:
    """The values of these names: those of the file, else those of the pair that it is like."""
    found = {}
    for name in names:
        value = given.get(name)
        if value is None:
            value = getattr(base, name, None)
        if value is None:
            raise location.invalid(name, None, "a value, or a known pair as `like`")
        found[name] = value
    return found


def _names(of: type[Form | Fit | Chamfer]) -> tuple[str, ...]:
    return tuple(field.name for field in fields(of))


def known(pairs: dict[str, Pair], designation: str) -> Pair:
    """The pair of the file, or else of the catalogue, of that designation.

    Raises:
        InvalidValueError: the designation is unknown.
    """
    if designation in pairs:
        return pairs[designation]
    try:
        return pair_by_designation(designation)
    except UnknownNameError:
        raise InvalidValueError("pair", designation, ", ".join([*pairs, VALID_DESIGNATIONS])) from None
