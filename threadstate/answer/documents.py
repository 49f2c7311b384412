"""The shapes of answers about histories, transitions, clearance windows and the constraint network.

Angles in degrees; lengths in the unit that the answer, or whoever asked, names. An interval, window or stretch that
holds phase 0 ends above 360.
"""

from __future__ import annotations

from pydantic import AliasChoices, BaseModel, ConfigDict, Field

from threadstate.network.changes import ChangeKind
from threadstate.network.moves import Move
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import Region

Vector = tuple[float, float, float]
Sides = tuple[float | None, float | None]

_CLASS = AliasChoices("class", "state_class")
"""``class`` is a Python keyword."""


class _Document(BaseModel):
    model_config = ConfigDict(frozen=True)


class LabelsDocument(_Document):
    """What touches what at one contact."""

    stage: int
    bolt_region: Region
    nut_region: Region
    features: FeaturePair


class FormationDocument(_Document):
    """A contact formation: a class and contacts by their labels, in order."""

    key: str = Field(description="the same in every library")
    state_class: StateClass | None = Field(
        serialization_alias="class", validation_alias=_CLASS, description="null where the solver does not decide"
    )
    contacts: list[LabelsDocument]
    text: str = Field(description="the formation in words")


class IntervalDocument(_Document):
    """Phases over which every label is constant."""

    start: float
    end: float
    formation: FormationDocument
    flags: list[Flag]
    margin: float | None = Field(description="smallest distance from other labels, half way")
    first_height: float | None = Field(description="of the bolt's origin at first contact, half way")
    last_height: float | None = Field(description="of the bolt's origin in the last pose, half way")
    in_window: bool


class SideDocument(LabelsDocument):
    """A contact on one side of a change."""

    normal: Vector = Field(description="in the nut's frame, from the nut into the bolt")


class ContactChangeDocument(_Document):
    """How one contact changes."""

    stage: int
    place: int = Field(description="which of its stage, from 0")
    kinds: list[ChangeKind] = Field(description="empty where it jumps elsewhere with the same labels")
    before: SideDocument | None
    after: SideDocument | None
    moved: float | None = Field(description="how far the contact jumps; null where it is on one side alone")


class BoundaryDocument(_Document):
    """Where an interval begins, as phase grows."""

    phase: float
    low: float = Field(description="the change lies between this phase, which was solved, and `high`")
    high: float
    before: str = Field(description="key of the formation before")
    after: str = Field(description="key of the formation after")
    first_height: Sides = Field(description="before and after; null where undecided")
    last_height: Sides
    flags_between: list[Flag] = Field(description="flags that hold at the boundary alone, as that of a tie")
    changes: list[ContactChangeDocument]


class SnapDocument(_Document):
    """A fall of the height of first contact at a single phase, turning counter-clockwise."""

    phase: float
    phase_uncertainty: float = Field(description="half of the bracket in which the phase is certain to lie")
    height_before: float
    height_after: float
    height_uncertainty: float | None = Field(
        description="by how much either height may be wrong, an estimate; null in libraries of older versions"
    )
    fall: float


class CourseDocument(_Document):
    """A stretch of a window over which the first contact has the same features and its height does not jump."""

    features: FeaturePair
    start: float
    end: float
    start_height: float
    end_height: float
    rate: float = Field(description="mean rate of the height, as a multiple of thread_pitch / 360 per degree")


class WindowDocument(_Document):
    """A clearance window, met when the bolt is turned counter-clockwise."""

    roll: float
    pitch: float
    enter: float
    leave: float
    width: float
    drop: float = Field(description="from the height at the entry to the lowest")
    climb: float = Field(description="from the lowest height to that at the exit")
    enter_height: float
    leave_height: float
    lowest_phase: float
    lowest_height: float
    snap: SnapDocument | None = Field(description="the largest fall at one phase; null where the height never jumps")
    courses: list[CourseDocument]


class OrientationHistoryDocument(_Document):
    """The history of an orientation: `boundaries[i]` is where `intervals[i]` begins."""

    roll: float
    pitch: float
    intervals: list[IntervalDocument]
    boundaries: list[BoundaryDocument]
    windows: list[WindowDocument]


class HeightsDocument(_Document):
    """The height of the bolt's origin against phase: arrays of one length, null where the solver does not decide."""

    roll: float
    pitch: float
    tolerance: float = Field(description="how far a straight line between two neighbours is off, at most")
    phases: list[float] = Field(description="ascending from 0 to 360; a jump is between two that all but coincide")
    first_heights: list[float | None] = Field(description="at first contact")
    last_heights: list[float | None] = Field(description="in the last pose")


