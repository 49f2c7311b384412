"""``/v1/success-maps``: requested, listed, read by orientation; and the map of a job as it grows."""

from __future__ import annotations

from typing import Annotated
from urllib.parse import urlencode

from annotated_types import Ge, Le
from fastapi import APIRouter, Depends, Path, Query, Request, Response

from service.database import ReadConnection, RequestedControl
from service.jobs.endpoints import ACCEPTED, JobId, job_response
from service.jobs.schemas import JobDocument
from service.keys import require_write_key
from service.libraries.requested import identified_library, solved_pair
from service.quantities import INTEGER_TEXT, UNIT_HEADER, PitchPath, RollPath, UnitQuery
from service.representation import NOT_MODIFIED, json_response
from service.settle.endpoints import device_of
from service.strict_json import StrictJsonRoute
from service.success.schemas import (
    GrowingMap,
    SuccessMapDetail,
    SuccessMapList,
    SuccessOrientationPage,
    SuccessRequest,
    success_map_document,
)
from threadstate.device.model import default_device
from threadstate.device.settle import check_pair
from threadstate.errors import NotFoundError
from threadstate.jobs.queue import job_by_id, submit_job
from threadstate.library.grid import LARGEST_POSE_COUNT, Grid
from threadstate.library.identity import pair_of
from threadstate.library.published import LATEST
from threadstate.numbers import number_text
from threadstate.success.inputs import SuccessInputs
from threadstate.success.read import (
    SuccessMap,
    committed_orientations,
    named_success_map,
    orientation_of_map,
    orientations_of_map,
    success_maps,
)
from threadstate.success.summary_document import (
    SummarisedOrientationDocument,
    summarised_document,
    totals_documents,
)
from threadstate.units import conversion_factor

LARGEST_PAGE = 1000

SuccessMapId = Annotated[
    str,
    Path(
        alias="id",
        min_length=1,
        max_length=100,
        description="`latest`, the success map published last, or its number",
        examples=[LATEST, "1"],
    ),
]
LimitQuery = Annotated[
    int, Ge(1), Le(LARGEST_PAGE), INTEGER_TEXT, Query(description="how many orientations a page has at most")
]
PairOfLibraryQuery = Annotated[
    str | None,
    Query(
        min_length=1,
        max_length=100,
        description="only maps of the pair of this library, which is named as in a path",
    ),
]
AfterQuery = Annotated[
    int, Ge(-1), Le(LARGEST_POSE_COUNT), INTEGER_TEXT, Query(description="from the `next` link of the page before")
]


def identified_map(connection: ReadConnection, map_id: SuccessMapId) -> SuccessMap:
    """The published success map that ``map_id`` means.

    Raises:
        NotFoundError: it does not exist.
    """
    return named_success_map(connection, map_id)


IdentifiedMap = Annotated[SuccessMap, Depends(identified_map)]

router = APIRouter(prefix="/v1", tags=["success"], route_class=StrictJsonRoute)


@router.post(
    "/success-maps",
    summary="Request a success map",
    response_model=JobDocument,
    responses=ACCEPTED,
    dependencies=[Depends(require_write_key)],
)
def post_success_map(request: Request, engine: RequestedControl, body: SuccessRequest) -> Response:
    """Have a success map computed, as a job. The same inputs are the same job.

    Lengths of the device are in its own unit. The map of a job can be read while it grows.
    """
    pair = solved_pair(request, body.designation, body.library).pair
    check_pair(pair)
    inputs = SuccessInputs(
        pair,
        device_of(body.device) or default_device(),
        body.strategy,
        Grid(body.grid.tilt_max, body.grid.tilt_step, body.grid.phase_step),
        tuple(body.mu),
        body.phase_tolerance,
        body.mu_tolerance,
        body.point_limit,
    )
    job = submit_job(engine, inputs)
    return job_response(job, 200 if job.state.ended else 202)


@router.get("/success-maps", summary="All success maps", response_model=SuccessMapList, responses=NOT_MODIFIED)
def list_success_maps(request: Request, connection: ReadConnection, library: PairOfLibraryQuery = None) -> Response:
    """The published success maps, the latest first; with ``library`` those of its pair."""
    found = success_maps(connection)
    if library is not None:
        pair = pair_of(identified_library(connection, library).pair)
        found = [record for record in found if record.inputs.pair == pair]
    documents = [success_map_document(record) for record in found]
    return json_response(request, SuccessMapList(success_maps=documents).model_dump(mode="json"))


