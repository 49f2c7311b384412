"""Requests for histories and the constraint network."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from threadstate.client.call import (
    LATEST,
    Call,
    LibraryName,
    PagedCall,
    QueryValue,
    get,
    get_content,
    joined,
    library_path,
    path_of,
)
from threadstate.client.loads import load_query, under_load_query
from threadstate.client.models.network import (
    ComputedFalls,
    ComputedHeights,
    ComputedIntervals,
    FormationsAnswer,
    HeightsAnswer,
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
from threadstate.responses.documents import TransitionDocument
from threadstate.statics.load import DEFAULT_FRICTION

LARGEST_PAGE = 100
GRAPHML = "application/graphml+xml"
DOT = "text/vnd.graphviz"


def intervals(
    roll: float, pitch: float, *, library: LibraryName = LATEST, unit: str | None = None
) -> Call[IntervalsAnswer]:
    """The phase circle of an orientation, cut where any label changes, its boundaries, falls and windows."""
    return get(library_path(library, "histories", roll, pitch, "intervals"), IntervalsAnswer, unit=unit)


def heights(
    roll: float, pitch: float, *, library: LibraryName = LATEST, unit: str | None = None
) -> Call[HeightsAnswer]:
    """The height of the bolt's origin against phase, at first contact and where the bolt rests."""
    return get(library_path(library, "histories", roll, pitch, "heights"), HeightsAnswer, unit=unit)


