"""The shape of poses to be solved, and of the answer."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from service.angles import Tilt
from service.libraries.solved_pair import LIBRARY_DESCRIPTION
from threadstate.state.document import StateDocument
from threadstate.thread.catalogue import DEFAULT_DESIGNATION
from threadstate.units import LengthUnit

LARGEST_POSE_COUNT = 1000
LARGEST_PHASE_DEG = 36000.0

_FORBID = ConfigDict(extra="forbid", strict=True)
_BOTH: dict[str, Any] = {
    "required": ["designation", "library"],
    "properties": {"designation": {"type": "string"}, "library": {"type": ["integer", "string"]}},
}


class PoseToSolve(BaseModel):
    """A pose, in degrees; any, on a library's grid or not."""

    model_config = _FORBID

    roll: Tilt
    pitch: Tilt
    phase: Annotated[float, Field(ge=-LARGEST_PHASE_DEG, le=LARGEST_PHASE_DEG, allow_inf_nan=False)]


class SolveRequest(BaseModel):
    """Poses to be solved."""

    model_config = ConfigDict(
        **_FORBID,
        json_schema_extra={
            "examples": [{"poses": [{"roll": 1, "pitch": -2, "phase": 10.5}]}],
            "not": _BOTH,
        },
    )

    designation: Annotated[str, Field(min_length=1, max_length=100)] | None = Field(
        default=None, description=f"the thread; {DEFAULT_DESIGNATION} where neither it nor a library is given"
    )
    library: Annotated[int, Field(ge=1)] | Annotated[str, Field(min_length=1, max_length=100)] | None = Field(
        default=None, description=LIBRARY_DESCRIPTION
    )
    poses: Annotated[list[PoseToSolve], Field(min_length=1, max_length=LARGEST_POSE_COUNT)]


class SolveAnswer(BaseModel):
    """The states of the poses, in their order."""

    designation: str
    library: int | None = Field(description="number of the library whose pair and tolerances these are")
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    states: list[StateDocument]
