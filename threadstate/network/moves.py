"""Moves: the ways in which a bolt's pose is changed."""

from __future__ import annotations

from collections.abc import Collection
from enum import StrEnum

from threadstate.errors import InvalidValueError


class Move(StrEnum):
    """Turning the bolt, or tilting it to a neighbouring orientation at the same phase."""

    COUNTER_CLOCKWISE = "ccw"
    """Phase grows (method, section 2)."""
    CLOCKWISE = "cw"
    """Phase falls."""
    ROLL_UP = "roll+"
    ROLL_DOWN = "roll-"
    PITCH_UP = "pitch+"
    PITCH_DOWN = "pitch-"

    @property
    def turns(self) -> bool:
        """Whether the move changes phase, and not the orientation."""
        return self in (Move.COUNTER_CLOCKWISE, Move.CLOCKWISE)

    @property
    def reverse(self) -> Move:
        """The move that undoes this one."""
        return _REVERSE[self]


_REVERSE = {
    Move.COUNTER_CLOCKWISE: Move.CLOCKWISE,
    Move.CLOCKWISE: Move.COUNTER_CLOCKWISE,
    Move.ROLL_UP: Move.ROLL_DOWN,
    Move.ROLL_DOWN: Move.ROLL_UP,
    Move.PITCH_UP: Move.PITCH_DOWN,
    Move.PITCH_DOWN: Move.PITCH_UP,
}

ALL_MOVES = frozenset(Move)
TILTS = frozenset(move for move in Move if not move.turns)
SNAP_SEARCH = frozenset({Move.COUNTER_CLOCKWISE})
"""The heuristic of the paper (section 7): the bolt is turned counter-clockwise until it snaps, its tilt is held."""


def in_order(moves: Collection[Move]) -> tuple[Move, ...]:
    """The moves, each once, in the order in which :class:`Move` names them.

    Raises:
        InvalidValueError: no moves.
    """
    if not moves:
        raise InvalidValueError("moves", (), f"at least one of {', '.join(Move)}")
    return tuple(move for move in Move if move in moves)
