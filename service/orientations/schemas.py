"""The shape of an orientation's summary in an answer."""

from __future__ import annotations

from pydantic import BaseModel, Field

from threadstate.library.orientations import OrientationSummary
from threadstate.state.model import StateClass
from threadstate.units import LengthUnit


class OrientationDocument(BaseModel):
    """An orientation over all phases of the grid; a length is null where none of its states has it."""

    roll: float
    pitch: float
    counts: dict[StateClass, int] = Field(description="how many of its states have each class")
    drop_most: float | None = Field(description="greatest drop")
    embedment_most: float | None = Field(description="greatest embedment")
    pivot_offset_least: float | None = Field(description="least pivot offset")
    margin_least: float | None = Field(description="least distance of any of a class's numbers from its threshold")


class OrientationsAnswer(BaseModel):
    """All orientations in the order of roll and pitch."""

    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    orientations: list[OrientationDocument]


def orientation_document(summary: OrientationSummary, factor: float) -> OrientationDocument:
    """The document of a summary, with its lengths multiplied by ``factor``."""

    def scaled(value: float | None) -> float | None:
        return None if value is None else value * factor

    return OrientationDocument(
        roll=summary.roll_deg,
        pitch=summary.pitch_deg,
        counts=dict(summary.of_class),
        drop_most=scaled(summary.drop_most),
        embedment_most=scaled(summary.embedment_most),
        pivot_offset_least=scaled(summary.pivot_offset_least),
        margin_least=scaled(summary.margin_least),
    )
