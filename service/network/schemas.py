"""The response models of a library's histories and network."""

from __future__ import annotations

from pydantic import BaseModel, Field

from service.libraries.requested import AnswerOfPair
from threadstate.responses.documents import (
    FallsDocument,
    FallsRangeDocument,
    FormationSummaryDocument,
    HeightsDocument,
    HeldDocument,
    LoadedSummaryDocument,
    LocationDocument,
    NetworkSummaryDocument,
    NodeDocument,
    OrientationHistoryDocument,
    OrientationWindowsDocument,
    PathDocument,
    TransitionDocument,
)
from threadstate.units import LengthUnit


class _OfLibrary(BaseModel):
    library: int = Field(description="number of the library")
    unit: LengthUnit = Field(description="unit of all lengths in this response")


class IntervalsAnswer(_OfLibrary):
    """The intervals of an orientation's phase circle, the boundaries between them, and its clearance windows."""

    history: OrientationHistoryDocument


class ComputedIntervals(AnswerOfPair):
    """The same of any orientation, computed on request."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    history: OrientationHistoryDocument


class HeightsAnswer(_OfLibrary):
    """The height of the bolt's origin against phase."""

    heights: HeightsDocument


class ComputedHeights(AnswerOfPair):
    """The same of any orientation, computed on request."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    heights: HeightsDocument


class ComputedFalls(AnswerOfPair):
    """The falls of any orientation, and their range where a tolerance was given."""

    unit: LengthUnit = Field(description="unit of all lengths in this response")
    falls: FallsDocument
    range: FallsRangeDocument | None


class HeldAnswer(BaseModel):
    """What a load does along the phase of an orientation, at each friction."""

    library: int = Field(description="number of the library")
    held: list[HeldDocument]


class ComputedHeld(AnswerOfPair):
    """The same of any orientation, computed on request."""

    held: list[HeldDocument]


class TransitionsPage(_OfLibrary):
    """Transitions in order: by orientation of the source, turns before tilts, each by phase."""

    count: int = Field(description="how many there are under the filters")
    transitions: list[TransitionDocument]
    next: str | None = Field(description="address of the next page; null on the last")


class WindowsAnswer(_OfLibrary):
    """Falls and clearance windows by orientation."""

    orientations: list[OrientationWindowsDocument]


class NetworkSummary(BaseModel):
    """The size of a library's network."""

    library: int = Field(description="number of the library")
    network: NetworkSummaryDocument


class LoadedNetworkSummary(BaseModel):
    """What a load does in a library's network."""

    library: int = Field(description="number of the library")
    network: LoadedSummaryDocument


class NodeLinkNetwork(BaseModel):
    """A whole network as networkx writes it: formations are nodes with their key as `id`, edges have the move."""

    directed: bool
    multigraph: bool
    graph: dict[str, str]
    nodes: list[dict[str, float | str]]
    edges: list[dict[str, float | str]]


class FormationsAnswer(BaseModel):
    """All formations of a network."""

    library: int = Field(description="number of the library")
    formations: list[FormationSummaryDocument]


class NodeAnswer(_OfLibrary):
    """A formation in the network."""

    node: NodeDocument


class PathAnswer(_OfLibrary):
    """The best path, or null where the moves allowed lead to no window."""

    path: PathDocument | None


class LocationAnswer(BaseModel):
    """Where a state that matches the observation can be."""

    library: int = Field(description="number of the library")
    location: LocationDocument