@router.get("/success-maps/{id}", summary="One success map", response_model=SuccessMapDetail, responses=NOT_MODIFIED)
def get_success_map(request: Request, connection: ReadConnection, found: IdentifiedMap) -> Response:
    """A success map with its device, and how many of its orientations engage at each friction."""
    totals = totals_documents(orientations_of_map(connection, found.id), found.inputs)
    document = {**success_map_document(found).model_dump(mode="json"), "summary": totals}
    return json_response(request, document, {"Content-Location": f"/v1/success-maps/{found.id}"})


@router.get(
    "/success-maps/{id}/orientations",
    summary="Orientations of a success map",
    response_model=SuccessOrientationPage,
    responses=NOT_MODIFIED,
)
def list_success_orientations(
    request: Request,
    connection: ReadConnection,
    found: IdentifiedMap,
    limit: LimitQuery = 100,
    after: AfterQuery = -1,
    unit: UnitQuery = None,
) -> Response:
    """What a map has of each orientation, in the order of roll and pitch, page by page."""
    shown = unit or found.inputs.pair.unit
    factor = conversion_factor(found.inputs.pair.unit, shown)
    orientations = orientations_of_map(connection, found.id, after, limit + 1)
    headers = {UNIT_HEADER: shown.value}
    following = None
    if len(orientations) > limit:
        query = urlencode({**request.query_params, "after": orientations[limit - 1].index})
        following = f"{request.scope.get('root_path', '')}/v1/success-maps/{found.id}/orientations?{query}"
        headers["Link"] = f'<{following}>; rel="next"'
    documents = [
        summarised_document(one, found.inputs.grid, found.inputs.frictions, factor) for one in orientations[:limit]
    ]
    page = {"success_map": found.id, "unit": shown.value, "orientations": documents, "next": following}
    return json_response(request, page, headers)


@router.get(
    "/success-maps/{id}/orientations/{roll}/{pitch}",
    summary="One orientation of a success map",
    response_model=SummarisedOrientationDocument,
    responses=NOT_MODIFIED,
)
def get_success_orientation(
    request: Request,
    connection: ReadConnection,
    found: IdentifiedMap,
    roll: RollPath,
    pitch: PitchPath,
    unit: UnitQuery = None,
) -> Response:
    """What a map has of an orientation: every path, boundaries of outcome, the critical friction, and a summary."""
    shown = unit or found.inputs.pair.unit
    orientation = orientation_of_map(connection, found, roll, pitch)
    factor = conversion_factor(found.inputs.pair.unit, shown)
    document = summarised_document(orientation, found.inputs.grid, found.inputs.frictions, factor)
    place = "/".join(map(number_text, (roll, pitch)))
    location = f"/v1/success-maps/{found.id}/orientations/{place}"
    return json_response(request, document, {UNIT_HEADER: shown.value, "Content-Location": location})


@router.get(
    "/jobs/{id}/success-map",
    summary="The success map of a job, as far as it is computed",
    response_model=GrowingMap,
    responses=NOT_MODIFIED,
)
def get_growing_map(request: Request, connection: ReadConnection, job_id: JobId, unit: UnitQuery = None) -> Response:
    """The orientations that are committed, whether the job has ended or not; its events say when there are more."""
    job = job_by_id(connection, job_id)
    inputs = job.inputs
    if not isinstance(inputs, SuccessInputs):
        raise NotFoundError(f"job {job_id} computes a {job.kind.words}, not a success map")
    orientations = committed_orientations(connection, job.input_sha256)
    shown = unit or inputs.pair.unit
    factor = conversion_factor(inputs.pair.unit, shown)
    document = {
        "job": job.id,
        "chunks": job.chunk_count,
        "unit": shown.value,
        "summary": totals_documents(orientations, inputs),
        "orientations": [summarised_document(one, inputs.grid, inputs.frictions, factor) for one in orientations],
    }
    return json_response(request, document, {UNIT_HEADER: shown.value})
