"""Libraries that are still being computed: how far they are, and nothing of what they hold."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Connection, func, select

from threadstate.library.method import Method
from threadstate.library.tables import chunk, library


@dataclass(frozen=True)
class BuildingLibrary:
    """A library that is not published yet: ``done`` of its ``orientations`` are stored."""

    designation: str
    method: Method
    orientations: int
    done: int
    created_at: datetime


def building_libraries(connection: Connection) -> list[BuildingLibrary]:
    """All libraries that are begun and not published, the latest first."""
    done = select(func.count()).where(chunk.c.library_id == library.c.id).scalar_subquery()
    query = (
        select(library.c.designation, library.c.method, library.c.tilt_count, done, library.c.created_at)
        .where(library.c.published_at.is_(None))
        .order_by(library.c.created_at.desc(), library.c.id.desc())
    )
    return [
        BuildingLibrary(designation, Method(method), tilt_count**2, stored, created_at)
        for designation, method, tilt_count, stored, created_at in connection.execute(query)
    ]
