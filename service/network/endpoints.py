"""A library's histories, and its constraint network."""

from __future__ import annotations

from typing import Annotated
from urllib.parse import urlencode

from annotated_types import Ge, Le
from fastapi import APIRouter, Depends, Path, Query, Request, Response

from service.database import ReadConnection
from service.kernels import require_kernels
from service.network.cache import RequestedNetwork
from service.network.parameters import (
    LeastQuery,
    MovesQuery,
    NetworkFormat,
    ObjectiveQuery,
    ObservationQuery,
    RequiredKey,
    TransitionQuery,
)
from service.network.schemas import (
    FormationsAnswer,
    HeightsAnswer,
    HeldAnswer,
    IntervalsAnswer,
    LoadedNetworkSummary,
    LocationAnswer,
    NetworkSummary,
    NodeAnswer,
    NodeLinkNetwork,
    PathAnswer,
    TransitionsPage,
    WindowsAnswer,
)
from service.quantities import (
    INTEGER_TEXT,
    UNIT_HEADER,
    PhaseQuery,
    PitchPath,
    PitchQuery,
    RollPath,
    RollQuery,
    UnitQuery,
)
from service.representation import JSON, NOT_MODIFIED, json_response, representation
from service.statics.parameters import (
    AVOIDED,
    AvoidQuery,
    FrictionQuery,
    FrictionsQuery,
    Loaded,
    LoadQuery,
    UnderLoad,
    needs_friction,
)
from threadstate.errors import InvalidValueError
from threadstate.history.falls import SNAP_PITCHES
from threadstate.network.cells import CellMap
from threadstate.network.formation import KEY_DIGITS
from threadstate.network.locate import locate
from threadstate.network.paths import best_path
from threadstate.network.search import Objective
from threadstate.responses.heights import heights_document, stored_heights
from threadstate.responses.held import held_documents
from threadstate.responses.histories import history_document
from threadstate.responses.library_network import LibraryNetwork
from threadstate.responses.loaded_network import LoadedNetwork
from threadstate.responses.networks import loaded_summary_document, location_document, node_document, path_document
from threadstate.responses.query import filter_transitions
from threadstate.responses.transitions import transition_documents
from threadstate.responses.windows import windows_of_histories
from threadstate.statics.load import DEFAULT_FRICTION
from threadstate.units import LengthUnit, conversion_factor

router = APIRouter(prefix="/v1/libraries/{id}", tags=["network"])

LARGEST_LIMIT = 100
LARGEST_OFFSET = 10_000_000
GRAPHML = "application/graphml+xml"
DOT = "text/vnd.graphviz"

KeyPath = Annotated[str, Path(min_length=KEY_DIGITS, max_length=KEY_DIGITS, description="key of a formation")]


def _unit(network: LibraryNetwork, unit: LengthUnit | None) -> tuple[LengthUnit, float]:
    stored = network.library.length_unit
    shown = unit or stored
    return shown, conversion_factor(stored, shown)


def _under(network: LibraryNetwork, loaded: Loaded | None, factor: float) -> LoadedNetwork | None:
    return None if loaded is None else network.under(loaded.load.with_lengths_over(factor), loaded.mu)


def _cell_map(network: LibraryNetwork, loaded: Loaded | None, factor: float) -> CellMap:
    under = _under(network, loaded, factor)
    return network.cell_map if under is None else under.cell_map


@router.get(
    "/histories/{roll}/{pitch}/intervals",
    summary="The intervals of an orientation",
    response_model=IntervalsAnswer,
    responses=NOT_MODIFIED,
)
def get_intervals(
    request: Request, network: RequestedNetwork, roll: RollPath, pitch: PitchPath, unit: UnitQuery = None
) -> Response:
    """The phase circle of an orientation, cut where any label changes or a height jumps, each boundary solved."""
    shown, factor = _unit(network, unit)
    stored = network.histories.orientations[network.orientation(roll, pitch)]
    history = history_document(stored, roll, pitch, network.pair, factor)
    answer = IntervalsAnswer(library=network.library.id, unit=shown, history=history)
    return _json(request, answer, shown)


@router.get(
    "/histories/{roll}/{pitch}/heights",
    summary="Height against phase",
    response_model=HeightsAnswer,
    responses=NOT_MODIFIED,
    dependencies=[Depends(require_kernels)],
)
def get_heights(
    request: Request,
    connection: ReadConnection,
    network: RequestedNetwork,
    roll: RollPath,
    pitch: PitchPath,
    unit: UnitQuery = None,
) -> Response:
    """The height of the bolt's origin at as many phases as straight lines between them need to be right."""
    shown, factor = _unit(network, unit)
    found = stored_heights(connection, network, roll, pitch)
    heights = heights_document(found, roll, pitch, network.pair.thread_pitch, factor)
    return _json(request, HeightsAnswer(library=network.library.id, unit=shown, heights=heights), shown)


