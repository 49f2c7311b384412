"""Histories and the constraint network; what these answers hold is described by ``threadstate.responses.documents``."""

from __future__ import annotations

from threadstate.client.models.answer import Answer
from threadstate.responses.documents import (
    FallsDocument,
    FallsRangeDocument,
    FormationSummaryDocument,
    HeightsDocument,
    LoadedSummaryDocument,
    LocationDocument,
    NetworkSummaryDocument,
    NodeDocument,
    OrientationHistoryDocument,
    OrientationWindowsDocument,
    PathDocument,
    TransitionDocument,
    WindowDocument,
)
from threadstate.units import LengthUnit


class IntervalsAnswer(Answer):
    """The intervals of an orientation's phase circle, the boundaries between them, and its clearance windows."""

    library: int
    unit: LengthUnit
    history: OrientationHistoryDocument


class ComputedIntervals(Answer):
    """The same of any orientation, computed on request."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    history: OrientationHistoryDocument


class HeightsAnswer(Answer):
    """The height of the bolt's origin against phase."""

    library: int
    unit: LengthUnit
    heights: HeightsDocument


class ComputedHeights(Answer):
    """The same of any orientation, computed on request."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    heights: HeightsDocument


class ComputedFalls(Answer):
    """The falls of any orientation, computed on request; their range where a tolerance was given."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    falls: FallsDocument
    range: FallsRangeDocument | None


class TransitionsPage(Answer):
    """One page of transitions; ``count`` is how many there are on all pages."""

    library: int
    unit: LengthUnit
    count: int
    transitions: tuple[TransitionDocument, ...]
    next: str | None

    @property
    def items(self) -> tuple[TransitionDocument, ...]:
        """The transitions."""
        return self.transitions


class WindowsAnswer(Answer):
    """Falls and clearance windows by orientation."""

    library: int
    unit: LengthUnit
    orientations: tuple[OrientationWindowsDocument, ...]

    @property
    def windows(self) -> tuple[WindowDocument, ...]:
        """The clearance windows of all orientations."""
        return tuple(window for one in self.orientations for window in one.windows)


class NetworkSummary(Answer):
    """The size of a library's network, and its connectivity."""

    library: int
    network: NetworkSummaryDocument


class LoadedNetworkSummary(Answer):
    """What a load does in a library's network."""

    library: int
    network: LoadedSummaryDocument


class NodeLinkNetwork(Answer):
    """A whole network as networkx reads it (``networkx.node_link_graph(found.model_dump(), edges="edges")``)."""

    directed: bool
    multigraph: bool
    graph: dict[str, str]
    nodes: tuple[dict[str, float | str], ...]
    edges: tuple[dict[str, float | str], ...]


class FormationsAnswer(Answer):
    """Summaries of all formations of a network, ordered by key."""

    library: int
    formations: tuple[FormationSummaryDocument, ...]


class NodeAnswer(Answer):
    """A formation in the network."""

    library: int
    unit: LengthUnit
    node: NodeDocument


class PathAnswer(Answer):
    """The best path; None where the moves allowed lead to no window."""

    library: int
    unit: LengthUnit
    path: PathDocument | None


class LocationAnswer(Answer):
    """Where a state that matches the observation can be."""

    library: int
    location: LocationDocument
