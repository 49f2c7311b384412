"""Response models of histories, transitions, clearance windows and the constraint network.

Angles in degrees; lengths in the unit that the response, or the caller, names. An interval, window or stretch that
holds phase 0 ends above 360.
"""

from __future__ import annotations

from pydantic import AliasChoices, BaseModel, ConfigDict, Field

from threadstate.network.changes import ChangeKind
from threadstate.network.loaded import Mark
from threadstate.network.moves import Move
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.statics.verdict import Verdict
from threadstate.thread.regions import Region

Vector = tuple[float, float, float]
Sides = tuple[float | None, float | None]
Range = tuple[float, float]

_CLASS = AliasChoices("class", "state_class")
"""``class`` is a Python keyword."""
_FROM, _TO = AliasChoices("from", "start"), AliasChoices("to", "end")
"""So is ``from``."""


class _Document(BaseModel):
    model_config = ConfigDict(frozen=True)


class LabelsDocument(_Document):
    """The labels of a contact."""

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
    last_height: float | None = Field(description="of the bolt's origin in the last pose, at rest or not, half way")
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


class JumpDocument(_Document):
    """A fall of the height of first contact at a single phase, turning counter-clockwise."""

    phase: float
    phase_uncertainty: float = Field(description="half of the bracket in which the phase is certain to lie")
    height_before: float
    height_after: float
    height_uncertainty: float = Field(description="by how much either height may be wrong, an estimate")
    fall: float


class DescentDocument(_Document):
    """A longest stretch of phase over which the height of first contact does not rise, turning counter-clockwise.

    It begins and ends where the bolt goes down: level stretches at its ends are left out.
    """

    start: float = Field(serialization_alias="from", validation_alias=_FROM)
    end: float = Field(serialization_alias="to", validation_alias=_TO, description="above 360 where it holds phase 0")
    fall: float = Field(description="height at `from` less height at `to`")
    from_height: float
    to_height: float
    fall_uncertainty: float = Field(description="by how much the fall may be wrong, an estimate")
    undecided: float = Field(description="how much of its phase the solver does not decide")
    jumps: list[JumpDocument]


class SnapDocument(_Document):
    """The descent that holds the steepest fall, where that is large enough to be felt as a snap."""

    start: float = Field(serialization_alias="from", validation_alias=_FROM)
    end: float = Field(serialization_alias="to", validation_alias=_TO, description="above 360 where it holds phase 0")
    fall: float = Field(description="the whole fall, of all the descent")
    steepest: float = Field(description="the largest fall within 3 deg of phase")
    steepest_from: float = Field(description="where those 3 deg begin")
    jump: float = Field(description="the largest part of the fall that happens at one phase; 0 where nothing jumps")
    jump_at: float | None


class FallsDocument(_Document):
    """Where the bolt of one orientation, turned counter-clockwise, goes down (method, section 8)."""

    roll: float
    pitch: float
    steepest: float = Field(description="the largest fall within 3 deg of phase; 0 where it never goes down")
    steepest_from: float | None = Field(description="where those 3 deg begin")
    snap: SnapDocument | None = Field(
        description="the descent that holds the steepest fall; null where that is at most 5 % of the thread pitch"
    )
    descents: list[DescentDocument]


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
    climb: float = Field(description="from the lowest height to that at the exit")
    enter_height: float
    leave_height: float
    lowest_phase: float
    lowest_height: float
    courses: list[CourseDocument]


class OrientationWindowsDocument(FallsDocument):
    """The falls of an orientation and its clearance windows."""

    windows: list[WindowDocument]


class FallsRangeDocument(_Document):
    """The range, least and most, of what the tilts within a tolerance give; null where none of them snaps.

    It is that of the tilts that were computed: between them falls may lie beyond it.
    """

    roll: float
    pitch: float
    tolerance: float = Field(description="of roll and of pitch, either way, in degrees")
    tilts: int = Field(description="how many tilts were computed, evenly spaced, the corners among them")
    snaps: int = Field(description="how many of them snap")
    steepest: Range = Field(description="the largest fall within 3 deg of phase, of all tilts")
    fall: Range | None = Field(description="the snap's whole fall")
    snap_from: Range | None = Field(description="where the snap begins; phases of one turn, that may leave 0 to 360")
    snap_to: Range | None = Field(description="where it ends, likewise")
    jump: Range | None = Field(description="the largest part of the snap that happens at one phase")


class OrientationHistoryDocument(OrientationWindowsDocument):
    """The history of an orientation: `boundaries[i]` is where `intervals[i]` begins."""

    intervals: list[IntervalDocument]
    boundaries: list[BoundaryDocument]


class HeightsDocument(_Document):
    """The height of the bolt's origin against phase: arrays of one length, null where the solver does not decide."""

    roll: float
    pitch: float
    tolerance: float = Field(description="how far a straight line between two neighbours is off, at most")
    phases: list[float] = Field(description="ascending from 0 to 360; a jump is between two that all but coincide")
    first_heights: list[float | None] = Field(description="at first contact")
    rest_heights: list[float | None] = Field(description="where the bolt rests; null where it does not")


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
    mark: Mark | None = Field(default=None, description="what a load does where it begins; null without a load")


class VerdictStretchDocument(_Document):
    """Phases of an orientation at which a load does the same."""

    start: float
    end: float = Field(description="above 360 where phase 0 lies between")
    verdict: Verdict
    start_uncertainty: float = Field(description="width of what encloses the start; 0 where an interval begins there")


class HeldDocument(_Document):
    """What a load does along the phase of an orientation, at a coefficient of friction."""

    roll: float
    pitch: float
    mu: float
    stretches: list[VerdictStretchDocument]


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
    """Where a state that matches the observation can be."""

    share: float = Field(description="of all phases of all orientations")
    undecided_share: float = Field(description="where the solver decides no state, so that nothing excludes it")
    orientations: int
    formations: list[LocatedFormationDocument] = Field(description="the most frequent first")
    stretches: list[StretchDocument]


class LoadedSummaryDocument(_Document):
    """What a load does in a network, at a coefficient of friction."""

    mu: float
    shares: dict[Mark, float] = Field(description="of all phases of all orientations, by mark")
    dead_ends: list[str] = Field(
        description="keys of formations from which turning counter-clockwise meets no window, none that is to be "
        "avoided being left"
    )


class NetworkSummaryDocument(_Document):
    """The size of a network, and its connectivity."""

    formations: int
    edges: int
    intervals: int
    orientations: int
    windows: int
    strong_parts: list[int] = Field(description="sizes of the strongly connected parts, the largest first")
    dead_ends: list[str] = Field(description="keys of formations from which turning counter-clockwise meets no window")
    cut_formations: list[str] = Field(description="keys of formations without which the network falls apart")
    telling_formations: list[str] = Field(description="keys of formations that occur at one orientation alone")
