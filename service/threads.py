"""``/v1/threads``: standard threads, the same whatever the database holds, and pictures of pairs' profiles."""

from __future__ import annotations

from functools import lru_cache
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response

from service.kernels import require_kernels
from service.libraries.requested import RequestedPair
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import JSON, NOT_MODIFIED, SVG, json_content, representation
from threadstate.thread.profiles_svg import profiles_svg
from threadstate.thread.standards.designation import found_threads
from threadstate.thread.standards.document import StandardThreadList, standard_thread_list

_CACHE_SIZE = 64

SearchQuery = Annotated[
    str | None,
    Query(
        min_length=1,
        max_length=100,
        description="a designation, in any case and with tolerance classes or without, or words that it contains; "
        "default: all",
        examples=["1/4-20 UNC-3A/3B", "unef"],
    ),
]

router = APIRouter(prefix="/v1/threads", tags=["threads"])


@router.get("", summary="Standard threads", response_model=StandardThreadList, responses=NOT_MODIFIED)
def list_threads(request: Request, search: SearchQuery = None) -> Response:
    """Standard threads with the limits of their diameters, each in the unit of its standard and, unless a designation
    has others, with the tolerance classes that are usual for it.
    """
    return representation(request, _content(search), JSON)


@router.get(
    "/profiles.svg",
    summary="The profiles of a pair with the play between them",
    response_class=Response,
    responses={200: {"content": {SVG: {"schema": {"type": "string"}}}}, **NOT_MODIFIED},
    dependencies=[Depends(require_kernels)],
)
def get_profiles(request: Request, asked: RequestedPair, unit: UnitQuery = None) -> Response:
    """A picture of the axial section of bolt and nut, with their diameters and the radial and axial play."""
    shown = unit or asked.pair.unit
    return representation(request, profiles_svg([asked.pair], shown).encode(), SVG, {UNIT_HEADER: shown.value})


@lru_cache(maxsize=_CACHE_SIZE)
def _content(search: str | None) -> bytes:
    """The threads that a search finds, as JSON; cached, as all of them are 200 kB."""
    return json_content(standard_thread_list(found_threads(search)))
