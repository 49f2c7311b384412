"""``/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/statics`` and ``POST /v1/statics``."""

from __future__ import annotations

import json
from itertools import product
from typing import Annotated

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field

from service.cache.stored import content_location
from service.database import ReadConnection
from service.kernels import require_kernels
from service.libraries.requested import IdentifiedLibrary, solved_pair
from service.quantities import UNIT_HEADER, PhasePath, PitchPath, RollPath, UnitQuery
from service.representation import JSON, NOT_MODIFIED, json_response
from service.solve import NOT_BOTH, SolveRequest
from service.statics.parameters import FrictionQuery, LoadQuery, LoadToBear, load_of
from service.strict_json import StrictJsonRoute
from threadstate.errors import InvalidValueError
from threadstate.library.identity import pair_of
from threadstate.library.pose import state_of_pose
from threadstate.state.solve import solve_poses
from threadstate.statics.document import StaticsDocument, statics_document
from threadstate.statics.load import DEFAULT_FRICTION
from threadstate.statics.solve import statics_of
from threadstate.units import LengthUnit, conversion_factor

MOST_COMBINATIONS = 1000
"""Of poses with loads in a request."""


class StaticsRequest(SolveRequest):
    """Poses, and the loads that each of them is to bear."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {"poses": [{"roll": 2, "pitch": 0, "phase": 345}], "loads": [{"force": [0.1, 0, -10], "mu": 0.25}]}
            ],
            **NOT_BOTH,
        },
    )

    loads: Annotated[
        list[LoadToBear],
        Field(
            min_length=1,
            max_length=MOST_COMBINATIONS,
            description=f"for every pose; poses times loads are {MOST_COMBINATIONS} at most",
        ),
    ]


class StaticsAnswer(BaseModel):
    """The statics of each pose under each load: the loads of the first pose in their order, then those of the next."""

    designation: str
    library: int | None = Field(description="number of the library whose pair and tolerances these are")
    unit: LengthUnit = Field(description="unit of all lengths in this response")
    statics: list[StaticsDocument]


router = APIRouter(tags=["statics"], route_class=StrictJsonRoute, dependencies=[Depends(require_kernels)])


@router.get(
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/statics",
    summary="What a load does to the state of a pose",
    response_model=StaticsDocument,
    responses=NOT_MODIFIED,
)
def get_statics(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    roll: RollPath,
    pitch: PitchPath,
    phase: PhasePath,
    load: LoadQuery,
    mu: FrictionQuery = DEFAULT_FRICTION,
    unit: UnitQuery = None,
) -> Response:
    """Whether a stored state bears a load: the least friction that holds it, forces, and the torque that turns it.

    Lengths of the load, and of the answer, are in `unit`, which the header `Length-Unit` says.
    """
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    state = state_of_pose(connection, library.id, roll, pitch, phase)
    found = statics_of(pair_of(library.pair), state, load.with_lengths_over(factor), mu)
    location = f"{content_location(library.id, roll, pitch, phase)}/statics"
    headers = {UNIT_HEADER: shown.value, "Content-Location": location}
    return json_response(request, statics_document(found, factor), headers)


@router.post("/v1/statics", summary="What loads do to poses", response_model=StaticsAnswer)
def solve_statics(request: Request, body: StaticsRequest, unit: UnitQuery = None) -> Response:
    """The statics of poses, on the grid of a library or not, each under every load: up to 1,000 of them.

    Lengths of the loads, and of the answer, are in `unit`.
    """
    count = len(body.poses) * len(body.loads)
    if count > MOST_COMBINATIONS:
        raise InvalidValueError("body poses times loads", count, f"at most {MOST_COMBINATIONS}")
    asked = solved_pair(request, body.designation, body.library)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    loads = [
        (load_of(given, f"body loads {number}").with_lengths_over(factor), given.mu)
        for number, given in enumerate(body.loads)
    ]
    states = solve_poses(asked.pair, [(pose.roll, pose.pitch, pose.phase) for pose in body.poses], asked.options)
    answer = {
        "designation": asked.pair.designation,
        "library": asked.library,
        "unit": shown.value,
        "statics": [
            statics_document(statics_of(asked.pair, state, load, mu), factor)
            for state, (load, mu) in product(states, loads)
        ],
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)
