"""The columns of data frames; those of states are the columns of an export."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

from threadstate.client.models.jobs import JobDocument
from threadstate.client.models.libraries import OrientationDocument
from threadstate.client.models.settled import Settled
from threadstate.client.models.states import State, UndecidedDocument
from threadstate.client.models.success import SummarisedOrientation
from threadstate.errors import InvalidValueError
from threadstate.export.column import Cell, Column, degrees, integer, length, number, truth, words
from threadstate.export.states import LEAST_CONTACTS, state_columns
from threadstate.responses.documents import (
    IntervalDocument,
    OrientationWindowsDocument,
    SnapDocument,
    StretchDocument,
    TransitionDocument,
    WindowDocument,
)
from threadstate.state.model import StateClass

Columns = tuple[Column[Any], ...]


def columns_and_sources(kind: type[object], items: Sequence[object]) -> tuple[Columns, Sequence[object]]:
    """The columns of items of that kind, and what their cells are made from, item by item.

    Raises:
        InvalidValueError: there are no columns for such items.
    """
    if issubclass(kind, State):
        documents = [{"statics": None} | item.model_dump(by_alias=True) for item in items if isinstance(item, State)]
        most = max((len(document["contacts"]) for document in documents), default=0)
        return state_columns(max(LEAST_CONTACTS, most)), documents
    if kind not in COLUMNS:
        raise InvalidValueError(
            "items", kind.__name__, ", ".join(["State", *(one.__name__ for one in COLUMNS)]) + "; at least one"
        )
    return COLUMNS[kind], items


def _snap(cell: Callable[[SnapDocument], Cell]) -> Callable[[OrientationWindowsDocument], Cell]:
    return lambda one: None if one.snap is None else cell(one.snap)


_UNDECIDED: tuple[Column[UndecidedDocument], ...] = (
    degrees("roll", "roll of the pose", lambda pose: pose.roll),
    degrees("pitch", "pitch of the pose", lambda pose: pose.pitch),
    degrees("phase", "phase of the pose", lambda pose: pose.phase),
    words("reason", "why the library's solver method could not decide the pose", lambda pose: pose.reason),
)

_AXES = ("x", "y", "z")


def _margin(name: str) -> Callable[[Settled], Cell]:
    return lambda one: getattr(one.margins, name)


def _origin(axis: int) -> Callable[[Settled], Cell]:
    return lambda one: None if one.pose is None else one.pose.translation[axis]


def _shift(axis: int) -> Callable[[Settled], Cell]:
    return lambda one: None if one.deviation is None else one.deviation.shift[axis]


def _rotation(axis: int) -> Callable[[Settled], Cell]:
    return lambda one: None if one.deviation is None else one.deviation.rotation[axis]


_SETTLED: tuple[Column[Settled], ...] = (
    degrees("roll", "roll that the device commands", lambda one: one.roll),
    degrees("pitch", "pitch that it commands", lambda one: one.pitch),
    degrees("phase", "phase that it commands", lambda one: one.phase),
    words("outcome", "how the push ended", lambda one: one.outcome.value),
    words("flags", "flags, separated by spaces", lambda one: " ".join(one.flags)),
    integer("contacts", "how many contacts carry a force", lambda one: len(one.contacts)),
    integer("falls", "how many falls there were on the way", lambda one: len(one.falls)),
    *(length(f"origin_{axis}", "where the bolt's origin rests", _origin(i)) for i, axis in enumerate(_AXES)),
    *(length(f"shift_{axis}", "shift of the compliance centre", _shift(i)) for i, axis in enumerate(_AXES)),
    *(degrees(f"rotation_{axis}", "rotation vector of the deviation", _rotation(i)) for i, axis in enumerate(_AXES)),
    number("elastic_energy", "elastic energy, N times the unit of lengths", lambda one: one.elastic_energy),
    number("force_margin", "least contact force over the push", _margin("force")),
    length("gap_margin", "least gap of a place that does not touch", _margin("gap")),
    number("stability_margin", "least curvature of the potential, N over the unit of lengths", _margin("stability")),
    number("residual_margin", "wrench that is not balanced, over the push", _margin("residual")),
    length("pressure_margin", "how far the centre of pressure lies inside its hull", _margin("pressure")),
)


def _count(state_class: StateClass) -> Callable[[OrientationDocument], Cell]:
    return lambda one: one.counts[state_class]


_ORIENTATIONS: tuple[Column[OrientationDocument], ...] = (
    degrees("roll", "roll of the orientation", lambda one: one.roll),
    degrees("pitch", "pitch of the orientation", lambda one: one.pitch),
    *(integer(name.value, "how many of its states have this class", _count(name)) for name in StateClass),
    length("drop_most", "greatest drop", lambda one: one.drop_most),
    length("embedment_most", "greatest embedment", lambda one: one.embedment_most),
    length("pivot_offset_least", "least pivot offset", lambda one: one.pivot_offset_least),
    length("margin_least", "least distance of a class's number from its threshold", lambda one: one.margin_least),
    number("mu_hold_least", "least friction that holds a push at any phase", lambda one: one.mu_hold_least),
    number("mu_wedge_least", "least friction at which contacts wedge at any phase", lambda one: one.mu_wedge_least),
    number("support_margin_most", "greatest support margin under a push", lambda one: one.support_margin_most),
)

_WINDOWS: tuple[Column[WindowDocument], ...] = (
    degrees("roll", "roll of the orientation", lambda one: one.roll),
    degrees("pitch", "pitch of the orientation", lambda one: one.pitch),
    degrees("enter", "phase at which the bolt enters", lambda one: one.enter),
    degrees("leave", "phase at which it leaves; above 360 past phase 0", lambda one: one.leave),
    degrees("width", "from the one to the other", lambda one: one.width),
    length("climb", "from the lowest height to that at the exit", lambda one: one.climb),
    length("enter_height", "height at the entry", lambda one: one.enter_height),
    length("leave_height", "height at the exit", lambda one: one.leave_height),
    degrees("lowest_phase", "phase at which it is lowest", lambda one: one.lowest_phase),
    length("lowest_height", "height there", lambda one: one.lowest_height),
)

_FALLS: tuple[Column[OrientationWindowsDocument], ...] = (
    degrees("roll", "roll of the orientation", lambda one: one.roll),
    degrees("pitch", "pitch of the orientation", lambda one: one.pitch),
    length("steepest", "largest fall within 3 deg of phase", lambda one: one.steepest),
    degrees("steepest_from", "where these begin; missing where it never goes down", lambda one: one.steepest_from),
    degrees("snap_from", "phase at which the snap begins; missing where there is none", _snap(lambda snap: snap.start)),
    degrees("snap_to", "phase at which it ends; above 360 past phase 0", _snap(lambda snap: snap.end)),
    length("snap_fall", "its whole fall", _snap(lambda snap: snap.fall)),
    length("snap_jump", "largest part of it that happens at one phase", _snap(lambda snap: snap.jump)),
    degrees("snap_jump_at", "that phase; missing where nothing jumps", _snap(lambda snap: snap.jump_at)),
    integer("descents", "how many descents there are", lambda one: len(one.descents)),
    integer("windows", "how many clearance windows there are", lambda one: len(one.windows)),
)

_INTERVALS: tuple[Column[IntervalDocument], ...] = (
    degrees("start", "phase at which the interval begins", lambda one: one.start),
    degrees("end", "phase at which it ends; above 360 where it holds phase 0", lambda one: one.end),
    truth("in_window", "whether it belongs to a clearance window", lambda one: one.in_window),
    words("class", "class of its states; missing where undecided", lambda one: one.formation.state_class),
    words("flags", "flags of its states, separated by spaces", lambda one: " ".join(one.flags)),
    words("formation", "key of its contact formation", lambda one: one.formation.key),
    words("formation_text", "the formation in words", lambda one: one.formation.text),
    length("margin", "smallest distance from other labels, half way", lambda one: one.margin),
    length("first_height", "height at first contact, half way", lambda one: one.first_height),
    length("last_height", "height in the last pose, at rest or not, half way", lambda one: one.last_height),
)

_STRETCHES: tuple[Column[StretchDocument], ...] = (
    degrees("roll", "roll of the orientation", lambda one: one.roll),
    degrees("pitch", "pitch of the orientation", lambda one: one.pitch),
    degrees("start", "phase at which the stretch begins", lambda one: one.start),
    degrees("end", "phase at which it ends; above 360 where it holds phase 0", lambda one: one.end),
    words("formation", "key of its contact formation", lambda one: one.formation),
)

_TRANSITIONS: tuple[Column[TransitionDocument], ...] = (
    words("move", "the move", lambda one: one.move.value),
    degrees("phase", "where a turn meets the boundary, or the stretch of a tilt begins", lambda one: one.phase),
    degrees("phase_end", "the same for a turn; the end of the stretch for a tilt", lambda one: one.phase_end),
    degrees("cover", "phase over which the target is what comes next", lambda one: one.cover),
    degrees("source_roll", "roll before", lambda one: one.source.roll),
    degrees("source_pitch", "pitch before", lambda one: one.source.pitch),
    words("source", "key of the formation before", lambda one: one.source.formation),
    words("source_class", "class before; missing where undecided", lambda one: one.source.state_class),
    degrees("target_roll", "roll after", lambda one: one.target.roll),
    degrees("target_pitch", "pitch after", lambda one: one.target.pitch),
    words("target", "key of the formation after", lambda one: one.target.formation),
    words("target_class", "class after; missing where undecided", lambda one: one.target.state_class),
    length("first_height_before", "height at first contact before", lambda one: one.first_height[0]),
    length("first_height_after", "height at first contact after", lambda one: one.first_height[1]),
    length("last_height_before", "height in the last pose before, at rest or not", lambda one: one.last_height[0]),
    length("last_height_after", "height in the last pose after, at rest or not", lambda one: one.last_height[1]),
    words("text", "what changes, in words", lambda one: one.text),
)


def _least_share(one: SummarisedOrientation) -> float:
    return min(summary.share for summary in one.summary)


def _undecided_phases(one: SummarisedOrientation) -> int:
    return sum(summary.undecided for summary in one.summary)


_ORIENTATIONS_OF_MAPS: tuple[Column[SummarisedOrientation], ...] = (
    degrees("roll", "roll of the orientation", lambda one: one.roll),
    degrees("pitch", "pitch of the orientation", lambda one: one.pitch),
    number("critical_last", "friction up to which every phase engages", lambda one: one.critical.last),
    number("critical_first", "friction at which one does not", lambda one: one.critical.first),
    degrees("critical_phase", "starting phase that ends it", lambda one: one.critical.phase),
    words(
        "critical_outcome",
        "how the path from there ends",
        lambda one: None if one.critical.outcome is None else one.critical.outcome.value,
    ),
    number("least_share", "least share of the phases that engages, over the frictions", _least_share),
    integer("undecided", "phases without a certain outcome, over all frictions", _undecided_phases),
    integer("cells", "how many paths were computed", lambda one: len(one.cells)),
    integer("boundaries", "how many boundaries of outcome there are", lambda one: len(one.boundaries)),
)

_JOBS: tuple[Column[JobDocument], ...] = (
    integer("id", "number of the job", lambda one: one.id),
    words("kind", "what it computes", lambda one: one.kind.value),
    words("state", "how far it is", lambda one: one.state.value),
    words("reason", "why it failed", lambda one: one.reason),
    words("designation", "the thread", lambda one: one.designation),
    words("method", "how contact states are found", lambda one: None if one.method is None else one.method.value),
    degrees("tilt_max", "largest roll and pitch", lambda one: one.grid.tilt_max),
    degrees("tilt_step", "step of roll and pitch", lambda one: one.grid.tilt_step),
    degrees("phase_step", "step of phase", lambda one: one.grid.phase_step),
    integer("chunks", "how many orientations there are", lambda one: one.chunks),
    integer("committed", "how many of them are computed", lambda one: one.committed),
    number("share", "the part that is computed, 0 to 1", lambda one: one.committed / one.chunks),
    integer("library", "number of the library of contact states, once published", lambda one: one.library),
    words("result", "address of what is published", lambda one: one.result),
)

COLUMNS: Mapping[type[object], Columns] = MappingProxyType(
    {
        Settled: _SETTLED,
        UndecidedDocument: _UNDECIDED,
        OrientationDocument: _ORIENTATIONS,
        WindowDocument: _WINDOWS,
        OrientationWindowsDocument: _FALLS,
        IntervalDocument: _INTERVALS,
        StretchDocument: _STRETCHES,
        TransitionDocument: _TRANSITIONS,
        SummarisedOrientation: _ORIENTATIONS_OF_MAPS,
        JobDocument: _JOBS,
    }
)
"""The columns of all items except states, whose number of contacts varies."""
