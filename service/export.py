"""``/v1/libraries/{id}/export/{table}.{format}``."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from fastapi.responses import StreamingResponse

from service.content_negotiation import names_etag
from service.database import engine_of
from service.libraries.requested import LibraryId, identified_library
from service.quantities import UNIT_HEADER, UnitQuery
from service.representation import NOT_MODIFIED, REVALIDATE, REVALIDATE_PRIVATELY
from service.request_scope import HEAD_REQUEST
from threadstate.export.file import file_name, file_parts, file_sha256
from threadstate.export.names import FileFormat, TableName

router = APIRouter(prefix="/v1/libraries/{id}/export", tags=["export"])

TablePath = Annotated[TableName, Path(description="which table")]
FormatPath = Annotated[FileFormat, Path(description="in which format")]


@router.get(
    "/{table}.{format}",
    summary="A library as a file",
    response_class=Response,
    responses={
        200: {
            "content": {
                FileFormat.PARQUET.media_type: {"schema": {"type": "string", "format": "binary"}},
                FileFormat.CSV.media_type: {"schema": {"type": "string"}},
                FileFormat.NDJSON.media_type: {"schema": {"type": "string"}},
            }
        },
        **NOT_MODIFIED,
    },
)
def get_export(
    request: Request,
    library_id: LibraryId,
    table: TablePath,
    format: FormatPath,  # noqa: A002 - the parameter's name in the address
    unit: UnitQuery = None,
) -> Response:
    """All states of a library, all intervals of its histories, or all poses without a state, written as they are read.

    A response that breaks off is incomplete; `If-None-Match` is answered without reading the tables.
    """
    engine = engine_of(request)
    # Not the request's connection, which would be held as long as the file is read.
    with engine.connect() as connection:
        library = identified_library(connection, library_id)
    shown = unit or library.length_unit
    etag = f'"{file_sha256(library, table, format, shown)}"'
    headers = {
        "ETag": etag,
        "Cache-Control": REVALIDATE_PRIVATELY if request.app.state.read_keys_required else REVALIDATE,
        "Content-Disposition": f'attachment; filename="{file_name(library, table, format)}"',
        "Content-Location": f"/v1/libraries/{library.id}/export/{table}.{format}",
        UNIT_HEADER: shown.value,
    }
    if names_etag(request.headers.get("if-none-match", ""), etag):
        return Response(status_code=304, headers=headers)
    content = () if request.scope.get(HEAD_REQUEST) else _begun(file_parts(engine, library, table, format, shown))
    return StreamingResponse(content, headers=headers, media_type=format.media_type)


def _begun(parts: Iterator[bytes]) -> Iterable[bytes]:
    """The same parts, the first one computed: an early failure is an error response and not a broken one."""
    first = next(parts, b"")
    return chain((first,), parts)
