"""Pages of states; the shape of a state is that of ``threadstate.state.document``."""

from __future__ import annotations

from pydantic import BaseModel, Field
from typing_extensions import TypedDict

from threadstate.state.document import StateDocument
from threadstate.units import LengthUnit

ChosenFields = TypedDict("ChosenFields", StateDocument.__annotations__, total=False)  # type: ignore[misc]
"""A contact state; with `fields` those of its fields alone."""


class StatePage(BaseModel):
    """One page of states."""

    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    states: list[ChosenFields] = Field(description="with `fields`, only those fields of each")
    next: str | None = Field(description="address of the next page, null on the last; also as `Link: rel=next`")
