"""A load and a friction as query parameters and as a part of a body, and what is requested beside them."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from enum import StrEnum
from typing import Annotated, Any

from annotated_types import Ge, Le
from fastapi import Depends, Query, Request
from pydantic import AllowInfNan, BaseModel, ConfigDict, Field

from service.kernels import require_kernels
from service.quantities import NUMBER_TEXT
from threadstate.errors import InvalidValueError
from threadstate.network.loaded import Mark
from threadstate.numbers import number_text, three_numbers
from threadstate.responses.query import parse_axes, parse_contacts, parse_frictions, parse_marks, parse_window
from threadstate.statics.extras import Extra, requested_extras
from threadstate.statics.jamming import COARSEST, DEFAULT_AXES, FINEST, TOLERANCE, Axis
from threadstate.statics.load import DEFAULT_FRICTION, LARGEST_NUMBER, Load, Vector
from threadstate.statics.verdict import Verdict

_LONGEST_VECTOR = 100
_LONGEST_INCLUDE = len(", ".join(Extra))
_LONGEST_AVOID = len(",".join(Mark))
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


@dataclass(frozen=True, slots=True)
class Loaded:
    """A load, its lengths in the unit of the request, and the friction of all contacts."""

    load: Load
    mu: float


async def under_load(
    request: Request,
    mu: Annotated[Friction | None, Query(description=f"under a load: {FRICTION}")] = None,
    force: Annotated[str | None, _vector(f"{FORCE}; with `mu`", _PUSH)] = None,
    moment: Annotated[str | None, _vector(f"{MOMENT}; with `mu`", _NO_MOMENT)] = None,
    point: Annotated[str | None, _vector(f"{POINT}; with `mu`", "0,0,0.1")] = None,
) -> Loaded | None:
    """The load of the query parameters; None without ``mu``.

    Raises:
        InvalidValueError: a load without ``mu``, or one that is not valid.
        KernelsCompilingError: a load, while the kernels are being compiled.
    """
    needs_friction(mu, force=force, moment=moment, point=point)
    if mu is None:
        return None
    await require_kernels(request)
    load = given_load(_PUSH if force is None else force, _NO_MOMENT if moment is None else moment, point)
    return Loaded(load, mu)


UnderLoad = Annotated[Loaded | None, Depends(under_load)]


def needs_friction(mu: float | None, **given: object) -> None:
    """Check that nothing of a load is given without a friction.

    Raises:
        InvalidValueError: something is.
    """
    for name, value in given.items():
        if mu is None and value is not None:
            raise InvalidValueError(name, value, "with mu, the coefficient of friction under that load")


def include(
    include: Annotated[
        str | None,
        Query(
            min_length=1,
            max_length=_LONGEST_INCLUDE,
            description=f"what is added, separated by commas: {', '.join(Extra)}",
            examples=["reaction"],
        ),
    ] = None,
) -> frozenset[Extra]:
    """What is requested beside the statics of a state.

    Raises:
        UnknownNameError: a name is none of what can be.
    """
    return frozenset() if include is None else requested_extras(include)


IncludeQuery = Annotated[frozenset[Extra], Depends(include)]


class DiagramFormat(StrEnum):
    """The formats of a jamming diagram."""

    JSON = "json"
    SVG = "svg"


@dataclass(frozen=True, slots=True)
class DiagramShape:
    """Which plane of loads a jamming diagram shows, of which contacts, how much of it and how closely."""

    axes: tuple[str, ...]
    contacts: tuple[int, ...] | None
    window: tuple[float, float] | None
    tolerance: float


def diagram_shape(
    axes: Annotated[
        str,
        Query(
            min_length=1,
            max_length=_LONGEST_VECTOR,
            description=f"what is varied beside the push: two of {', '.join(Axis)}, separated by a comma",
        ),
    ] = ",".join(DEFAULT_AXES),
    contacts: Annotated[
        str | None,
        Query(
            min_length=1,
            max_length=_LONGEST_VECTOR,
            description="these alone, from 1, separated by commas; default: all",
            examples=["1,2"],
        ),
    ] = None,
    window: Annotated[
        str | None,
        Query(
            min_length=1,
            max_length=_LONGEST_VECTOR,
            description="half widths of what is seen of an unbounded diagram, separated by a comma; default: what "
            "shows its corners",
            examples=["2,2"],
        ),
    ] = None,
    tolerance: Annotated[
        Annotated[float, Ge(FINEST), Le(COARSEST), AllowInfNan(False), NUMBER_TEXT],
        Query(
            description="the gap between the true boundary and the vertices that is aimed at, over the diagram's size"
        ),
    ] = TOLERANCE,
) -> DiagramShape:
    """The shape of the query parameters.

    Raises:
        InvalidValueError: contacts or a window that are no numbers.
    """
    return DiagramShape(
        parse_axes(axes),
        None if contacts is None else parse_contacts("contacts", contacts),
        None if window is None else parse_window("window", window),
        tolerance,
    )


DiagramQuery = Annotated[DiagramShape, Depends(diagram_shape)]


def frictions(
    mu: Annotated[
        str,
        Query(min_length=1, max_length=_LONGEST_VECTOR, description=f"{FRICTION}; several, separated by commas"),
    ] = "0.1,0.2,0.3",
) -> tuple[float, ...]:
    """The coefficients of friction of the query parameter.

    Raises:
        InvalidValueError: one is not a number, negative or not finite.
    """
    return parse_frictions(mu)


FrictionsQuery = Annotated[tuple[float, ...], Depends(frictions)]


def avoided(
    avoid: Annotated[
        str | None,
        Query(
            max_length=_LONGEST_AVOID,
            description="under a load: what is so marked is not left, separated by commas: "
            f"{', '.join(Mark)}; default: {Mark.WEDGED}",
            examples=["held,wedged"],
        ),
    ] = None,
) -> frozenset[Verdict] | None:
    """The verdicts that no move leaves; None where not said.

    Raises:
        UnknownNameError: a mark that does not exist.
    """
    return None if avoid is None else parse_marks(avoid)


AvoidQuery = Annotated[frozenset[Verdict] | None, Depends(avoided)]
AVOIDED = parse_marks(Mark.WEDGED)
"""Where nothing else is said."""

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