class PlaceDocument(_Document):
    """One end of a transition."""

    roll: float
    pitch: float
    formation: str = Field(description="its key")
    state_class: StateClass | None = Field(serialization_alias="class", validation_alias=_CLASS)


class TransitionDocument(_Document):
    """A move from one interval to another."""

    move: Move
    phase: float = Field(description="where a turn meets the boundary, or the stretch of a tilt begins")
    phase_end: float = Field(description="the same for a turn; the end of the stretch for a tilt")
    cover: float = Field(description="phase over which the target is the next formation to come")
    source: PlaceDocument
    target: PlaceDocument
    first_height: Sides = Field(description="before and after: at the boundary, or half way through the stretch")
    last_height: Sides
    changes: list[ContactChangeDocument]
    text: str = Field(description="what changes, in words; empty where no label does")


class FollowingDocument(_Document):
    """A formation that comes next under a move."""

    move: Move
    formation: str = Field(description="its key")
    state_class: StateClass | None = Field(serialization_alias="class", validation_alias=_CLASS)
    change: str = Field(description="how it differs from the formation before, in words")
    cover: float
    share: float = Field(description="of the phase that the formation before covers")


class ReachDocument(_Document):
    """How far the bolt is turned counter-clockwise, its tilt held, until the window."""

    occurrences: int = Field(description="intervals of the formation outside the window")
    reaching: int = Field(description="those at whose orientation there is a window")
    least: float | None
    most: float | None


class OccurrenceDocument(_Document):
    """An interval of a formation."""

    roll: float
    pitch: float
    start: float
    end: float
    margin: float | None
    in_window: bool


class NodeDocument(_Document):
    """A formation in the network."""

    formation: FormationDocument
    cover: float = Field(description="phase over all orientations")
    share: float
    window_share: float
    orientations: int
    to_window: ReachDocument
    following: list[FollowingDocument]
    occurrences: list[OccurrenceDocument]


class FormationSummaryDocument(_Document):
    """A formation of the network in few words."""

    key: str
    state_class: StateClass | None = Field(serialization_alias="class", validation_alias=_CLASS)
    text: str = Field(description="its class and contacts in words")
    contacts: int = Field(description="how many contacts it has")
    share: float = Field(description="of the phase of all orientations")
    window_share: float = Field(description="of its own phase that is in a clearance window")
    orientations: int = Field(description="at how many it occurs")
    to_window: ReachDocument


class StepDocument(_Document):
    """A step of a path: the interval that is entered, how, where and after how much turning."""

    move: Move | None
    roll: float
    pitch: float
    phase: float
    turning: float
    formation: str
    state_class: StateClass | None = Field(serialization_alias="class", validation_alias=_CLASS)
    text: str
    margin: float | None
    in_window: bool


class PathDocument(_Document):
    """The best path from a formation to the window."""

    objective: str
    turning: float
    transitions: int
    worst_margin: float
    steps: list[StepDocument]


class StretchDocument(_Document):
    """Phases of an orientation that remain, all of one formation."""

    roll: float
    pitch: float
    start: float
    end: float
    formation: str = Field(description="its key")


class LocatedFormationDocument(_Document):
    """A formation that remains."""

    key: str
    state_class: StateClass | None = Field(serialization_alias="class", validation_alias=_CLASS)
    text: str = Field(description="its class and contacts in words")
    share: float = Field(description="where it remains, of all phases of all orientations")


class LocationDocument(_Document):
    """Where a state with all that was observed can be."""

    share: float = Field(description="of all phases of all orientations")
    undecided_share: float = Field(description="where the solver decides no state, so that nothing excludes it")
    orientations: int
    formations: list[LocatedFormationDocument] = Field(description="the most frequent first")
    stretches: list[StretchDocument]


class NetworkSummaryDocument(_Document):
    """The size of a network, and what holds it together."""

    formations: int
    edges: int
    intervals: int
    orientations: int
    windows: int
    strong_parts: list[int] = Field(description="sizes of the strongly connected parts, the largest first")
    dead_ends: list[str] = Field(description="keys of formations from which turning counter-clockwise meets no window")
    cut_formations: list[str] = Field(description="keys of formations without which the network falls apart")
    telling_formations: list[str] = Field(description="keys of formations that occur at one orientation alone")