@router.get(
    "/histories/{roll}/{pitch}/held",
    summary="Where a load holds along the phase",
    response_model=HeldAnswer,
    responses=NOT_MODIFIED,
    dependencies=[Depends(require_kernels)],
)
def get_held(
    request: Request,
    network: RequestedNetwork,
    roll: RollPath,
    pitch: PitchPath,
    load: LoadQuery,
    mus: FrictionsQuery,
    unit: UnitQuery = None,
) -> Response:
    """At which phases of an orientation the contacts can hold a load or wedge, at each friction; boundaries solved.

    Lengths of the load are in `unit`.
    """
    _, factor = _unit(network, unit)
    cells = network.histories.orientations[network.orientation(roll, pitch)].cells
    held = held_documents(network.pair, network.options, (roll, pitch), cells, load.with_lengths_over(factor), mus)
    answer = HeldAnswer(library=network.library.id, held=held)
    return json_response(request, answer.model_dump(mode="json"))


@router.get(
    "/transitions",
    summary="Transitions",
    response_model=TransitionsPage,
    responses=NOT_MODIFIED,
    dependencies=[Depends(require_kernels)],
)
def list_transitions(
    request: Request,
    loaded: UnderLoad,
    network: RequestedNetwork,
    which: TransitionQuery,
    limit: Annotated[
        int, Ge(1), Le(LARGEST_LIMIT), INTEGER_TEXT, Query(description="how many a page has at most")
    ] = 50,
    after: Annotated[
        int, Ge(0), Le(LARGEST_OFFSET), INTEGER_TEXT, Query(description="from the `next` link of the page before")
    ] = 0,
    unit: UnitQuery = None,
) -> Response:
    """From which interval to which, along phase and to the orientations beside; all filters hold at once.

    Heights and normals along phase are stored ones. Those of tilts are solved for the page, half way through the
    stretch over which the tilt can be made, unless that is shorter than 0.001 deg. With `mu` each transition is marked
    by what a load does where it begins.
    """
    shown, factor = _unit(network, unit)
    found = filter_transitions(network, which)
    page = found[after : after + limit]
    following = None
    headers = {}
    if after + limit < len(found):
        query = urlencode({**request.query_params, "after": after + limit})
        following = f"{request.scope.get('root_path', '')}/v1/libraries/{network.library.id}/transitions?{query}"
        headers["Link"] = f'<{following}>; rel="next"'
    answer = TransitionsPage(
        library=network.library.id,
        unit=shown,
        count=len(found),
        transitions=transition_documents(
            page, network.histories, network.tilts, factor, _under(network, loaded, factor)
        ),
        next=following,
    )
    return _json(request, answer, shown, headers)


@router.get(
    "/windows", summary="Falls, snaps and clearance windows", response_model=WindowsAnswer, responses=NOT_MODIFIED
)
def list_windows(
    request: Request,
    network: RequestedNetwork,
    roll: RollQuery = None,
    pitch: PitchQuery = None,
    least: LeastQuery = SNAP_PITCHES,
    unit: UnitQuery = None,
) -> Response:
    """Where a bolt turned counter-clockwise goes down and how far, where it snaps, where it can go on down."""
    shown, factor = _unit(network, unit)
    found = windows_of_histories(network.histories, roll, pitch, network.pair, factor, least)
    return _json(request, WindowsAnswer(library=network.library.id, unit=shown, orientations=found), shown)


@router.get(
    "/network",
    summary="The constraint network",
    response_model=NetworkSummary | NodeLinkNetwork,
    responses={
        200: {"content": {GRAPHML: {"schema": {"type": "string"}}, DOT: {"schema": {"type": "string"}}}},
        **NOT_MODIFIED,
    },
)
def get_network(
    request: Request,
    network: RequestedNetwork,
    format: Annotated[  # noqa: A002 - the parameter's name in the address
        NetworkFormat, Query(description="`summary` is its size and its connectivity; the others are all of it")
    ] = NetworkFormat.SUMMARY,
) -> Response:
    """Formations and what leads from one to another: its size, or all of it as node-link JSON, GraphML or DOT."""
    match format:
        case NetworkFormat.NODE_LINK:
            return representation(request, network.node_link, JSON)
        case NetworkFormat.GRAPHML:
            return representation(request, network.graphml, GRAPHML)
        case NetworkFormat.DOT:
            return representation(request, network.dot, DOT)
        case NetworkFormat.SUMMARY:
            answer = NetworkSummary(library=network.library.id, network=network.summary)
            return json_response(request, answer.model_dump(mode="json", by_alias=True))


