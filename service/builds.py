"""``/v1/building``: library builds, which are not published yet."""

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
