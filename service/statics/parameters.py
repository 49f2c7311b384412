"""A load and a friction as query parameters, and as a part of a body."""

from __future__ import annotations

import sys
from typing import Annotated, Any

from annotated_types import Ge, Le
from fastapi import Depends, Query
from pydantic import AllowInfNan, BaseModel, ConfigDict, Field

from service.quantities import NUMBER_TEXT
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text, three_numbers
from threadstate.statics.load import DEFAULT_FRICTION, LARGEST_NUMBER, Load, Vector

_LONGEST_VECTOR = 100
_DEFAULT = Load()
_PUSH = ",".join(map(number_text, _DEFAULT.force))
_NO_MOMENT = ",".join(map(number_text, _DEFAULT.moment))

FORCE = "force on the bolt in N, in the nut's frame"
MOMENT = "moment on the bolt, in N times the unit of length; it or the force is not zero"
POINT = "the point about which the moment is taken, in the nut's frame; default: the bolt's origin"
FRICTION = "coefficient of friction of all contacts, 0 or more"

Friction = Annotated[float, Ge(0.0), Le(sys.float_info.max), AllowInfNan(False), NUMBER_TEXT]
FrictionQuery = Annotated[Friction, Query(description=FRICTION)]
"""``mu``; its default is ``DEFAULT_FRICTION``."""


def _vector(description: str, example: str) -> Any:
    return Query(
        min_length=1,
        max_length=_LONGEST_VECTOR,
        description=f"{description}; three numbers, separated by commas",
        examples=[example],
    )


def given_load(
    force: Annotated[str, _vector(FORCE, "0.1,0,-10")] = _PUSH,
    moment: Annotated[str, _vector(MOMENT, "0,0.5,0")] = _NO_MOMENT,
    point: Annotated[str | None, _vector(POINT, "0,0,0.1")] = None,
) -> Load:
    """The load of the query parameters, its lengths in the unit of the request.

    Raises:
        InvalidValueError: a text is not three numbers, or they are not those of a load.
    """
    return Load(
        force=three_numbers("force", force),
        moment=three_numbers("moment", moment),
        point=None if point is None else three_numbers("point", point),
    )


LoadQuery = Annotated[Load, Depends(given_load)]

Component = Annotated[float, Field(ge=-LARGEST_NUMBER, le=LARGEST_NUMBER, allow_inf_nan=False)]
GivenVector = Annotated[list[Component], Field(min_length=3, max_length=3)]


class LoadToBear(BaseModel):
    """A load on the bolt, and the friction of the contacts; `{}` is a push of 1 N."""

    model_config = ConfigDict(extra="forbid", strict=True)

    force: Annotated[GivenVector, Field(description=FORCE)] = list(_DEFAULT.force)
    moment: Annotated[GivenVector, Field(description=MOMENT)] = list(_DEFAULT.moment)
    point: Annotated[GivenVector | None, Field(description=POINT)] = None
    mu: Annotated[float, Field(ge=0.0, allow_inf_nan=False, description=FRICTION)] = DEFAULT_FRICTION


def load_of(given: LoadToBear, location: str) -> Load:
    """The load of a part of a body, which is at ``location``; its lengths in the unit of the request.

    Raises:
        InvalidValueError: it is zero.
    """
    try:
        return Load(_three(given.force), _three(given.moment), None if given.point is None else _three(given.point))
    except InvalidValueError as error:
        raise InvalidValueError(f"{location} {error.name}", error.value, error.valid) from None


def _three(numbers: list[float]) -> Vector:
    x, y, z = numbers
    return x, y, z
