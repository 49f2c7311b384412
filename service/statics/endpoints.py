"""``/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/statics`` and ``.../jamming``, ``POST /v1/statics``, and
``/v1/states/{roll}/{pitch}/{phase}/jamming``.
"""

from __future__ import annotations

import json
from itertools import product
from typing import Annotated

from fastapi import APIRouter, Depends, Query, Request, Response
from pydantic import ConfigDict, Field

from service.cache.stored import content_location
from service.database import ReadConnection
from service.kernels import require_kernels
from service.libraries.requested import AnswerOfPair, IdentifiedLibrary, RequestedPair, solved_pair
from service.quantities import UNIT_HEADER, PhasePath, PitchPath, RollPath, UnitQuery
from service.representation import JSON, NOT_MODIFIED, SVG, json_response, representation
from service.solve import NOT_BOTH, SolveRequest
from service.statics.parameters import (
    DiagramFormat,
    DiagramQuery,
    DiagramShape,
    FrictionQuery,
    IncludeQuery,
    LoadQuery,
    LoadToBear,
    load_of,
)
from service.strict_json import StrictJsonRoute
from threadstate.errors import InvalidValueError
from threadstate.library.identity import pair_of
from threadstate.library.pose import state_of_pose
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_poses
from threadstate.statics.document import RequestedStaticsDocument, requested_document
from threadstate.statics.extras import Extra, extras_of
from threadstate.statics.jamming import jamming_diagram
from threadstate.statics.jamming_document import ComputedJammingDocument, JammingDocument, jamming_document
from threadstate.statics.jamming_svg import jamming_svg
from threadstate.statics.load import DEFAULT_FRICTION, Load
from threadstate.statics.solve import statics_of
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit, conversion_factor

MOST_COMBINATIONS = 1000
"""Of poses with loads in a request."""
MOST_WITH_MODES = 10
"""The same where contact modes are requested, which can take a second each."""


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
    include: Annotated[
        list[Annotated[Extra, Field(strict=False)]],
        Field(
            max_length=len(Extra),
            default_factory=list,
            description=f"what is added; with modes poses times loads are {MOST_WITH_MODES} at most",
        ),
    ]


