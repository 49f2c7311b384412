"""The shape of states in an answer; the content is made by ``threadstate.state.document``."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region
from threadstate.units import LengthUnit

VectorSchema = Annotated[list[float], Field(min_length=3, max_length=3)]


class PoseSchema(BaseModel):
    """The bolt's pose at a stage: x_nut = rotation x_bolt + translation."""

    rotation: Annotated[list[VectorSchema], Field(min_length=3, max_length=3, description="by rows")]
    translation: VectorSchema


class ContactSchema(BaseModel):
    """A contact in the pose of its stage."""

    stage: int = Field(ge=1, le=3)
    point: VectorSchema = Field(description="in the nut's frame")
    point_bolt: VectorSchema = Field(description="in the bolt's frame")
    normal: VectorSchema = Field(description="of length 1, in the nut's frame, from the nut into the bolt")
    bolt_region: Region = Field(json_schema_extra={"enum": [region.value for region in BOLT_REGIONS]})
    nut_region: Region = Field(json_schema_extra={"enum": [region.value for region in NUT_REGIONS]})
    features: FeaturePair = Field(description="what touches, the bolt's first")
    bolt_margin: float = Field(description="arc length to the nearest boundary of the bolt's region")
    nut_margin: float = Field(description="arc length to the nearest boundary of the nut's region")


class MarginsSchema(BaseModel):
    """Signed distances of the class from its thresholds, positive on the stable side."""

    drop: float | None
    embedment: float | None
    pivot_offset: float | None


class StateSchema(BaseModel):
    """A contact state; angles in degrees, lengths in the unit of the answer."""

    model_config = ConfigDict(populate_by_name=True)

    roll: float
    pitch: float
    phase: float
    state_class: StateClass = Field(alias="class")
    flags: list[Flag]
    poses: list[PoseSchema] = Field(description="one per stage reached")
    turns: list[float | None] = Field(
        min_length=2, max_length=2, description="lambda and mu; null where a stage was not reached"
    )
    drop: float | None = Field(description="how far the bolt's origin sinks from the second pose to the third")
    embedment: float | None = Field(description="least lift of the third pose after which the solids do not overlap")
    pivot_offset: float | None = Field(description="from the bolt's origin to the line through the first two contacts")
    contacts: list[ContactSchema]
    margins: MarginsSchema


def _require_nothing(schema: dict[str, Any]) -> None:
    del schema["required"]


class ChosenFieldsSchema(StateSchema):
    """A contact state; with `fields` those of its fields alone."""

    model_config = ConfigDict(json_schema_extra=_require_nothing)


class StatePage(BaseModel):
    """One page of states."""

    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    states: list[ChosenFieldsSchema] = Field(description="with `fields`, only those fields of each")
    next: str | None = Field(description="address of the next page, null on the last; also as `Link: rel=next`")
