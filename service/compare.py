"""``/v1/compare``."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from service.database import ReadConnection
from service.representation import NOT_MODIFIED, json_response
from threadstate.errors import InvalidValueError
from threadstate.library.figures import library_figures
from threadstate.library.named import LATEST, named_library
from threadstate.responses.comparison import ComparisonDocument, compared_library

MOST_COMPARED = 20

LibrariesQuery = Annotated[
    str,
    Query(
        min_length=1,
        max_length=2000,
        description=f"1 to {MOST_COMPARED} libraries, each named as in a path, separated by commas",
        examples=["1-4-20-unc,m6x1-6g-6h"],
    ),
]

router = APIRouter(prefix="/v1/compare", tags=["libraries"])


@router.get("", summary="Libraries side by side", response_model=ComparisonDocument, responses=NOT_MODIFIED)
def compare_libraries(request: Request, connection: ReadConnection, libraries: LibrariesQuery = LATEST) -> Response:
    """Windows, snaps, classes, least friction and embedment of libraries over all of their orientations, in numbers
    that compare between threads of any size: lengths in thread pitches, windows in degrees of phase.
    """
    names = [name.strip(" ") for name in libraries.split(",")]
    if not all(names) or len(names) > MOST_COMPARED:
        valid = f"1 to {MOST_COMPARED} names of libraries, separated by commas"
        raise InvalidValueError("libraries", libraries, valid)
    found = [library_figures(connection, named_library(connection, name)) for name in names]
    document = ComparisonDocument(libraries=[compared_library(one) for one in found])
    return json_response(request, document.model_dump(mode="json"))
