"""The shape of a history in an answer."""

from __future__ import annotations

from enum import StrEnum

from pydantic import BaseModel, Field

from service.undecided.schemas import UndecidedPhase
from threadstate.state.document import StateDocument
from threadstate.units import LengthUnit


class HistoryFormat(StrEnum):
    """The formats of a history: states one by one, or columns as JSON or CSV."""

    ROWS = "rows"
    COLUMNS = "columns"
    CSV = "csv"


class _History(BaseModel):
    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this answer")
    roll: float
    pitch: float
    undecided: list[UndecidedPhase] = Field(description="the phases without a state, and why")


class HistoryRows(_History):
    """A history, state by state."""

    states: list[StateDocument]


class HistoryColumns(_History):
    """A history as columns of equal length, with the names that the CSV has in its header."""

    columns: dict[str, list[float | str | None]]
