"""TOML files of pairs: their schema, parsing, and errors that name file and key."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from threadstate.errors import InvalidValueError
from threadstate.thread.hand import Hand
from threadstate.units import LengthUnit


@dataclass(frozen=True)
class FileLocation:
    """A table of a file.

    As a context manager it adds its path to the name of an InvalidValueError; with ``exact`` the path replaces the
    name.
    """

    path: str
    exact: bool = False

    def __truediv__(self, key: str) -> FileLocation:
        """The table under a key of this one."""
        return FileLocation(f"{self.path}{'' if self.path.endswith(': ') else '.'}{key}")

    def at(self, key: str) -> FileLocation:
        """The value of a key, as a context."""
        return FileLocation((self / key).path, exact=True)

    def invalid(self, key: str, value: object, valid: str) -> InvalidValueError:
        """The error that the value of a key is not valid."""
        return InvalidValueError((self / key).path, value, valid)

    def __enter__(self) -> None:
        """Do nothing."""

    def __exit__(
        self, _kind: type[BaseException] | None, error: BaseException | None, _traceback: TracebackType | None
    ) -> None:
        """Add the location to an error."""
        if isinstance(error, InvalidValueError):
            name = self.path if self.exact else (self / error.name).path
            raise InvalidValueError(name, error.value, error.valid) from None


LARGEST_DESIGNATION = 100

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Name = Annotated[str, Field(min_length=1, max_length=LARGEST_DESIGNATION)]


class Part(BaseModel):
    """A table of the file; other keys than those of the model are invalid."""

    model_config = ConfigDict(extra="forbid")

    def given(self) -> dict[str, Any]:
        """The values that the file gives."""
        return {name: getattr(self, name) for name in self.model_fields_set}


class FormPart(Part):
    """A thread form; fillets in multiples of the thread pitch."""

    name: Name | None = None
    flank_half_angle_deg: Number | None = None
    bolt_root_fillet: Number | None = None
    bolt_crest_fillet: Number | None = None
    nut_root_fillet: Number | None = None
    nut_crest_fillet: Number | None = None
    flank_half_angle_neg_deg: Number | None = None


class FitPart(Part):
    """A fit, in the pair's unit."""

    name: Name | None = None
    bolt_major_diameter: Number | None = None
    bolt_pitch_diameter: Number | None = None
    bolt_minor_diameter: Number | None = None
    nut_major_diameter: Number | None = None
    nut_pitch_diameter: Number | None = None
    nut_minor_diameter: Number | None = None


class ChamferPart(Part):
    """The chamfer of the bolt's base: its end diameter in the pair's unit, its angle from the base plane."""

    end_diameter: Number | None = None
    angle_deg: Number | None = None


class PairPart(Part):
    """A pair: a known one by its designation, or one's own by its dimensions, which ``like`` may give in part."""

    designation: Name
    like: str | None = None
    unit: LengthUnit | None = None
    nominal_diameter: Number | None = None
    thread_pitch: Number | None = None
    starts: int | None = None
    hand: Hand | None = None
    form: FormPart | None = None
    fit: FitPart | None = None
    chamfer: ChamferPart | None = None
    fits: Annotated[list[FitPart], Field(min_length=1)] | None = None


class PairsPart(Part):
    """The pairs of a file that lists them."""

    pair: list[PairPart]


TABLES: dict[str, type[Part]] = {
    "pair": PairPart,
    "form": FormPart,
    "fit": FitPart,
    "fits": FitPart,
    "chamfer": ChamferPart,
}
"""The tables by their keys."""

Document = TypeVar("Document", bound=Part)


def read_toml(path: Path) -> dict[str, Any]:
    """Parse a TOML file.

    Raises:
        InvalidValueError: the file cannot be read or is not TOML.
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
    document: type[Document], values: Mapping[str, Any], tables: Mapping[str, type[Part]], location: FileLocation
) -> Document:
    """Validate the values of a file; ``tables`` are the models of its tables by key.

    Raises:
        InvalidValueError: a key or the kind of a value is not valid; its name begins with the location.
    """
    try:
        return document.model_validate(values)
    except ValidationError as error:
        raise _refused(error, document, tables, location) from None


def _refused(
    error: ValidationError, document: type[Part], tables: Mapping[str, type[Part]], location: FileLocation
) -> InvalidValueError:
    """The first validation error, as an error that names the key."""
    first = error.errors()[0]
    *outside, key = first["loc"]
    inner = location
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
        inner = location
        for one in outer:
            inner = inner / one
        return inner.invalid(last, value, valid)
    return inner.invalid(key, value, valid)


def _numbered(parts: list[str | int]) -> list[str]:
    """Keys with their indices, from 1."""
    found: list[str] = []
    for part in parts:
        if isinstance(part, int):
            found[-1] += f"[{part + 1}]"
        else:
            found.append(part)
    return found
