"""Transitions as response models: those along phase from the stored histories, those by tilting solved on demand
and cached.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.errors import UnresolvedPoseError
from threadstate.history.differences import contact_changes
from threadstate.network.cells import Cell
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.responses.documents import ContactChangeDocument, PlaceDocument, Sides, TransitionDocument
from threadstate.responses.formations import change_documents
from threadstate.responses.loaded_network import LoadedNetwork
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.stored_histories.model import StoredContactChange, StoredHistories, stored_changes
from threadstate.thread.pair import Pair
from threadstate.units import scale_pair


def transition_documents(
    found: Sequence[Transition],
    histories: StoredHistories,
    tilts: TiltChanges,
    factor: float,
    loaded: LoadedNetwork | None = None,
) -> list[TransitionDocument]:
    """The documents of transitions, lengths multiplied by ``factor``; with ``loaded`` each has its mark."""
    tilted = iter(tilts.of([one for one in found if not one.move.turns]))
    documents = [
        _turn(one, histories, factor) if one.move.turns else _tilt(one, histories, next(tilted), factor)
        for one in found
    ]
    if loaded is None:
        return documents
    return [
        document.model_copy(update={"mark": loaded.mark(one)}) for document, one in zip(documents, found, strict=True)
    ]


def _turn(one: Transition, histories: StoredHistories, factor: float) -> TransitionDocument:
    """A turn meets the boundary at which the later of its two cells begins."""
    forwards = one.move is Move.COUNTER_CLOCKWISE
    later = one.target if forwards else one.source
    boundary = histories.orientations[later.orientation].boundaries[later.position]
    first = scale_pair(boundary.first_height_before, boundary.first_height_after, factor)
    last = scale_pair(boundary.last_height_before, boundary.last_height_after, factor)
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
        scale_pair(*change.first_height, factor),
        scale_pair(*change.last_height, factor),
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


SOLVED_DEG = 1e-3
"""Over a shorter stretch of phase a tilt is between two events, where a pose may take seconds: it is not solved."""

PoseDeg = tuple[float, float, float]
Heights = tuple[float | None, float | None]


@dataclass(frozen=True, slots=True)
class TiltChange:
    """Heights of the bolt's origin before and after, at first contact and in its last pose, and the changed contacts.

    Lengths are in the pair's unit; a height is None where the state is undecided or was not solved.
    """

    first_height: Heights = (None, None)
    last_height: Heights = (None, None)
    changes: tuple[StoredContactChange, ...] = ()

    @property
    def reverse(self) -> TiltChange:
        """The change by the reverse tilt."""
        return TiltChange(
            self.first_height[::-1], self.last_height[::-1], tuple(change.reverse for change in self.changes)
        )


NOT_SOLVED = TiltChange()
UPWARDS = (Move.ROLL_UP, Move.PITCH_UP)


class TiltChanges:
    """The changes by the tilts of a library, each at the middle of the range of phase over which it is possible;
    cached.
    """

    def __init__(self, histories: StoredHistories, pair: Pair, options: SolveOptions) -> None:
        self._histories = histories
        self._pair = pair
        self._options = options
        self._known: dict[tuple[PoseDeg, PoseDeg], TiltChange] = {}

    def of(self, tilts: Sequence[Transition]) -> list[TiltChange]:
        """The change by each tilt; ``NOT_SOLVED`` where the range of phase is shorter than ``SOLVED_DEG``."""
        sides = [self._sides(one) for one in tilts]
        unknown = [poses for poses in dict.fromkeys(sides) if poses is not None and poses not in self._known]
        if unknown:
            states = iter(_solved(self._pair, self._options, [pose for poses in unknown for pose in poses]))
            self._known.update((poses, _change(next(states), next(states))) for poses in unknown)
        return [self._change_of(one, poses) for one, poses in zip(tilts, sides, strict=True)]

    def _sides(self, one: Transition) -> tuple[PoseDeg, PoseDeg] | None:
        """The poses on both sides, that of the smaller roll or pitch first; None where the stretch is too short."""
        if one.end_deg - one.start_deg < SOLVED_DEG:
            return None
        phase = 0.5 * (one.start_deg + one.end_deg) % 360.0
        cells = (one.source, one.target) if one.move in UPWARDS else (one.target, one.source)
        low, high = (self._histories.tilt_deg(cell.orientation) for cell in cells)
        return (*low, phase), (*high, phase)

    def _change_of(self, one: Transition, poses: tuple[PoseDeg, PoseDeg] | None) -> TiltChange:
        if poses is None:
            return NOT_SOLVED
        upwards = self._known[poses]
        return upwards if one.move in UPWARDS else upwards.reverse


def _change(before: ContactState | None, after: ContactState | None) -> TiltChange:
    return TiltChange(
        (_height(before, 0), _height(after, 0)),
        (_height(before, -1), _height(after, -1)),
        stored_changes(contact_changes(before, after), before, after),
    )


def _height(state: ContactState | None, stage: int) -> float | None:
    return None if state is None else state.poses[stage].translation[2]


def _solved(pair: Pair, options: SolveOptions, poses: list[PoseDeg]) -> list[ContactState | None]:
    """The states of poses in order; None where undecided."""
    try:
        return list(solve_poses(pair, poses, options))
    except UnresolvedPoseError:
        return [_state(pair, options, pose) for pose in poses]


def _state(pair: Pair, options: SolveOptions, pose: PoseDeg) -> ContactState | None:
    try:
        return solve_poses(pair, [pose], options)[0]
    except UnresolvedPoseError:
        return None
