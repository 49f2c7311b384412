"""The angles of a pose as parameters of a request, in degrees."""

from __future__ import annotations

from typing import Annotated

from annotated_types import Ge, Le, Lt
from fastapi import Path, Query
from pydantic import AllowInfNan

from service.numbers import NUMBER_TEXT
from threadstate.state.options import TILT_LIMIT_DEG

Tilt = Annotated[float, Ge(-TILT_LIMIT_DEG), Le(TILT_LIMIT_DEG), AllowInfNan(False), NUMBER_TEXT]
Phase = Annotated[float, Ge(0.0), Lt(360.0), AllowInfNan(False), NUMBER_TEXT]

RollPath = Annotated[Tilt, Path(description="roll in degrees", examples=[4])]
PitchPath = Annotated[Tilt, Path(description="pitch (the pose angle) in degrees", examples=[-3])]
PhasePath = Annotated[Phase, Path(description="phase in degrees", examples=[185])]

RollQuery = Annotated[Tilt | None, Query(description="roll in degrees", examples=[4])]
PitchQuery = Annotated[Tilt | None, Query(description="pitch (the pose angle) in degrees", examples=[-3])]
PhaseQuery = Annotated[Phase | None, Query(description="phase in degrees", examples=[185])]
PhaseMinQuery = Annotated[Phase | None, Query(description="smallest phase, included, in degrees", examples=[90])]
PhaseMaxQuery = Annotated[Phase | None, Query(description="largest phase, included, in degrees", examples=[180])]
