"""Contact states."""

from __future__ import annotations

from pydantic import Field

from threadstate.client.models.answer import Answer, Vector
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.thread.regions import Region
from threadstate.units import LengthUnit


class Pose(Answer):
    """The bolt's pose at a stage, bolt to nut: ``x_nut = rotation x_bolt + translation``, the rotation by rows."""

    rotation: tuple[Vector, Vector, Vector]
    translation: Vector


class Contact(Answer):
    """A contact in the pose of its stage: ``point`` and ``normal`` in the nut's frame, ``point_bolt`` in the bolt's.

    The normal has length 1 and points from the nut into the bolt; a margin is the arc length to the nearest boundary of
    the contact's region.
    """

    stage: int
    point: Vector
    point_bolt: Vector
    normal: Vector
    bolt_region: Region
    nut_region: Region
    features: FeaturePair
    bolt_margin: float
    nut_margin: float


class Margins(Answer):
    """Signed lengths from the thresholds of the class, positive on the stable side; None where not known."""

    drop: float | None
    embedment: float | None
    pivot_offset: float | None


class State(Answer):
    """A contact state: what touches, stage by stage, and whether the bolt can stay there.

    ``poses`` has one for each stage reached; ``turns`` are lambda and mu in degrees, None where that stage was not
    reached, as are ``drop``, ``embedment`` and ``pivot_offset`` where a stage that they need was not.
    """

    roll: float
    pitch: float
    phase: float
    state_class: StateClass = Field(alias="class")
    flags: tuple[Flag, ...]
    poses: tuple[Pose, ...]
    turns: tuple[float | None, float | None]
    drop: float | None
    embedment: float | None
    pivot_offset: float | None
    contacts: tuple[Contact, ...]
    margins: Margins


class StoredStatics(Answer):
    """The statics of a library's state under a push of 1 N along -z through the bolt's origin.

    A friction is None where none is known to do it.
    """

    support_margin: float
    mu_hold: float | None
    mu_wedge: float | None


class LibraryState(State):
    """A contact state of a library with its statics, None where a contact has no certain normal."""

    statics: StoredStatics | None


class StatePage(Answer):
    """One page of states."""

    library: int
    unit: LengthUnit
    states: tuple[LibraryState, ...]
    next: str | None

    @property
    def items(self) -> tuple[LibraryState, ...]:
        """The states."""
        return self.states


class SolveAnswer(Answer):
    """The states of poses that were solved, in the order of the poses."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    states: tuple[State, ...]


class UndecidedPhase(Answer):
    """A phase of an orientation at which the library's solver method could not decide the state, and why."""

    phase: float
    reason: str


class UndecidedDocument(UndecidedPhase):
    """A pose that the library's solver method could not decide, and why."""

    roll: float
    pitch: float


class UndecidedPage(Answer):
    """One page of undecided poses."""

    library: int
    undecided: tuple[UndecidedDocument, ...]
    next: str | None

    @property
    def items(self) -> tuple[UndecidedDocument, ...]:
        """The poses."""
        return self.undecided


class HistoryRows(Answer):
    """The states of an orientation at all phases of the grid, in order, and the phases without a state."""

    library: int
    unit: LengthUnit
    roll: float
    pitch: float
    states: tuple[State, ...]
    undecided: tuple[UndecidedPhase, ...]


class HistoryColumns(Answer):
    """The same as columns of equal length, by the names that the CSV has in its header."""

    library: int
    unit: LengthUnit
    roll: float
    pitch: float
    columns: dict[str, tuple[float | str | None, ...]]
    undecided: tuple[UndecidedPhase, ...]
