"""``/v1/settled``, ``/v1/settled/{id}`` and the settled states below it."""

from __future__ import annotations

from datetime import datetime
from urllib.parse import urlencode

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.database import ReadConnection, RequestedControl
from service.jobs.endpoints import ACCEPTED, job_response
from service.jobs.schemas import GridToCompute, JobDocument
from service.keys import require_write_key
from service.libraries.endpoints import GridDocument
from service.libraries.requested import solved_pair
from service.quantities import UNIT_HEADER, PhasePath, PitchPath, RollPath, UnitQuery
from service.representation import NOT_MODIFIED, json_response
from service.settle.endpoints import device_of
from service.settled.parameters import AfterQuery, IdentifiedSettled, SettledFilterQuery
from service.solve import NOT_BOTH, RequestOfPair
from service.states.parameters import LimitQuery
from service.strict_json import StrictJsonRoute
from threadstate.device.document import DeviceDocument, SettledDocument, device_document, settled_document
from threadstate.device.model import Outcome, SettledFlag, default_device
from threadstate.device.settle import check_pair
from threadstate.jobs.queue import submit_job
from threadstate.library.grid import Grid
from threadstate.library.identity import pair_of
from threadstate.numbers import number_text
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import (
    SettledCounts,
    SettledLibrary,
    settled_counts,
    settled_libraries,
    settled_ordinals,
    settled_state_of_pose,
    settled_states_at,
)
from threadstate.thread.catalogue import source_of
from threadstate.thread.standards.document import SourceDocument
from threadstate.units import LengthUnit, conversion_factor


class SettledLibraryDocument(BaseModel):
    """A published library of settled states."""

    id: int
    designation: str = Field(examples=["1/4-20 UNC"])
    source: SourceDocument
    device: DeviceDocument = Field(description="the device, its lengths in its own unit; null what another key has")
    grid: GridDocument
    stored_unit: LengthUnit = Field(description="unit in which the library was computed and is stored")
    state_count: int
    code_version: str
    input_sha256: str = Field(description="SHA-256 of everything that the content depends on")
    content_sha256: str = Field(description="SHA-256 of the content")
    created_at: datetime
    published_at: datetime


class SettledCountsDocument(BaseModel):
    """How many settled states have each outcome, each flag, so many contacts, and so many falls."""

    outcomes: dict[Outcome, int]
    flags: dict[SettledFlag, int]
    contacts: dict[int, int] = Field(description="by how many contacts carry a force")
    falls: dict[int, int] = Field(description="by how many falls there were on the way")


class SettledLibraryDetail(SettledLibraryDocument):
    """A published library of settled states with the counts of its states."""

    counts: SettledCountsDocument


class SettledLibraryList(BaseModel):
    """All published libraries of settled states, the latest first."""

    settled: list[SettledLibraryDocument]


class SettledPage(BaseModel):
    """One page of settled states, in the order of roll, pitch and phase."""

    settled_library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    states: list[SettledDocument]
    next: str | None = Field(description="address of the next page, null on the last; also as `Link: rel=next`")


