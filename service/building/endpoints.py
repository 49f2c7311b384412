"""``/v1/building``."""

from __future__ import annotations

from datetime import datetime

from fastapi import APIRouter, Response
from pydantic import BaseModel, Field

from service.database import ReadConnection
from threadstate.library.builds import library_builds
from threadstate.library.solver_method import SolverMethod

router = APIRouter(prefix="/v1/building", tags=["libraries"])


class BuildingDocument(BaseModel):
    """A library that is not published yet."""

    designation: str = Field(examples=["1/4-20 UNC"])
    method: SolverMethod
    orientations: int = Field(description="how many there are to compute")
    done: int = Field(description="how many of them are stored")
    created_at: datetime


class BuildingList(BaseModel):
    """All libraries that are begun and not published, the latest first."""

    building: list[BuildingDocument]


@router.get("", summary="Libraries that are still being computed")
def list_building(connection: ReadConnection, response: Response) -> BuildingList:
    """How far each library is that was begun and is not published; one that was given up stays in this list."""
    response.headers["Cache-Control"] = "no-store"
    return BuildingList(
        building=[
            BuildingDocument(
                designation=one.designation,
                method=one.method,
                orientations=one.orientations,
                done=one.done,
                created_at=one.created_at,
            )
            for one in library_builds(connection)
        ]
    )
