"""Library builds: unpublished libraries and their progress."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from sqlalchemy import Connection, func, select

from threadstate.library.solver_method import SolverMethod
from threadstate.library.tables import chunk, library


@dataclass(frozen=True)
class LibraryBuild:
    """A library that is not published yet; ``done`` of its ``orientations`` are stored."""

    designation: str
    method: SolverMethod
    orientations: int
    done: int
    created_at: datetime


def library_builds(connection: Connection) -> list[LibraryBuild]:
    """All unpublished libraries, the latest first."""
    done = select(func.count()).where(chunk.c.library_id == library.c.id).scalar_subquery()
    query = (
        select(library.c.designation, library.c.method, library.c.tilt_count, done, library.c.created_at)
        .where(library.c.published_at.is_(None))
        .order_by(library.c.created_at.desc(), library.c.id.desc())
    )
    return [
        LibraryBuild(designation, SolverMethod(method), tilt_count**2, stored, created_at)
        for designation, method, tilt_count, stored, created_at in connection.execute(query)
    ]
