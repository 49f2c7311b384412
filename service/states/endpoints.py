"""``/v1/libraries/{id}/states`` and the state of one pose below it."""

from __future__ import annotations

from typing import get_type_hints
from urllib.parse import urlencode

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, Field
from typing_extensions import TypedDict

from service.cache.stored import content_location
from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from service.quantities import UNIT_HEADER, PhasePath, PitchPath, RollPath, UnitQuery
from service.representation import JSON, NOT_MODIFIED, json_response, representation
from service.states.parameters import FIELDS, CursorQuery, FieldsQuery, FilterQuery, LimitQuery, SortQuery
from service.states.query import decode_cursor, encode_cursor
from service.states.repository import places
from threadstate.library.pose import state_of_pose
from threadstate.library.read import states_at
from threadstate.library.statics import statics_at
from threadstate.state.document import StateDocument
from threadstate.state.json import state_json
from threadstate.statics.stored import LibraryStateDocument, library_state_document
from threadstate.units import LengthUnit, conversion_factor

ChosenFields = TypedDict(  # type: ignore[misc]
    "ChosenFields", get_type_hints(LibraryStateDocument, include_extras=True), total=False
)
"""A contact state of a library; with `fields` those of its fields alone."""


class StatePage(BaseModel):
    """One page of states."""

    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    states: list[ChosenFields] = Field(description="with `fields`, only those fields of each")
    next: str | None = Field(description="address of the next page, null on the last; also as `Link: rel=next`")


router = APIRouter(prefix="/v1/libraries/{id}/states", tags=["states"])


@router.get("", summary="States of a library", response_model=StatePage, responses=NOT_MODIFIED)
def list_states(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    which: FilterQuery,
    sort: SortQuery,
    fields: FieldsQuery,
    limit: LimitQuery = 100,
    cursor: CursorQuery = None,
    unit: UnitQuery = None,
) -> Response:
    """The states under a filter, in an order, page by page.

    All filters hold at once. The next page is named by `next` and by the `Link` header; walking them gives each state
    once and in order, and stays with this very library although `latest` may move on.
    """
    after = None if cursor is None else decode_cursor(cursor, library.id, which, sort)
    page = places(connection, library.id, which, sort, after, limit)
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    ordinals = [place.ordinal for place in page.places]
    statics = statics_at(connection, library.id, ordinals)
    documents = (
        library_state_document(state, statics[ordinal], factor)
        for ordinal, state in zip(ordinals, states_at(connection, library.id, ordinals), strict=True)
    )
    headers = {UNIT_HEADER: shown.value}
    following = None
    if page.more:
        query = {**request.query_params, "cursor": encode_cursor(page.places[-1], library.id, which, sort)}
        following = f"{request.scope.get('root_path', '')}/v1/libraries/{library.id}/states?{urlencode(query)}"
        headers["Link"] = f'<{following}>; rel="next"'
    states = [
        document if fields == FIELDS else {name: document[name] for name in fields}  # type: ignore[literal-required]
        for document in documents
    ]
    answer = {"library": library.id, "unit": shown.value, "states": states, "next": following}
    return json_response(request, answer, headers)


@router.get(
    "/{roll}/{pitch}/{phase}", summary="The state of one pose", response_model=StateDocument, responses=NOT_MODIFIED
)
def get_state(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    roll: RollPath,
    pitch: PitchPath,
    phase: PhasePath,
    unit: UnitQuery = None,
) -> Response:
    """The state of a pose of the library's grid; `POST /v1/solve` has those between.

    The header `Length-Unit` says the unit of its lengths, `Content-Location` its address in this very library.
    """
    shown = unit or library.length_unit
    state = state_of_pose(connection, library.id, roll, pitch, phase)
    content = state_json(state, conversion_factor(library.length_unit, shown))
    headers = {UNIT_HEADER: shown.value, "Content-Location": content_location(library.id, roll, pitch, phase)}
    return representation(request, content, JSON, headers)
