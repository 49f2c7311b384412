"""Transitions as documents: those along phase from what is stored, those by tilting solved when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from threadstate.answer.changes import change_documents, changes_between
from threadstate.answer.documents import ContactChangeDocument, PlaceDocument, Sides, TransitionDocument
from threadstate.answer.lengths import sides
from threadstate.archive.stored import StoredHistories
from threadstate.errors import UnresolvedPoseError
from threadstate.network.cells import Cell
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_poses
from threadstate.thread.pair import Pair

SOLVED_DEG = 1e-3
"""Over a shorter stretch of phase a tilt is between two events, where a pose may take seconds: it is not solved."""

PoseDeg = tuple[float, float, float]


def transition_documents(
    found: Sequence[Transition], histories: StoredHistories, pair: Pair, factor: float
) -> list[TransitionDocument]:
    """The documents of transitions, lengths multiplied by ``factor``.

    Heights and normals of a tilt are those half way through its stretch, absent where that is shorter than
    ``SOLVED_DEG`` or a state is undecided.
    """
    tilts = [one for one in found if not one.move.turns]
    solved = _solved(pair, [pose for one in tilts for pose in _middles(one, histories)])
    return [_turn(one, histories, factor) if one.move.turns else _tilt(one, histories, solved, factor) for one in found]


def _middles(one: Transition, histories: StoredHistories) -> tuple[PoseDeg, ...]:
    """The poses on both sides of a tilt, half way through its stretch; none where that is too short."""
    if one.end_deg - one.start_deg < SOLVED_DEG:
        return ()
    phase = 0.5 * (one.start_deg + one.end_deg) % 360.0
    before, after = (histories.tilt_deg(cell.orientation) for cell in (one.source, one.target))
    return (*before, phase), (*after, phase)


def _solved(pair: Pair, poses: list[PoseDeg]) -> Iterator[ContactState | None]:
    """The states of poses in order; None where undecided."""
    try:
        return iter(solve_poses(pair, poses))
    except UnresolvedPoseError:
        return (_state(pair, pose) for pose in poses)


def _state(pair: Pair, pose: PoseDeg) -> ContactState | None:
    try:
        return solve_poses(pair, [pose])[0]
    except UnresolvedPoseError:
        return None


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
        change_documents(boundary.changes, factor, reverse=not forwards),
    )


def _tilt(
    one: Transition, histories: StoredHistories, solved: Iterator[ContactState | None], factor: float
) -> TransitionDocument:
    before, after = (next(solved), next(solved)) if _middles(one, histories) else (None, None)
    return _document(
        one,
        histories,
        sides(_height(before, 0), _height(after, 0), factor),
        sides(_height(before, -1), _height(after, -1), factor),
        [] if before is None or after is None else changes_between(before, after, factor),
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


def _height(state: ContactState | None, stage: int) -> float | None:
    return None if state is None else state.poses[stage].translation[2]
