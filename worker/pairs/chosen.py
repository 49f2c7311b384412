"""The pair that a command is asked for: by designation, by file, or by dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.numbers import number
from threadstate.settings import PAIR, read_settings
from threadstate.thread.catalogue import DEFAULT_DESIGNATION, designations, pair_by_designation
from threadstate.thread.pair import Pair
from worker.pairs.build import pairs_of
from worker.pairs.document import TABLES, FitPart, FormPart, PairPart, PairsPart, Part
from worker.pairs.place import Place
from worker.pairs.toml import checked, read_toml

FILE_ENDING = ".toml"

_WORDS = ("like", "unit", "form.name", "fit.name")
_NESTED: dict[str, type[Part]] = {"form": FormPart, "fit": FitPart}


def chosen_pair(name: str | None, dimensions: Sequence[str] = ()) -> Pair:
    """The pair that is meant.

    Args:
        name: a known designation, or the path of a TOML file, which ends in ``.toml``; None: ``THREADSTATE_PAIR``, else
            the default pair. With dimensions: the designation of the pair that they make.
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
    """The pair of a known designation or of a file; errors call the designation so.

    Raises:
        InvalidValueError: the file cannot be read, or something in it is not valid.
        UnknownNameError: no such designation.
    """
    if name.endswith(FILE_ENDING):
        return pair_of_file(Path(name))
    if name not in designations():
        known = ", ".join(designations())
        raise UnknownNameError(called, name, f"{known}, or the path of a file that ends in {FILE_ENDING}")
    return pair_by_designation(name)


def pair_of_file(path: Path) -> Pair:
    """The one pair of a TOML file: its keys at the top, or as the only ``[[pair]]`` of a sweep.

    Raises:
        InvalidValueError: the file cannot be read, something in it is not valid, or it has another number of pairs.
    """
    place = Place(f"{path}: ")
    values = read_toml(path)
    if "pair" not in values:
        return _only_pair(checked(PairPart, values, TABLES, place), place)
    listed = checked(PairsPart, {"pair": values["pair"]}, TABLES, place).pair
    if len(listed) != 1:
        raise place.invalid("pair", f"{len(listed)} pairs", "one pair alone; `threadstate sweep` takes several")
    return _only_pair(listed[0], place / "pair[1]")


def _pair_of_dimensions(name: str | None, dimensions: Sequence[str]) -> Pair:
    place = Place("--dimension: ")
    if name is None or name.endswith(FILE_ENDING):
        raise InvalidValueError("--pair", name, "with --dimension, a name for the pair of these dimensions")
    values: dict[str, Any] = {"designation": name}
    for one in dimensions:
        key, equals, value = one.partition("=")
        if not equals:
            raise InvalidValueError("--dimension", one, "KEY=VALUE, such as thread_pitch=1 or fit.name=6g/6H")
        *outside, last = key.split(".")
        if key == "designation" or outside not in ([], ["form"], ["fit"]) or last in ("form", "fit", "fits"):
            raise InvalidValueError("--dimension", one, f"one of the keys {', '.join(_keys())}")
        table = values.setdefault(outside[0], {}) if outside else values
        if last in table:
            raise place.invalid(key, value, "each key once")
        table[last] = value if key in _WORDS else _number(value)
    return _only_pair(checked(PairPart, values, TABLES, place), place)


def _only_pair(part: PairPart, place: Place) -> Pair:
    pairs = list(pairs_of(part, place))
    if len(pairs) != 1:
        raise place.invalid("fits", f"{len(pairs)} fits", "one fit alone, as `fit`")
    return pairs[0]


def _keys() -> list[str]:
    own = [key for key in PairPart.model_fields if key not in ("designation", "form", "fit", "fits")]
    return own + [f"{table}.{key}" for table, part in _NESTED.items() for key in part.model_fields]


def _number(text: str) -> float | str:
    """A number; what is none stays as it is, for the check of the document to refuse."""
    try:
        return number(text)
    except ValueError:
        return text
