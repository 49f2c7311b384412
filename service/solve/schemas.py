"""The shape of poses to be solved, and of the answer."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from service.angles import Tilt
from service.states.schemas import StateSchema
from threadstate.thread.catalogue import DEFAULT_DESIGNATION
from threadstate.units import LengthUnit

LARGEST_POSE_COUNT = 1000
LARGEST_PHASE_DEG = 36000.0

_FORBID = ConfigDict(extra="forbid", strict=True)


class PoseToSolve(BaseModel):
    """A pose, in degrees; any, on a library's grid or not."""

    model_config = _FORBID

    roll: Tilt
    pitch: Tilt
    phase: Annotated[float, Field(ge=-LARGEST_PHASE_DEG, le=LARGEST_PHASE_DEG, allow_inf_nan=False)]


class SolveRequest(BaseModel):
    """Poses to be solved."""

    model_config = ConfigDict(
        **_FORBID, json_schema_extra={"examples": [{"poses": [{"roll": 1, "pitch": -2, "phase": 10.5}]}]}
    )

    designation: Annotated[str, Field(min_length=1, max_length=100, description="the thread")] = DEFAULT_DESIGNATION
    poses: Annotated[list[PoseToSolve], Field(min_length=1, max_length=LARGEST_POSE_COUNT)]


class SolveAnswer(BaseModel):
    """The states of the poses, in their order."""

    designation: str
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    states: list[StateSchema]