class StaticsAnswer(AnswerOfPair):
    """The statics of each pose under each load: the loads of the first pose in their order, then those of the next."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    statics: list[RequestedStaticsDocument]


FormatQuery = Annotated[DiagramFormat, Query(description="its numbers, or a picture of it")]

router = APIRouter(tags=["statics"], route_class=StrictJsonRoute, dependencies=[Depends(require_kernels)])


@router.get(
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/statics",
    summary="What a load does to the state of a pose",
    response_model=RequestedStaticsDocument,
    response_model_exclude_unset=True,
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
    requested: IncludeQuery,
    mu: FrictionQuery = DEFAULT_FRICTION,
    unit: UnitQuery = None,
) -> Response:
    """Whether a stored state bears a load: the least friction that holds it, forces, and the torque that turns it.

    Lengths of the load, and of the answer, are in `unit`, which the header `Length-Unit` says.
    """
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    state = state_of_pose(connection, library.id, roll, pitch, phase)
    document = _statics(pair_of(library.pair), state, load.with_lengths_over(factor), mu, requested, factor)
    location = f"{content_location(library.id, roll, pitch, phase)}/statics"
    headers = {UNIT_HEADER: shown.value, "Content-Location": location}
    return json_response(request, document, headers)


@router.get(
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/jamming",
    summary="The jamming diagram of a pose's state",
    response_model=JammingDocument,
    responses={200: {"content": {SVG: {"schema": {"type": "string"}}}}, **NOT_MODIFIED},
)
def get_jamming(
    request: Request,
    connection: ReadConnection,
    library: IdentifiedLibrary,
    roll: RollPath,
    pitch: PitchPath,
    phase: PhasePath,
    load: LoadQuery,
    shape: DiagramQuery,
    mu: FrictionQuery = DEFAULT_FRICTION,
    format: FormatQuery = DiagramFormat.JSON,  # noqa: A002 - the parameter's name in the address
    unit: UnitQuery = None,
) -> Response:
    """Which loads beside a push the contacts of a stored state can balance, in a plane of loads.

    Forces are over the push, moments over the push times the nominal radius. Lengths of the load are in `unit`.
    """
    shown = unit or library.length_unit
    factor = conversion_factor(library.length_unit, shown)
    state = state_of_pose(connection, library.id, roll, pitch, phase)
    document = _diagram(pair_of(library.pair), state, load, mu, shape, factor)
    location = f"{content_location(library.id, roll, pitch, phase)}/jamming"
    headers = {UNIT_HEADER: shown.value, "Content-Location": location}
    if format is DiagramFormat.SVG:
        return representation(request, jamming_svg(document).encode(), SVG, headers)
    return json_response(request, document, headers)


@router.get(
    "/v1/states/{roll}/{pitch}/{phase}/jamming",
    summary="The jamming diagram of any pose",
    response_model=ComputedJammingDocument,
    responses={200: {"content": {SVG: {"schema": {"type": "string"}}}}},
)
def get_computed_jamming(
    roll: RollPath,
    pitch: PitchPath,
    phase: PhasePath,
    asked: RequestedPair,
    load: LoadQuery,
    shape: DiagramQuery,
    mu: FrictionQuery = DEFAULT_FRICTION,
    format: FormatQuery = DiagramFormat.JSON,  # noqa: A002 - the parameter's name in the address
    unit: UnitQuery = None,
) -> Response:
    """The same of any pose, computed on request."""
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    (state,) = solve_poses(asked.pair, [(roll, pitch, phase)], asked.options)
    document = _diagram(asked.pair, state, load, mu, shape, factor)
    is_svg = format is DiagramFormat.SVG
    answer = ComputedJammingDocument(
        **document, designation=asked.pair.designation, source=asked.source, library=asked.library
    )
    content = jamming_svg(document) if is_svg else json.dumps(answer, separators=(",", ":"), allow_nan=False)
    headers = {UNIT_HEADER: shown.value, "Cache-Control": "no-store"}
    return Response(content, headers=headers, media_type=SVG if is_svg else JSON)


@router.post("/v1/statics", summary="What loads do to poses", response_model=StaticsAnswer)
def solve_statics(request: Request, body: StaticsRequest, unit: UnitQuery = None) -> Response:
    """The statics of poses, on the grid of a library or not, each under every load: up to 1,000 of them, or 10 with
    contact modes.

    Lengths of the loads, and of the answer, are in `unit`.
    """
    count = len(body.poses) * len(body.loads)
    most = MOST_WITH_MODES if Extra.MODES in body.include else MOST_COMBINATIONS
    if count > most:
        raise InvalidValueError("body poses times loads", count, f"at most {most}")
    asked = solved_pair(request, body.designation, body.library)
    shown = unit or asked.pair.unit
    factor = conversion_factor(asked.pair.unit, shown)
    loads = [
        (load_of(given, f"body loads {number}").with_lengths_over(factor), given.mu)
        for number, given in enumerate(body.loads)
    ]
    requested = frozenset(body.include)
    states = solve_poses(asked.pair, [(pose.roll, pose.pitch, pose.phase) for pose in body.poses], asked.options)
    answer = {
        "designation": asked.pair.designation,
        "source": asked.source,
        "library": asked.library,
        "unit": shown.value,
        "statics": [
            _statics(asked.pair, state, load, mu, requested, factor) for state, (load, mu) in product(states, loads)
        ],
    }
    content = json.dumps(answer, separators=(",", ":"), allow_nan=False)
    return Response(content, headers={UNIT_HEADER: shown.value, "Cache-Control": "no-store"}, media_type=JSON)


def _statics(
    pair: Pair, state: ContactState, load: Load, mu: float, requested: frozenset[Extra], factor: float
) -> RequestedStaticsDocument:
    found = statics_of(pair, state, load, mu)
    extras = extras_of(pair, state, found, requested) if requested else None
    return requested_document(found, extras, factor)


def _diagram(
    pair: Pair, state: ContactState, load: Load, mu: float, shape: DiagramShape, factor: float
) -> JammingDocument:
    diagram = jamming_diagram(
        pair,
        state,
        mu,
        shape.axes,
        load=load.with_lengths_over(factor),
        contacts=shape.contacts,
        window=shape.window,
        tolerance=shape.tolerance,
    )
    return jamming_document(state, diagram, factor)
