"""Libraries, published or still being computed, and their orientations."""

from __future__ import annotations

from datetime import datetime

from threadstate.client.models.answer import Answer
from threadstate.library.solver_method import SolverMethod
from threadstate.state.model import Flag, StateClass
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit


class GridDocument(Answer):
    """The grid of a library's poses: roll and pitch +-``tilt_max``, phase 0 up to but without 360."""

    tilt_max: float
    tilt_step: float
    phase_step: float
    orientations: int


class LibraryDocument(Answer):
    """A published library: its inputs and its counts; lengths of the ``pair`` in ``unit``.

    ``source`` is on what the pair's dimensions rest; None of a pair of one's own.
    """

    id: int
    designation: str
    slug: str
    source: str | None
    unit: LengthUnit
    stored_unit: LengthUnit
    pair: Pair
    grid: GridDocument
    method: SolverMethod
    options: dict[str, float | str]
    state_count: int
    undecided_count: int
    code_version: str
    input_sha256: str
    content_sha256: str
    created_at: datetime
    published_at: datetime


class CountsDocument(Answer):
    """Number of states of each class and with each flag."""

    classes: dict[StateClass, int]
    flags: dict[Flag, int]


class LibraryDetail(LibraryDocument):
    """A published library with the counts of its states."""

    counts: CountsDocument


class LibraryList(Answer):
    """All published libraries, the latest first."""

    libraries: tuple[LibraryDocument, ...]


class BuildingDocument(Answer):
    """A library that is not published yet, and the number of its computed orientations."""

    designation: str
    method: SolverMethod
    orientations: int
    done: int
    created_at: datetime


class BuildingList(Answer):
    """All of these, the latest first."""

    building: tuple[BuildingDocument, ...]


class OrientationDocument(Answer):
    """An orientation over all phases of the grid; a length is None where none of its states has it."""

    roll: float
    pitch: float
    counts: dict[StateClass, int]
    drop_most: float | None
    embedment_most: float | None
    pivot_offset_least: float | None
    margin_least: float | None
    mu_hold_least: float | None
    mu_wedge_least: float | None
    support_margin_most: float | None


class SpreadDocument(Answer):
    """A number of the orientations that have one."""

    least: float
    median: float
    most: float


class HeldShareDocument(Answer):
    """What share of all states holds a push at a coefficient of friction."""

    mu: float
    share: float


class ComparedOrientationDocument(Answer):
    """An orientation of a library; windows in degrees of phase, lengths in thread pitches."""

    roll: float
    pitch: float
    window: float
    widest: float
    fall: float
    snaps: bool
    embedment_most: float | None
    mu_hold_least: float | None
    mu_wedge_least: float | None


class ComparedLibraryDocument(Answer):
    """A library beside others; windows in degrees of phase, lengths in thread pitches."""

    library: int
    designation: str
    source: str | None
    unit: LengthUnit
    thread_pitch: float
    axial_play: float
    states: int
    undecided: int
    classes: dict[StateClass, float]
    windows: int
    snaps: int
    window: SpreadDocument
    widest: SpreadDocument
    fall: SpreadDocument
    embedment_most: SpreadDocument | None
    mu_hold_least: SpreadDocument | None
    mu_wedge_least: SpreadDocument | None
    held: tuple[HeldShareDocument, ...]
    orientations: tuple[ComparedOrientationDocument, ...]


class ComparisonDocument(Answer):
    """Libraries side by side, in the order in which they were named."""

    libraries: tuple[ComparedLibraryDocument, ...]


class OrientationsAnswer(Answer):
    """All orientations of a library, in the order of roll and pitch."""

    library: int
    unit: LengthUnit
    orientations: tuple[OrientationDocument, ...]
