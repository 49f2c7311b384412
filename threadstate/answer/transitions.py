"""Transitions as documents: those along phase from what is stored, those by tilting solved when they are asked for."""

from __future__ import annotations

from collections.abc import Sequence

from threadstate.answer.changes import change_documents
from threadstate.answer.documents import ContactChangeDocument, PlaceDocument, Sides, TransitionDocument
from threadstate.answer.lengths import sides
from threadstate.answer.tilts import TiltChange, TiltChanges
from threadstate.archive.stored import StoredHistories
from threadstate.network.cells import Cell
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition


def transition_documents(
    found: Sequence[Transition], histories: StoredHistories, tilts: TiltChanges, factor: float
) -> list[TransitionDocument]:
    """The documents of transitions, lengths multiplied by ``factor``."""
    tilted = iter(tilts.of([one for one in found if not one.move.turns]))
    return [
        _turn(one, histories, factor) if one.move.turns else _tilt(one, histories, next(tilted), factor)
        for one in found
    ]


def _turn(one: Transition, histories: StoredHistories, factor: float) -> TransitionDocument:
    """A turn meets the boundary at which the later of its two cells begins."""
    forwards = one.move is Move.COUNTER_CLOCKWISE
    later = one.target if forwards else one.source
    boundary = histories.orientations[later.orientation].boundaries[later.position]
    first = sides(boundary.first_height_before, boundary.first_height_after, factor)
    last = sides(boundary.last_height_before, boundary.last_height_after, factor)
    return _document(
        one,
        histories,
        first if forwards else (first[1], first[0]),
        last if forwards else (last[1], last[0]),
        change_documents([change if forwards else change.reverse for change in boundary.changes], factor),
    )


def _tilt(one: Transition, histories: StoredHistories, change: TiltChange, factor: float) -> TransitionDocument:
    return _document(
        one,
        histories,
        sides(*change.first_height, factor),
        sides(*change.last_height, factor),
        change_documents(change.changes, factor),
    )


def _document(
    one: Transition, histories: StoredHistories, first: Sides, last: Sides, changes: list[ContactChangeDocument]
) -> TransitionDocument:
    return TransitionDocument(
        move=one.move,
        phase=one.start_deg,
        phase_end=one.end_deg,
        cover=one.cover_deg,
        source=_place(one.source, histories),
        target=_place(one.target, histories),
        first_height=first,
        last_height=last,
        changes=changes,
        text=one.difference.text,
    )


def _place(cell: Cell, histories: StoredHistories) -> PlaceDocument:
    roll, pitch = histories.tilt_deg(cell.orientation)
    return PlaceDocument(roll=roll, pitch=pitch, formation=cell.formation.key, state_class=cell.formation.state_class)