def computed_intervals(
    roll: float,
    pitch: float,
    *,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[ComputedIntervals]:
    """As ``intervals``, of any orientation, computed on request (about a second), of a known thread or of a
    library's pair.
    """
    path = path_of("v1", "histories", roll, pitch, "intervals")
    return get(path, ComputedIntervals, designation=designation, library=library, unit=unit)


def computed_heights(
    roll: float,
    pitch: float,
    *,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[ComputedHeights]:
    """As ``heights``, of any orientation, computed on request (about a second), of a known thread or of a library's
    pair.
    """
    path = path_of("v1", "histories", roll, pitch, "heights")
    return get(path, ComputedHeights, designation=designation, library=library, unit=unit)


def windows(
    *,
    library: LibraryName = LATEST,
    roll: float | None = None,
    pitch: float | None = None,
    least: float | None = None,
    unit: str | None = None,
) -> Call[WindowsAnswer]:
    """Where a bolt turned counter-clockwise goes down and how far, where it snaps, where it can go on down.

    A steepest fall of more than ``least`` thread pitches is a snap's.
    """
    return get(library_path(library, "windows"), WindowsAnswer, roll=roll, pitch=pitch, least=least, unit=unit)


def computed_falls(
    roll: float,
    pitch: float,
    *,
    designation: str | None = None,
    library: LibraryName | None = None,
    tolerance: float | None = None,
    steps: int | None = None,
    span: float | None = None,
    least: float | None = None,
    unit: str | None = None,
) -> Call[ComputedFalls]:
    """Falls and snap of any orientation, computed on request; with a ``tolerance`` of roll and pitch their range within
    it.

    The steepest fall is that within ``span`` degrees of phase; more than ``least`` thread pitches make a snap.
    """
    return get(
        path_of("v1", "histories", roll, pitch, "falls"),
        ComputedFalls,
        designation=designation,
        library=library,
        tolerance=tolerance,
        steps=steps,
        span=span,
        least=least,
        unit=unit,
    )


def transitions(
    *,
    library: LibraryName = LATEST,
    move: str | None = None,
    roll: float | None = None,
    pitch: float | None = None,
    phase_min: float | None = None,
    phase_max: float | None = None,
    source: str | None = None,
    target: str | None = None,
    change: str | None = None,
    state_class: str | None = None,
    mu: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    limit: int = LARGEST_PAGE,
    unit: str | None = None,
) -> PagedCall[TransitionDocument]:
    """From which interval to which; ``source`` and ``target`` are keys of formations. All filters hold at once.

    With ``mu`` each is marked by what a load does where it begins; the load is that of ``statics``.

    Raises:
        InvalidValueError: a load that is not valid, or one without ``mu``.
    """
    filters = {
        "move": move,
        "roll": roll,
        "pitch": pitch,
        "phase_min": phase_min,
        "phase_max": phase_max,
        "from": source,
        "to": target,
        "change": change,
        "class": state_class,
    }
    first = get(
        library_path(library, "transitions"),
        TransitionsPage,
        **filters,
        **under_load_query(mu, force, moment, point),
        limit=limit,
        unit=unit,
    )
    return PagedCall(first, TransitionDocument)


def network(*, library: LibraryName = LATEST) -> Call[NetworkSummary]:
    """The size of the constraint network, and its connectivity."""
    return get(library_path(library, "network"), NetworkSummary, format="summary")


def loaded_network(
    *,
    mu: float = DEFAULT_FRICTION,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    avoid: Iterable[str] | None = None,
    library: LibraryName = LATEST,
    unit: str | None = None,
) -> Call[LoadedNetworkSummary]:
    """How much of all phases is free, held or wedged under a load, and the dead ends.

    These are dead where no move leaves what is marked as one of ``avoid``. The load is that of ``statics``; it is
    solved at all orientations when it is first asked for, which takes a while.

    Raises:
        InvalidValueError: a load that is not valid.
    """
    query = load_query(mu, force, moment, point)
    path = library_path(library, "network", "loaded")
    return get(path, LoadedNetworkSummary, **query, avoid=joined(avoid), unit=unit)


def network_node_link(*, library: LibraryName = LATEST) -> Call[NodeLinkNetwork]:
    """The whole network, as networkx reads it."""
    return get(library_path(library, "network"), NodeLinkNetwork, format="node-link")


def network_graphml(*, library: LibraryName = LATEST) -> Call[bytes]:
    """The whole network as GraphML."""
    return get_content(library_path(library, "network"), GRAPHML, format="graphml")


def network_dot(*, library: LibraryName = LATEST) -> Call[bytes]:
    """The whole network in the language of Graphviz."""
    return get_content(library_path(library, "network"), DOT, format="dot")


def formations(*, library: LibraryName = LATEST) -> Call[FormationsAnswer]:
    """A summary of every formation: class, share, where it occurs, how far it is to the window."""
    return get(library_path(library, "network", "formations"), FormationsAnswer)


def formation(key: str, *, library: LibraryName = LATEST, unit: str | None = None) -> Call[NodeAnswer]:
    """Where the formation with that key occurs, what can follow it, and how far it is to the window."""
    return get(library_path(library, "network", "formations", key), NodeAnswer, unit=unit)


def path(
    source: str,
    *,
    library: LibraryName = LATEST,
    objective: str | None = None,
    moves: Iterable[str] | None = None,
    roll: float | None = None,
    pitch: float | None = None,
    phase: float | None = None,
    mu: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    avoid: Iterable[str] | None = None,
    unit: str | None = None,
) -> Call[PathAnswer]:
    """The best path to the window from the formation with the key ``source``, by the ``moves`` allowed.

    From any orientation, or from one ``roll`` and ``pitch``, and ``phase``. With ``mu`` no move leaves what a load
    marks as one of ``avoid``; the load is that of ``statics``.

    Raises:
        InvalidValueError: a load that is not valid, or one without ``mu``.
    """
    query: dict[str, QueryValue] = {
        "from": source,
        "objective": objective,
        "moves": joined(moves),
        "avoid": joined(avoid),
    }
    query |= under_load_query(mu, force, moment, point)
    return get(
        library_path(library, "network", "paths"), PathAnswer, **query, roll=roll, pitch=pitch, phase=phase, unit=unit
    )


def locate(
    *,
    library: LibraryName = LATEST,
    state_class: str | None = None,
    contacts: int | None = None,
    flag: str | None = None,
    contact: Iterable[str] | None = None,
    ordered: bool = False,
    verdict: str | None = None,
    mu: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    point: Sequence[float] | None = None,
    unit: str | None = None,
) -> Call[LocationAnswer]:
    """The orientations and phases that are consistent with the observed labels of a state.

    Each ``contact`` is written ``stage:bolt_region:nut_region:features``, with ``*`` for what was not observed; with
    ``ordered`` these are the first contacts in their order. ``contacts`` is how many there are. ``verdict`` is what the
    bolt was seen to do under a load, with ``mu``; the load is that of ``statics``, its lengths in ``unit``.

    Raises:
        InvalidValueError: a load that is not valid, or one without ``mu``.
    """
    query: dict[str, QueryValue] = {"class": state_class, "contact": joined(contact), "verdict": verdict}
    query |= under_load_query(mu, force, moment, point)
    return get(
        library_path(library, "network", "locate"),
        LocationAnswer,
        **query,
        contacts=contacts,
        flag=flag,
        ordered=ordered,
        unit=unit,
    )
