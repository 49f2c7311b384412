"""``/v1/libraries`` and ``/v1/libraries/{id}``."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from service.database import ReadConnection
from service.libraries.identify import IdentifiedLibrary
from service.libraries.schemas import LibraryDetail, LibraryList, library_detail, library_document
from service.representation import NOT_MODIFIED, json_response
from service.units import UnitQuery
from threadstate.library.read import counts, published_libraries

router = APIRouter(prefix="/v1/libraries", tags=["libraries"])


@router.get("", summary="All published libraries", response_model=LibraryList, responses=NOT_MODIFIED)
def list_libraries(request: Request, connection: ReadConnection, unit: UnitQuery = None) -> Response:
    """The published libraries, the latest first; what is still being computed is not shown."""
    documents = [library_document(record, unit) for record in published_libraries(connection)]
    return json_response(request, LibraryList(libraries=documents).model_dump(mode="json"))


@router.get("/{id}", summary="One library", response_model=LibraryDetail, responses=NOT_MODIFIED)
def get_library(
    request: Request, connection: ReadConnection, library: IdentifiedLibrary, unit: UnitQuery = None
) -> Response:
    """What a library was computed from, and how many of its states have each class and each flag."""
    document = library_detail(library, counts(connection, library.id), unit)
    headers = {"Content-Location": f"/v1/libraries/{library.id}"}
    return json_response(request, document.model_dump(mode="json"), headers)
