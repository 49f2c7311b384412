"""Reading success maps from the database; unpublished ones by the hash of their inputs alone."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Connection, RowMapping, select

from threadstate.errors import NotFoundError
from threadstate.library.published import named_row, published_rows
from threadstate.library.success_tables import success_map, success_orientation
from threadstate.numbers import number_text
from threadstate.success.document import orientation_from_document
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import inputs_from_document
from threadstate.success.model import OrientationMap


@dataclass(frozen=True)
class SuccessMap:
    """A published success map: what it was computed from, the hashes of that and of its content, and the code then."""

    id: int
    inputs: SuccessInputs
    input_sha256: str
    content_sha256: str
    code_version: str
    created_at: datetime
    published_at: datetime


def success_maps(connection: Connection) -> list[SuccessMap]:
    """All published maps, the latest first."""
    return [_record(row) for row in published_rows(connection, success_map)]


def named_success_map(connection: Connection, name: str) -> SuccessMap:
    """The published map of a name: ``latest``, the one published last, or a number.

    Raises:
        NotFoundError: it does not exist; the message says which do.
    """
    missing = f"no success map {name!r} is published"
    return _record(named_row(connection, success_map, name, missing, "`POST /v1/success-maps` requests one"))


def orientations_of_map(
    connection: Connection, map_id: int, after: int = -1, limit: int | None = None
) -> Sequence[OrientationMap]:
    """The orientations of a map with numbers above ``after``, in the order of the grid, ``limit`` at most."""
    query = (
        select(success_orientation.c.document)
        .where(success_orientation.c.map_id == map_id, success_orientation.c.orientation > after)
        .order_by(success_orientation.c.orientation)
        .limit(limit)
    )
    return [_orientation(document) for document in connection.scalars(query)]


def orientation_of_map(connection: Connection, found: SuccessMap, roll_deg: float, pitch_deg: float) -> OrientationMap:
    """An orientation of a map.

    Raises:
        NotFoundError: the grid does not contain it.
    """
    document = connection.scalar(
        select(success_orientation.c.document).where(
            success_orientation.c.map_id == found.id,
            success_orientation.c.roll_deg == roll_deg,
            success_orientation.c.pitch_deg == pitch_deg,
        )
    )
    if document is None:
        raise NotFoundError(
            f"success map {found.id} has no orientation at roll {number_text(roll_deg)}, pitch "
            f"{number_text(pitch_deg)} deg; its grid: {found.inputs.grid}"
        )
    return _orientation(document)


def committed_orientations(connection: Connection, input_sha256: str) -> Sequence[OrientationMap]:
    """What is there of the map of these inputs, published or not, in the order of the grid."""
    map_id = connection.scalar(select(success_map.c.id).where(success_map.c.input_sha256 == input_sha256))
    return [] if map_id is None else orientations_of_map(connection, map_id)


def _orientation(document: str) -> OrientationMap:
    return orientation_from_document(json.loads(document))


def _record(row: RowMapping) -> SuccessMap:
    return SuccessMap(
        id=row["id"],
        inputs=inputs_from_document(json.loads(row["inputs"])),
        input_sha256=row["input_sha256"],
        content_sha256=row["content_sha256"],
        code_version=row["code_version"],
        created_at=row["created_at"],
        published_at=row["published_at"],
    )
