"""``/v1/libraries/{id}/undecided``."""

from __future__ import annotations

from typing import Annotated
from urllib.parse import urlencode

from annotated_types import Ge, Le
from fastapi import APIRouter, Query, Request, Response
from pydantic import BaseModel, Field

from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from service.quantities import INTEGER_TEXT
from service.representation import NOT_MODIFIED, json_response
from service.states.parameters import LimitQuery
from threadstate.library.grid import LARGEST_POSE_COUNT
from threadstate.library.read import undecided_between
from threadstate.state.model import UndecidedPose


class UndecidedPhase(BaseModel):
    """An undecided pose of an orientation."""

    phase: float
    reason: str = Field(description="why the solver method could not decide the pose")


class UndecidedDocument(UndecidedPhase):
    """An undecided pose, in degrees."""

    roll: float
    pitch: float


class UndecidedPage(BaseModel):
    """Undecided poses in the order of roll, pitch and phase."""

    library: int = Field(description="number of the library")
    undecided: list[UndecidedDocument]
    next: str | None = Field(description="address of the next page; null on the last")


def undecided_document(pose: UndecidedPose) -> UndecidedDocument:
    """The document of an undecided pose."""
    return UndecidedDocument(roll=pose.roll_deg, pitch=pose.pitch_deg, phase=pose.phase_deg, reason=pose.reason)


router = APIRouter(prefix="/v1/libraries/{id}/undecided", tags=["states"])

AfterQuery = Annotated[
    int, Ge(-1), Le(LARGEST_POSE_COUNT), INTEGER_TEXT, Query(description="from the `next` link of the page before")
]


@router.get("", summary="Poses without a state", response_model=UndecidedPage, responses=NOT_MODIFIED)
def list_undecided(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    limit: LimitQuery = 100,
    after: AfterQuery = -1,
) -> Response:
    """The poses of the grid that the library's solver method could not decide, and why, page by page."""
    found = undecided_between(connection, library.id, after + 1, LARGEST_POSE_COUNT, limit + 1)
    shown = found[:limit]
    following = None
    headers = {}
    if len(found) > limit:
        query = urlencode({**request.query_params, "after": shown[-1][0]})
        following = f"{request.scope.get('root_path', '')}/v1/libraries/{library.id}/undecided?{query}"
        headers["Link"] = f'<{following}>; rel="next"'
    page = UndecidedPage(library=library.id, undecided=[undecided_document(pose) for _, pose in shown], next=following)
    return json_response(request, page.model_dump(mode="json"), headers)
