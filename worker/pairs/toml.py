"""Reading a TOML file, and saying what is wrong with it by file and key."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from threadstate.errors import InvalidValueError
from worker.pairs.document import Part
from worker.pairs.place import Place

Document = TypeVar("Document", bound=Part)


def read_toml(path: Path) -> dict[str, Any]:
    """What a TOML file says.

    Raises:
        InvalidValueError: the file cannot be read or is no TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidValueError("file", str(path), f"a file that can be read ({error.strerror})") from None
    except UnicodeDecodeError:
        raise InvalidValueError("file", str(path), "TOML, which is UTF-8") from None
    except tomllib.TOMLDecodeError as error:
        raise InvalidValueError("file", str(path), f"TOML ({error})") from None


def checked(
    document: type[Document], values: Mapping[str, Any], tables: Mapping[str, type[Part]], place: Place
) -> Document:
    """What was read as a document, whose tables are these by the keys that they stand under.

    Raises:
        InvalidValueError: a key or the kind of a value is not valid; its name begins with the place.
    """
    try:
        return document.model_validate(values)
    except ValidationError as error:
        raise _refused(error, document, tables, place) from None


def _refused(
    error: ValidationError, document: type[Part], tables: Mapping[str, type[Part]], place: Place
) -> InvalidValueError:
    """What is wrong with the file's keys and the kinds of their values, the first of it."""
    first = error.errors()[0]
    *outside, key = first["loc"]
    inner = place
    for one in _numbered(outside):
        inner = inner / one
    if first["type"] == "extra_forbidden":
        table = next((tables[one] for one in reversed(outside) if isinstance(one, str)), document)
        return inner.invalid(str(key), first["input"], f"one of the keys {', '.join(table.model_fields)}")
    if first["type"] == "missing":
        return inner.invalid(str(key), None, "a value")
    value = first["input"]
    valid = (
        first["msg"].removeprefix("Input should be ").partition(" or instance of ")[0].replace("dictionary", "table")
    )
    if isinstance(key, int):
        *outer, last = _numbered([*outside, key])
        inner = place
        for one in outer:
            inner = inner / one
        return inner.invalid(last, value, valid)
    return inner.invalid(key, value, valid)


def _numbered(parts: list[str | int]) -> list[str]:
    """Keys, with the numbers, from 1, that follow them."""
    found: list[str] = []
    for part in parts:
        if isinstance(part, int):
            found[-1] += f"[{part + 1}]"
        else:
            found.append(part)
    return found
