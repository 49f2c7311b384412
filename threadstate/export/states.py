"""The columns of exported states and of undecided poses."""

from __future__ import annotations

from collections.abc import Callable

from threadstate.export.column import Cell, Column, Unit, degrees, integer, length, number, words
from threadstate.state.document import ContactDocument
from threadstate.state.model import UndecidedPose
from threadstate.state.quantities import QUANTITIES
from threadstate.statics.stored import MEANINGS, LibraryStateDocument
from threadstate.statics.stored import NAMES as STATICS

STAGES = (1, 2, 3)
LEAST_CONTACTS = 3
"""So many contacts have columns of their own, also where no state has as many."""

_AXES = "xyz"
_TURNS = ("lambda", "mu")
_MARGIN = "margin_"


def state_columns(contacts: int) -> tuple[Column[LibraryStateDocument], ...]:
    """The columns of states of which none has more than so many contacts."""
    return (
        degrees("roll", "roll of the pose", lambda state: state["roll"]),
        degrees("pitch", "pitch of the pose", lambda state: state["pitch"]),
        degrees("phase", "phase of the pose", lambda state: state["phase"]),
        words("class", "class of the state", lambda state: str(state["class"])),
        words("flags", "its flags, separated by spaces", lambda state: " ".join(state["flags"])),
        *(
            (length if quantity.is_length else degrees)(quantity.name, quantity.meaning, _quantity(quantity.name))
            for quantity in QUANTITIES
        ),
        *(number(name, MEANINGS[name], _statics(name)) for name in STATICS),
        *(column for stage in STAGES for column in _pose_columns(stage)),
        integer("contacts", "how many contacts there are", lambda state: len(state["contacts"])),
        *(column for place in range(contacts) for column in _contact_columns(place)),
    )


def _quantity(name: str) -> Callable[[LibraryStateDocument], Cell]:
    if name in _TURNS:
        place = _TURNS.index(name)
        return lambda state: state["turns"][place]
    if name.startswith(_MARGIN):
        margin = name.removeprefix(_MARGIN)
        return lambda state: state["margins"][margin]  # type: ignore[literal-required]
    return lambda state: state[name]  # type: ignore[literal-required]


def _statics(name: str) -> Callable[[LibraryStateDocument], Cell]:
    return lambda state: None if state["statics"] is None else state["statics"][name]  # type: ignore[literal-required]


def _pose_columns(stage: int) -> list[Column[LibraryStateDocument]]:
    def rotation(i: int, j: int) -> Callable[[LibraryStateDocument], Cell]:
        return lambda state: state["poses"][stage - 1]["rotation"][i][j] if len(state["poses"]) >= stage else None

    def translation(i: int) -> Callable[[LibraryStateDocument], Cell]:
        return lambda state: state["poses"][stage - 1]["translation"][i] if len(state["poses"]) >= stage else None

    return [
        *(
            number(f"pose_{stage}_r{i + 1}{j + 1}", f"rotation, bolt to nut, at stage {stage}", rotation(i, j))
            for i in range(3)
            for j in range(3)
        ),
        *(
            length(f"pose_{stage}_t{axis}", f"translation, bolt to nut, at stage {stage}", translation(i))
            for i, axis in enumerate(_AXES)
        ),
    ]


def _contact_columns(place: int) -> list[Column[LibraryStateDocument]]:
    def of(cell: Callable[[ContactDocument], Cell]) -> Callable[[LibraryStateDocument], Cell]:
        return lambda state: cell(state["contacts"][place]) if len(state["contacts"]) > place else None

    def vector(name: str, unit: Unit, meaning: str) -> list[Column[LibraryStateDocument]]:
        make = length if unit is Unit.LENGTH else number
        return [make(f"{head}_{name}_{axis}", meaning, of(_component(name, i))) for i, axis in enumerate(_AXES)]

    head = f"contact_{place + 1}"
    return [
        integer(f"{head}_stage", "stage at which the contact is made", of(lambda contact: contact["stage"])),
        *vector("point", Unit.LENGTH, "where it is, in the nut's frame"),
        *vector("point_bolt", Unit.LENGTH, "where it is, in the bolt's frame"),
        *vector("normal", Unit.NONE, "of length 1, in the nut's frame, from the nut into the bolt"),
        words(f"{head}_bolt_region", "region of the bolt", of(lambda contact: str(contact["bolt_region"]))),
        words(f"{head}_nut_region", "region of the nut", of(lambda contact: str(contact["nut_region"]))),
        words(f"{head}_features", "what touches, the bolt's first", of(lambda contact: str(contact["features"]))),
        length(f"{head}_bolt_margin", "to the boundary of the bolt's region", of(lambda one: one["bolt_margin"])),
        length(f"{head}_nut_margin", "to the boundary of the nut's region", of(lambda one: one["nut_margin"])),
    ]


def _component(name: str, i: int) -> Callable[[ContactDocument], Cell]:
    match name:
        case "point":
            return lambda contact: contact["point"][i]
        case "point_bolt":
            return lambda contact: contact["point_bolt"][i]
        case _:
            return lambda contact: contact["normal"][i]


UNDECIDED_COLUMNS: tuple[Column[UndecidedPose], ...] = (
    degrees("roll", "roll of the pose", lambda pose: pose.roll_deg),
    degrees("pitch", "pitch of the pose", lambda pose: pose.pitch_deg),
    degrees("phase", "phase of the pose", lambda pose: pose.phase_deg),
    words("reason", "why the library's solver method could not decide the pose", lambda pose: pose.reason),
)
