"""Libraries side by side, in numbers that compare between threads of any size."""

from __future__ import annotations

from collections.abc import Iterable
from statistics import median

from pydantic import BaseModel, ConfigDict, Field

from threadstate.library.figures import LibraryFigures, OrientationFigures
from threadstate.library.identity import pair_of
from threadstate.state.model import StateClass
from threadstate.thread.catalogue import source_of
from threadstate.thread.play import axial_play
from threadstate.thread.standards.document import SourceDocument
from threadstate.units import LengthUnit


class _Document(BaseModel):
    model_config = ConfigDict(frozen=True)


class SpreadDocument(_Document):
    """A number of the orientations that have one."""

    least: float
    median: float
    most: float


class HeldShareDocument(_Document):
    """How many states hold a push at a coefficient of friction."""

    mu: float
    share: float = Field(description="of all states")


class ComparedOrientationDocument(_Document):
    """An orientation of a library; lengths in thread pitches."""

    roll: float
    pitch: float
    window: float = Field(description="phase that its clearance windows cover, in degrees; 0 without any")
    widest: float = Field(description="phase that the widest window covers")
    fall: float = Field(description="steepest fall")
    snaps: bool = Field(description="whether the steepest fall is that of a snap")
    embedment_most: float | None = Field(description="greatest embedment; null where no state has one")
    mu_hold_least: float | None = Field(description="least friction that holds a push at any phase")
    mu_wedge_least: float | None = Field(description="least friction at which contacts wedge at any phase")


class ComparedLibraryDocument(_Document):
    """A library beside others; lengths in thread pitches, windows in degrees of phase."""

    library: int
    designation: str
    source: SourceDocument
    unit: LengthUnit = Field(description="unit of the thread pitch")
    thread_pitch: float
    axial_play: float = Field(description="how far a bolt in phase can shift along the axis, either way")
    states: int
    undecided: int = Field(description="poses of the grid that the solver method could not decide")
    classes: dict[StateClass, float] = Field(description="share of the states of each class")
    windows: int = Field(description="orientations that have a clearance window")
    snaps: int = Field(description="orientations that snap")
    window: SpreadDocument = Field(description="phase that an orientation's windows cover; 0 without any")
    widest: SpreadDocument = Field(description="phase that its widest window covers; 0 without any")
    fall: SpreadDocument = Field(description="its steepest fall")
    embedment_most: SpreadDocument | None = Field(description="its greatest embedment; null where no state has one")
    mu_hold_least: SpreadDocument | None = Field(description="the least friction that holds a push at any phase")
    mu_wedge_least: SpreadDocument | None = Field(description="the least friction at which contacts wedge")
    held: list[HeldShareDocument]
    orientations: list[ComparedOrientationDocument]


class ComparisonDocument(_Document):
    """Libraries side by side, in the order in which they were named."""

    libraries: list[ComparedLibraryDocument]


def compared_library(figures: LibraryFigures) -> ComparedLibraryDocument:
    """The figures of a library as a document."""
    library, of_each = figures.library, figures.orientations
    pair = pair_of(library.pair)
    states = library.state_count
    return ComparedLibraryDocument(
        library=library.id,
        designation=library.designation,
        source=source_of(pair),
        unit=pair.unit,
        thread_pitch=pair.thread_pitch,
        axial_play=axial_play(pair) / pair.thread_pitch,
        states=states,
        undecided=library.undecided_count,
        classes={name: count / states for name, count in figures.of_class} if states else {},
        windows=sum(one.window_deg > 0.0 for one in of_each),
        snaps=sum(one.snaps for one in of_each),
        window=_spread_of_all(one.window_deg for one in of_each),
        widest=_spread_of_all(one.widest_deg for one in of_each),
        fall=_spread_of_all(one.fall for one in of_each),
        embedment_most=_spread(one.embedment for one in of_each),
        mu_hold_least=_spread(one.mu_hold for one in of_each),
        mu_wedge_least=_spread(one.mu_wedge for one in of_each),
        held=[HeldShareDocument(mu=mu, share=count / states) for mu, count in figures.held] if states else [],
        orientations=[_orientation(one) for one in of_each],
    )


def _orientation(one: OrientationFigures) -> ComparedOrientationDocument:
    return ComparedOrientationDocument(
        roll=one.roll_deg,
        pitch=one.pitch_deg,
        window=one.window_deg,
        widest=one.widest_deg,
        fall=one.fall,
        snaps=one.snaps,
        embedment_most=one.embedment,
        mu_hold_least=one.mu_hold,
        mu_wedge_least=one.mu_wedge,
    )


def _spread_of_all(values: Iterable[float]) -> SpreadDocument:
    found = sorted(values)
    return SpreadDocument(least=found[0], median=median(found), most=found[-1])


def _spread(values: Iterable[float | None]) -> SpreadDocument | None:
    found = [value for value in values if value is not None]
    return _spread_of_all(found) if found else None
