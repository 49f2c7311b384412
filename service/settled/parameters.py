"""The library of settled states that a path names, and the filter of its states."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le
from fastapi import Depends, Path, Query

from service.database import ReadConnection
from service.quantities import INTEGER_TEXT, PhaseMaxQuery, PhaseMinQuery, PhaseQuery, PitchQuery, RollQuery
from threadstate.device.model import Outcome, SettledFlag
from threadstate.errors import InvalidValueError
from threadstate.library.grid import LARGEST_POSE_COUNT
from threadstate.library.published import LATEST
from threadstate.settled.read import SettledFilter, SettledLibrary, named_settled_library

MOST = 1000
"""Of contacts, and of falls, that a filter can ask for."""

SettledId = Annotated[
    str,
    Path(
        alias="id",
        min_length=1,
        max_length=100,
        description="`latest`, the library of settled states published last, or its number",
        examples=[LATEST, "1"],
    ),
]


def identified_settled(connection: ReadConnection, library_id: SettledId) -> SettledLibrary:
    """The published library of settled states that ``library_id`` means.

    Raises:
        NotFoundError: it does not exist.
    """
    return named_settled_library(connection, library_id)


IdentifiedSettled = Annotated[SettledLibrary, Depends(identified_settled)]

Count = Annotated[int, Ge(0), Le(MOST), INTEGER_TEXT]


def settled_filter(
    roll: RollQuery = None,
    pitch: PitchQuery = None,
    phase: PhaseQuery = None,
    phase_min: PhaseMinQuery = None,
    phase_max: PhaseMaxQuery = None,
    outcome: Annotated[Outcome | None, Query(description="how the push ended")] = None,
    flag: Annotated[SettledFlag | None, Query(description="a flag of the settled state")] = None,
    contacts: Annotated[Count | None, Query(description="how many contacts carry a force")] = None,
    falls: Annotated[Count | None, Query(description="how many falls there were on the way")] = None,
) -> SettledFilter:
    """The filter of the query parameters.

    Raises:
        InvalidValueError: the least phase is above the greatest.
    """
    if phase_min is not None and phase_max is not None and phase_min > phase_max:
        raise InvalidValueError("phase_min", phase_min, f"at most phase_max, {phase_max!r}")
    return SettledFilter(roll, pitch, phase, phase_min, phase_max, outcome, flag, contacts, falls)


SettledFilterQuery = Annotated[SettledFilter, Depends(settled_filter)]
AfterQuery = Annotated[
    int, Ge(-1), Le(LARGEST_POSE_COUNT), INTEGER_TEXT, Query(description="from the `next` link of the page before")
]
