"""The query parameters of a library's states."""

from __future__ import annotations

from typing import Annotated, get_type_hints

from annotated_types import Ge, Le
from fastapi import Depends, Query

from service.quantities import (
    INTEGER_TEXT,
    Friction,
    Margin,
    PhaseMaxQuery,
    PhaseMinQuery,
    PhaseQuery,
    PitchQuery,
    RollQuery,
)
from service.states.query import LONGEST_CURSOR, SORTS, Range, Sort, StateFilter
from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.state.model import Flag, StateClass
from threadstate.statics.stored import MEANINGS, LibraryStateDocument
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region

FIELDS = tuple(get_type_hints(LibraryStateDocument))
"""The fields of a state, in order."""

LARGEST_LIMIT = 1000
_INFINITE = "where no friction does it, it counts as infinite"
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
    support_margin_min: Annotated[
        Margin | None, Query(description=f"least {MEANINGS['support_margin']}; 0: supported without friction")
    ] = None,
    support_margin_max: Annotated[Margin | None, Query(description="greatest support margin")] = None,
    mu_hold_min: Annotated[
        Friction | None, Query(description=f"least value of the {MEANINGS['mu_hold']}; {_INFINITE}")
    ] = None,
    mu_hold_max: Annotated[
        Friction | None, Query(description="greatest value of it: the load is held at this friction")
    ] = None,
    mu_wedge_min: Annotated[
        Friction | None, Query(description=f"least value of the {MEANINGS['mu_wedge']}; {_INFINITE}")
    ] = None,
    mu_wedge_max: Annotated[
        Friction | None, Query(description="greatest value of it: contacts can wedge at this friction")
    ] = None,
) -> StateFilter:
    """The filter of the query parameters.

    Raises:
        InvalidValueError: a least value is above the greatest one.
        UnknownNameError: a region that this part does not have.
    """
    for name, least, greatest in (
        ("phase", phase_min, phase_max),
        ("support_margin", support_margin_min, support_margin_max),
        ("mu_hold", mu_hold_min, mu_hold_max),
        ("mu_wedge", mu_wedge_min, mu_wedge_max),
    ):
        if least is not None and greatest is not None and least > greatest:
            raise InvalidValueError(f"{name}_min", least, f"at most {name}_max, {greatest!r}")
    for name, region, regions in (("bolt_region", bolt_region, BOLT_REGIONS), ("nut_region", nut_region, NUT_REGIONS)):
        if region is not None and region not in regions:
            raise UnknownNameError(name, region.value, ", ".join(regions))
    return StateFilter(
        roll,
        pitch,
        phase,
        phase_min,
        phase_max,
        state_class,
        bolt_region,
        nut_region,
        flag,
        Range(support_margin_min, support_margin_max),
        Range(mu_hold_min, mu_hold_max),
        Range(mu_wedge_min, mu_wedge_max),
    )


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
