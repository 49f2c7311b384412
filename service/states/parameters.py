"""The query parameters of a library's states."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le
from fastapi import Depends, Query

from service.quantities import INTEGER_TEXT, PhaseMaxQuery, PhaseMinQuery, PhaseQuery, PitchQuery, RollQuery
from service.states.query import LONGEST_CURSOR, SORTS, Sort, StateFilter
from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.state.document import StateDocument
from threadstate.state.model import Flag, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region

FIELDS = tuple(StateDocument.__annotations__)
"""The fields of a state, in order."""

LARGEST_LIMIT = 1000
_LONGEST_FIELDS = len(",".join(FIELDS))


def state_filter(
    roll: RollQuery = None,
    pitch: PitchQuery = None,
    phase: PhaseQuery = None,
    phase_min: PhaseMinQuery = None,
    phase_max: PhaseMaxQuery = None,
    state_class: Annotated[StateClass | None, Query(alias="class", description="the state's class")] = None,
    bolt_region: Annotated[
        Region | None,
        Query(
            description="region of the bolt that any contact lies on",
            json_schema_extra={"enum": [region.value for region in BOLT_REGIONS]},
        ),
    ] = None,
    nut_region: Annotated[
        Region | None,
        Query(
            description="region of the nut that any contact lies on",
            json_schema_extra={"enum": [region.value for region in NUT_REGIONS]},
        ),
    ] = None,
    flag: Annotated[Flag | None, Query(description="a flag of the state")] = None,
) -> StateFilter:
    """The filter of the query parameters.

    Raises:
        InvalidValueError: ``phase_min`` is above ``phase_max``.
        UnknownNameError: a region that this part does not have.
    """
    if phase_min is not None and phase_max is not None and phase_min > phase_max:
        raise InvalidValueError("phase_min", phase_min, f"at most phase_max, {phase_max!r}")
    for name, region, regions in (("bolt_region", bolt_region, BOLT_REGIONS), ("nut_region", nut_region, NUT_REGIONS)):
        if region is not None and region not in regions:
            raise UnknownNameError(name, region.value, ", ".join(regions))
    return StateFilter(roll, pitch, phase, phase_min, phase_max, state_class, bolt_region, nut_region, flag)


def state_sort(
    sort: Annotated[
        str,
        Query(
            max_length=32,
            description="order of the states, `-` before it for the reverse; what is absent counts as smallest",
            json_schema_extra={"enum": list(SORTS)},
        ),
    ] = "roll",
) -> Sort:
    """The order of the query parameter.

    Raises:
        UnknownNameError: no such order.
    """
    if sort not in SORTS:
        raise UnknownNameError("sort", sort, ", ".join(SORTS))
    return SORTS[sort]


def state_fields(
    fields: Annotated[
        str | None,
        Query(
            min_length=1,
            max_length=_LONGEST_FIELDS,
            description=f"only these fields of each state, separated by commas; any of {', '.join(FIELDS)}",
            examples=["roll,pitch,phase,class"],
        ),
    ] = None,
) -> tuple[str, ...]:
    """The fields of the query parameter, in the order of the document.

    Raises:
        UnknownNameError: no such field.
    """
    if fields is None:
        return FIELDS
    names = fields.split(",")
    for name in names:
        if name not in FIELDS:
            raise UnknownNameError("fields", name, ", ".join(FIELDS))
    return tuple(name for name in FIELDS if name in names)


FilterQuery = Annotated[StateFilter, Depends(state_filter)]
SortQuery = Annotated[Sort, Depends(state_sort)]
FieldsQuery = Annotated[tuple[str, ...], Depends(state_fields)]
LimitQuery = Annotated[
    int, Ge(1), Le(LARGEST_LIMIT), INTEGER_TEXT, Query(description="how many states a page has at most")
]
CursorQuery = Annotated[
    str | None,
    Query(min_length=1, max_length=LONGEST_CURSOR, description="from the `next` link of the page before"),
]
