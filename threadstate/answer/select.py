"""Which transitions are asked for."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.answer.library_network import LibraryNetwork
from threadstate.errors import InvalidValueError
from threadstate.network import transitions as kept
from threadstate.network.changes import ChangeKind
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.state.model import StateClass


@dataclass(frozen=True)
class TransitionFilter:
    """Conditions that all hold for a transition; None stands for any. Angles in degrees, of where it begins.

    Raises:
        InvalidValueError: ``phase_min_deg`` is above ``phase_max_deg``.
    """

    move: Move | None = None
    roll_deg: float | None = None
    pitch_deg: float | None = None
    phase_min_deg: float | None = None
    phase_max_deg: float | None = None
    source_key: str | None = None
    target_key: str | None = None
    change: ChangeKind | None = None
    state_class: StateClass | None = None

    def __post_init__(self) -> None:
        low, high = self.phase_min_deg, self.phase_max_deg
        if low is not None and high is not None and low > high:
            raise InvalidValueError("phase_min", low, f"at most phase_max, {high!r}")


def selected(network: LibraryNetwork, which: TransitionFilter) -> tuple[Transition, ...]:
    """The transitions of a library that a filter keeps, in order.

    Raises:
        NotFoundError: a key is none of the network's.
    """
    found = network.transitions
    if which.source_key is not None:
        found = kept.from_formation(found, network.network.node(which.source_key).formation)
    if which.target_key is not None:
        found = kept.to_formation(found, network.network.node(which.target_key).formation)
    if which.move is not None:
        found = kept.with_move(found, which.move)
    if which.state_class is not None:
        found = tuple(one for one in found if one.source.formation.state_class is which.state_class)
    if which.roll_deg is not None or which.pitch_deg is not None:
        found = tuple(one for one in found if _holds_chunks_of(network, one, which))
    if which.phase_min_deg is not None or which.phase_max_deg is not None:
        high = 360.0 if which.phase_max_deg is None else which.phase_max_deg
        found = kept.within_phases(found, which.phase_min_deg or 0.0, high)
    if which.change is not None:
        found = kept.with_change(found, which.change)
    return found


def _holds_chunks_of(network: LibraryNetwork, one: Transition, which: TransitionFilter) -> bool:
    roll, pitch = network.cell_map.tilt_deg(one.source.orientation)
    return which.roll_deg in (None, roll) and which.pitch_deg in (None, pitch)
