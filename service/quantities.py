"""Numbers, angles and units of length as parameters of a request."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Literal

from annotated_types import Ge, Le, Lt
from fastapi import Path, Query
from pydantic import AllowInfNan, BeforeValidator
from pydantic_core import PydanticKnownError

from threadstate.numbers import integer, number
from threadstate.state.options import TILT_LIMIT_DEG
from threadstate.units import LengthUnit


def _written(read: Callable[[str], float], error_type: Literal["float_parsing", "int_parsing"]) -> BeforeValidator:
    """Rejects other texts with pydantic's error; whether a body may contain numbers as text is up to its model."""

    def check(value: object) -> object:
        if isinstance(value, str):
            try:
                read(value)
            except ValueError:
                raise PydanticKnownError(error_type) from None
        return value

    return BeforeValidator(check)


# Must be last in an annotation: the OpenAPI document leaves out limits that follow it.
NUMBER_TEXT = _written(number, "float_parsing")
"""Validates a text that is parsed as a number."""
INTEGER_TEXT = _written(integer, "int_parsing")
"""Validates a text that is parsed as an integer."""

Tilt = Annotated[float, Ge(-TILT_LIMIT_DEG), Le(TILT_LIMIT_DEG), AllowInfNan(False), NUMBER_TEXT]
Margin = Annotated[float, Ge(-1.0), Le(1.0), AllowInfNan(False), NUMBER_TEXT]
Friction = Annotated[float, Ge(0.0), Le(1e6), AllowInfNan(False), NUMBER_TEXT]
Phase = Annotated[float, Ge(0.0), Lt(360.0), AllowInfNan(False), NUMBER_TEXT]

RollPath = Annotated[Tilt, Path(description="roll in degrees", examples=[4])]
PitchPath = Annotated[Tilt, Path(description="pitch (the pose angle) in degrees", examples=[-3])]
PhasePath = Annotated[Phase, Path(description="phase in degrees", examples=[185])]

RollQuery = Annotated[Tilt | None, Query(description="roll in degrees", examples=[4])]
PitchQuery = Annotated[Tilt | None, Query(description="pitch (the pose angle) in degrees", examples=[-3])]
PhaseQuery = Annotated[Phase | None, Query(description="phase in degrees", examples=[185])]
PhaseMinQuery = Annotated[Phase | None, Query(description="smallest phase, included, in degrees", examples=[90])]
PhaseMaxQuery = Annotated[Phase | None, Query(description="largest phase, included, in degrees", examples=[180])]

UNIT_HEADER = "Length-Unit"

UnitQuery = Annotated[
    LengthUnit | None,
    Query(description="unit of all lengths in the answer; default: the thread's own", examples=["mm"]),
]