@router.get(
    "/network/loaded",
    summary="The constraint network under a load",
    response_model=LoadedNetworkSummary,
    responses=NOT_MODIFIED,
    dependencies=[Depends(require_kernels)],
)
def get_loaded_network(
    request: Request,
    network: RequestedNetwork,
    load: LoadQuery,
    avoid: AvoidQuery,
    mu: FrictionQuery = DEFAULT_FRICTION,
    unit: UnitQuery = None,
) -> Response:
    """How much of all phases is free, held or wedged under a load, and the dead ends.

    A load is solved at all orientations when it is first asked for, which takes a while. Its lengths are in `unit`.
    """
    _, factor = _unit(network, unit)
    cell_map = network.under(load.with_lengths_over(factor), mu).cell_map
    summary = loaded_summary_document(network.network, cell_map, mu, AVOIDED if avoid is None else avoid)
    answer = LoadedNetworkSummary(library=network.library.id, network=summary)
    return json_response(request, answer.model_dump(mode="json"))


@router.get("/network/formations", summary="All formations", response_model=FormationsAnswer, responses=NOT_MODIFIED)
def list_formations(request: Request, network: RequestedNetwork) -> Response:
    """A summary of every formation: class, share, where it occurs, how far it is to the window; ordered by key."""
    answer = FormationsAnswer(library=network.library.id, formations=network.formations)
    return json_response(request, answer.model_dump(mode="json", by_alias=True))


@router.get("/network/formations/{key}", summary="One formation", response_model=NodeAnswer, responses=NOT_MODIFIED)
def get_formation(request: Request, network: RequestedNetwork, key: KeyPath, unit: UnitQuery = None) -> Response:
    """Where a formation occurs, what can follow it, and how far it is to the clearance window."""
    shown, factor = _unit(network, unit)
    node = node_document(network.network, key, factor)
    return _json(request, NodeAnswer(library=network.library.id, unit=shown, node=node), shown)


@router.get("/network/paths", summary="The best path to the window", response_model=PathAnswer, responses=NOT_MODIFIED)
def get_path(
    request: Request,
    loaded: UnderLoad,
    network: RequestedNetwork,
    start: RequiredKey,
    moves: MovesQuery,
    avoid: AvoidQuery,
    objective: ObjectiveQuery = Objective.TURNING,
    roll: RollQuery = None,
    pitch: PitchQuery = None,
    phase: PhaseQuery = None,
    unit: UnitQuery = None,
) -> Response:
    """From a formation, at any orientation or at one, to the clearance window, by the moves allowed.

    With `mu` no move leaves what a load marks as one of `avoid`.
    """
    needs_friction(None if loaded is None else loaded.mu, avoid=avoid)
    shown, factor = _unit(network, unit)
    if (roll is None) != (pitch is None) or (phase is not None and roll is None):
        raise InvalidValueError("roll, pitch, phase", (roll, pitch, phase), "none, roll and pitch, or all three")
    orientation = None if roll is None or pitch is None else network.orientation(roll, pitch)
    cell_map = _cell_map(network, loaded, factor)
    path = best_path(
        cell_map,
        network.network.node(start).formation,
        objective,
        moves,
        orientation=orientation,
        phase_deg=phase,
        avoid=AVOIDED if avoid is None else avoid,
    )
    document = None if path is None else path_document(path, cell_map, factor)
    return _json(request, PathAnswer(library=network.library.id, unit=shown, path=document), shown)


@router.get(
    "/network/locate",
    summary="Orientations and phases that match an observation",
    response_model=LocationAnswer,
    responses=NOT_MODIFIED,
)
def get_location(
    request: Request,
    loaded: UnderLoad,
    network: RequestedNetwork,
    observed: ObservationQuery,
    unit: UnitQuery = None,
) -> Response:
    """The orientations and phases at which a state can have all that was observed, and their share of all.

    What a bolt does under a load can be observed as well: `verdict`, with `mu`. Lengths of the load are in `unit`.
    """
    if (observed.verdict is None) != (loaded is None):
        value = (observed.verdict, None if loaded is None else loaded.mu)
        raise InvalidValueError("verdict, mu", value, "both or none: a verdict is that at a friction")
    _, factor = _unit(network, unit)
    cell_map = _cell_map(network, loaded, factor)
    location = location_document(locate(cell_map, observed), cell_map)
    answer = LocationAnswer(library=network.library.id, location=location)
    return json_response(request, answer.model_dump(mode="json", by_alias=True))


def _json(
    request: Request,
    answer: IntervalsAnswer | HeightsAnswer | TransitionsPage | WindowsAnswer | NodeAnswer | PathAnswer,
    unit: LengthUnit,
    headers: dict[str, str] | None = None,
) -> Response:
    document = answer.model_dump(mode="json", by_alias=True)
    return json_response(request, document, {UNIT_HEADER: unit.value, **(headers or {})})
