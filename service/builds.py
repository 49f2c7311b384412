"""``/v1/building``: library builds, which are not published yet."""

from __future__ import annotations

from datetime import datetime

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field
from sqlalchemy import func, select

from service.database import ReadConnection
from threadstate.library.solver_method import SolverMethod
from threadstate.library.tables import chunk, library

router = APIRouter(prefix="/v1/building", tags=["libraries"])


class BuildingDocument(BaseModel):
    """A library that is not published yet."""

    designation: str = Field(examples=["1/4-20 UNC"])
    method: SolverMethod
    orientations: int = Field(description="number of orientations of the library")
    done: int = Field(description="number of stored orientations")
    created_at: datetime


class BuildingList(BaseModel):
    """All libraries that are not published yet, the latest first."""

    building: list[BuildingDocument]


@router.get("", summary="Libraries that are still being computed")
def list_building(connection: ReadConnection, response: Response) -> BuildingList:
    """The progress of all unpublished libraries; abandoned ones stay in this list."""
    response.headers["Cache-Control"] = "no-store"
    stored = select(func.count()).where(chunk.c.library_id == library.c.id).scalar_subquery()
    query = (
        select(library.c.designation, library.c.method, library.c.tilt_count, stored, library.c.created_at)
        .where(library.c.published_at.is_(None))
        .order_by(library.c.created_at.desc(), library.c.id.desc())
    )
    return BuildingList(
        building=[
            BuildingDocument(
                designation=designation,
                method=SolverMethod(method),
                orientations=tilt_count**2,
                done=done,
                created_at=created_at,
            )
            for designation, method, tilt_count, done, created_at in connection.execute(query)
        ]
    )
