"""The unit of length that a client asks for."""

from __future__ import annotations

from typing import Annotated

from fastapi import Query

from threadstate.units import LengthUnit

UNIT_HEADER = "Length-Unit"

UnitQuery = Annotated[
    LengthUnit | None,
    Query(description="unit of all lengths in the answer; default: the thread's own", examples=["mm"]),
]
