"""``/v1/libraries`` and ``/v1/libraries/{id}``."""

from __future__ import annotations

import json
from datetime import datetime

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel, Field

from service.database import ReadConnection
from service.libraries.requested import IdentifiedLibrary
from service.quantities import UnitQuery
from service.representation import NOT_MODIFIED, json_response
from threadstate.library.identity import pair_of
from threadstate.library.named import slug
from threadstate.library.read import Counts, LibraryRecord, counts, published_libraries
from threadstate.library.solver_method import SolverMethod
from threadstate.state.model import Flag, StateClass
from threadstate.thread.catalogue import source_of
from threadstate.thread.pair import Pair
from threadstate.thread.standards.document import SourceDocument
from threadstate.units import LengthUnit

NO_CHAMFER = {"pair": {"chamfer"}}
"""Libraries are of pairs without one (decision 28), whose documents do not name it."""


class GridDocument(BaseModel):
    """The grid of a library's poses, in degrees: roll and pitch +-``tilt_max``, phase 0 up to but without 360."""

    tilt_max: float
    tilt_step: float
    phase_step: float
    orientations: int = Field(description="how many pairs of roll and pitch there are")


class LibraryDocument(BaseModel):
    """A published library."""

    id: int
    designation: str = Field(examples=["1/4-20 UNC"])
    slug: str = Field(examples=["1-4-20-unc"])
    source: SourceDocument
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    stored_unit: LengthUnit = Field(description="unit in which the library was computed and is stored")
    pair: Pair = Field(description="the bolt and the nut; lengths in this answer's unit, fillets per thread pitch")
    grid: GridDocument
    method: SolverMethod
    options: dict[str, float | str] = Field(description="limits and tolerances of the solver; lengths per thread pitch")
    state_count: int
    undecided_count: int = Field(description="number of poses of the grid that the solver method could not decide")
    code_version: str
    input_sha256: str = Field(description="SHA-256 of everything that the content depends on")
    content_sha256: str = Field(description="SHA-256 of the content; the same on every machine")
    created_at: datetime
    published_at: datetime


class CountsDocument(BaseModel):
    """Number of states of each class and with each flag."""

    classes: dict[StateClass, int]
    flags: dict[Flag, int]


class LibraryDetail(LibraryDocument):
    """A published library with the counts of its states."""

    counts: CountsDocument


class LibraryList(BaseModel):
    """All published libraries, the latest first."""

    libraries: list[LibraryDocument]


def library_document(record: LibraryRecord, unit: LengthUnit | None) -> LibraryDocument:
    """The document of a library, with its lengths in ``unit`` (None: the library's own)."""
    shown = unit or record.length_unit
    pair = pair_of(record.pair)
    return LibraryDocument(
        id=record.id,
        designation=record.designation,
        slug=slug(record.designation),
        source=source_of(pair),
        unit=shown,
        stored_unit=record.length_unit,
        pair=pair.in_unit(shown),
        grid=GridDocument(
            tilt_max=record.grid.tilt_max_deg,
            tilt_step=record.grid.tilt_step_deg,
            phase_step=record.grid.phase_step_deg,
            orientations=record.grid.orientation_count,
        ),
        method=record.method,
        options=json.loads(record.options),
        state_count=record.state_count,
        undecided_count=record.undecided_count,
        code_version=record.code_version,
        input_sha256=record.input_sha256,
        content_sha256=record.content_sha256,
        created_at=record.created_at,
        published_at=record.published_at,
    )


def library_detail(record: LibraryRecord, counts: Counts, unit: LengthUnit | None) -> LibraryDetail:
    """The document of a library with its counts."""
    document = library_document(record, unit)
    return LibraryDetail(
        **dict(document), counts=CountsDocument(classes=dict(counts.of_class), flags=dict(counts.of_flag))
    )


router = APIRouter(prefix="/v1/libraries", tags=["libraries"])


@router.get("", summary="All published libraries", response_model=LibraryList, responses=NOT_MODIFIED)
def list_libraries(request: Request, connection: ReadConnection, unit: UnitQuery = None) -> Response:
    """The published libraries, the latest first; unpublished ones are not listed."""
    documents = [library_document(record, unit) for record in published_libraries(connection)]
    return json_response(
        request,
        LibraryList(libraries=documents).model_dump(mode="json", exclude={"libraries": {"__all__": NO_CHAMFER}}),
    )


@router.get("/{id}", summary="One library", response_model=LibraryDetail, responses=NOT_MODIFIED)
def get_library(
    request: Request, connection: ReadConnection, library: IdentifiedLibrary, unit: UnitQuery = None
) -> Response:
    """What a library was computed from, and number of its states of each class and each flag."""
    document = library_detail(library, counts(connection, library.id), unit)
    headers = {"Content-Location": f"/v1/libraries/{library.id}"}
    return json_response(request, document.model_dump(mode="json", exclude=NO_CHAMFER), headers)