class SettledRequest(RequestOfPair):
    """A library of settled states to compute."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [{"device": {"unit": "mm", "push": 10}, "grid": {"phase_step": 5.0}}],
            **NOT_BOTH,
        },
    )

    device: DeviceDocument | None = Field(
        default=None, description="the device; what it leaves out is as of the default one"
    )
    grid: GridToCompute = GridToCompute()


router = APIRouter(prefix="/v1/settled", tags=["settle"], route_class=StrictJsonRoute)


@router.post(
    "",
    summary="Request a library of settled states",
    response_model=JobDocument,
    responses=ACCEPTED,
    dependencies=[Depends(require_write_key)],
)
def post_settled_library(request: Request, engine: RequestedControl, body: SettledRequest) -> Response:
    """Have a library of settled states computed, as a job. The same inputs are the same job.

    Lengths of the device are in its own unit.
    """
    pair = solved_pair(request, body.designation, body.library).pair
    check_pair(pair)
    grid = Grid(body.grid.tilt_max, body.grid.tilt_step, body.grid.phase_step)
    job = submit_job(engine, SettledInputs(pair, grid, device_of(body.device) or default_device()))
    return job_response(job, 200 if job.state.ended else 202)


@router.get("", summary="All libraries of settled states", response_model=SettledLibraryList, responses=NOT_MODIFIED)
def list_settled_libraries(request: Request, connection: ReadConnection) -> Response:
    """The published libraries of settled states, the latest first."""
    documents = [_document(record) for record in settled_libraries(connection)]
    return json_response(request, SettledLibraryList(settled=documents).model_dump(mode="json"))


@router.get(
    "/{id}", summary="One library of settled states", response_model=SettledLibraryDetail, responses=NOT_MODIFIED
)
def get_settled_library(request: Request, connection: ReadConnection, library: IdentifiedSettled) -> Response:
    """A library of settled states with its device, and how many of its states have each outcome and flag."""
    counts = _counts(settled_counts(connection, library.id))
    detail = SettledLibraryDetail(**dict(_document(library)), counts=counts)
    headers = {"Content-Location": f"/v1/settled/{library.id}"}
    return json_response(request, detail.model_dump(mode="json"), headers)


@router.get("/{id}/states", summary="Stored settled states", response_model=SettledPage, responses=NOT_MODIFIED)
def list_settled_states(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedSettled,
    which: SettledFilterQuery,
    limit: LimitQuery = 100,
    after: AfterQuery = -1,
    unit: UnitQuery = None,
) -> Response:
    """The settled states under a filter, in the order of roll, pitch and phase, page by page.

    All filters hold at once. The next page is named by `next` and by the `Link` header; walking them gives each state
    once and in order, and stays with this very library although `latest` may move on.
    """
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    found = settled_ordinals(connection, library.id, which, after, limit + 1)
    ordinals = found[:limit]
    headers = {UNIT_HEADER: shown.value}
    following = None
    if len(found) > limit:
        query = urlencode({**request.query_params, "after": ordinals[-1]})
        following = f"{request.scope.get('root_path', '')}/v1/settled/{library.id}/states?{query}"
        headers["Link"] = f'<{following}>; rel="next"'
    states = [settled_document(one, shown, factor) for one in settled_states_at(connection, library.id, ordinals)]
    page = {"settled_library": library.id, "unit": shown.value, "states": states, "next": following}
    return json_response(request, page, headers)


@router.get(
    "/{id}/states/{roll}/{pitch}/{phase}",
    summary="The settled state of a stored pose",
    response_model=SettledDocument,
    responses=NOT_MODIFIED,
)
def get_settled_state(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedSettled,
    roll: RollPath,
    pitch: PitchPath,
    phase: PhasePath,
    unit: UnitQuery = None,
) -> Response:
    """Where the bolt comes to rest at a pose of the library's grid; `POST /v1/settle` has those between."""
    shown = unit or library.length_unit
    state = settled_state_of_pose(connection, library, roll, pitch, phase)
    document = settled_document(state, shown, conversion_factor(library.length_unit, shown))
    location = f"/v1/settled/{library.id}/states/{'/'.join(map(number_text, (roll, pitch, phase)))}"
    return json_response(request, document, {UNIT_HEADER: shown.value, "Content-Location": location})


def _document(record: SettledLibrary) -> SettledLibraryDocument:
    grid = record.grid
    return SettledLibraryDocument(
        id=record.id,
        designation=record.designation,
        source=source_of(pair_of(record.pair)),
        device=DeviceDocument(**device_document(record.device)),
        grid=GridDocument(
            tilt_max=grid.tilt_max_deg,
            tilt_step=grid.tilt_step_deg,
            phase_step=grid.phase_step_deg,
            orientations=grid.orientation_count,
        ),
        stored_unit=record.length_unit,
        state_count=grid.pose_count,
        code_version=record.code_version,
        input_sha256=record.input_sha256,
        content_sha256=record.content_sha256,
        created_at=record.created_at,
        published_at=record.published_at,
    )


def _counts(counts: SettledCounts) -> SettledCountsDocument:
    return SettledCountsDocument(
        outcomes=dict(counts.of_outcome),
        flags=dict(counts.of_flag),
        contacts=dict(counts.of_contacts),
        falls=dict(counts.of_falls),
    )
