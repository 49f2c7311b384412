"""Moves, observations, filters of transitions, frictions and diagrams, as a query or a command line writes them."""

from __future__ import annotations

from dataclasses import dataclass

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.network import transitions as filters
from threadstate.network.changes import ChangeKind
from threadstate.network.loaded import Mark, mark_of
from threadstate.network.locate import ContactObservation
from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.numbers import integer, number
from threadstate.responses.library_network import LibraryNetwork
from threadstate.state.model import FeaturePair, StateClass
from threadstate.statics.load import checked_friction
from threadstate.statics.verdict import Verdict
from threadstate.thread.regions import Region


def parse_moves(text: str) -> frozenset[Move]:
    """Moves by their names, separated by commas.

    Raises:
        UnknownNameError: a name is not that of a move.
    """
    names = text.split(",")
    for name in names:
        if name not in tuple(Move):
            raise UnknownNameError("moves", name, ", ".join(Move))
    return frozenset(Move(name) for name in names)


def parse_marks(text: str) -> frozenset[Verdict]:
    """The verdicts of marks by their names, separated by commas; none for an empty text.

    Raises:
        UnknownNameError: a name is not that of a mark.
    """
    names = text.split(",") if text else []
    for name in names:
        if name not in tuple(Mark):
            raise UnknownNameError("avoid", name, ", ".join(Mark))
    return frozenset(verdict for verdict in Verdict if mark_of(verdict) in names)


def parse_axes(text: str) -> tuple[str, ...]:
    """Names of the axes of a jamming diagram, separated by commas; :func:`jamming_diagram` checks them."""
    return tuple(name.strip() for name in text.split(","))


def parse_contacts(name: str, text: str) -> tuple[int, ...]:
    """Numbers of contacts, separated by commas.

    Raises:
        InvalidValueError: one is no whole number; ``name`` is that of the parameter.
    """
    try:
        return tuple(integer(part.strip()) for part in text.split(","))
    except ValueError:
        raise InvalidValueError(name, text, "whole numbers, separated by commas") from None


def parse_window(name: str, text: str) -> tuple[float, float]:
    """The half widths of a window, separated by a comma.

    Raises:
        InvalidValueError: they are not two numbers; ``name`` is that of the parameter.
    """
    try:
        x, y = (number(part.strip()) for part in text.split(","))
    except ValueError:
        raise InvalidValueError(name, text, "two numbers, separated by a comma") from None
    return x, y


def parse_frictions(text: str) -> tuple[float, ...]:
    """Coefficients of friction, separated by commas.

    Raises:
        InvalidValueError: one is not a number, negative or not finite.
    """
    found = []
    for part in text.split(","):
        try:
            mu = number(part.strip())
        except ValueError:
            raise InvalidValueError("mu", part, "finite numbers >= 0, separated by commas") from None
        checked_friction(mu)
        found.append(mu)
    return tuple(found)


def parse_contact_observations(text: str) -> tuple[ContactObservation, ...]:
    """Observations of contacts, separated by commas, each as of :func:`parse_contact_observation`; () for an empty
    text.

    Raises:
        InvalidValueError: a contact is not valid.
        UnknownNameError: a region or a pair of features that does not exist.
    """
    return tuple(parse_contact_observation(one) for one in text.split(",")) if text else ()


def parse_contact_observation(text: str) -> ContactObservation:
    """The observation of a contact, written as ``stage:bolt_region:nut_region:features``.

    Raises:
        InvalidValueError: the text is not valid.
        UnknownNameError: a region or a pair of features that does not exist.
    """
    parts = [None if part in ("", "*") else part for part in text.split(":")]
    if len(parts) > 4 or (parts[0] is not None and parts[0] not in ("1", "2", "3")):
        raise InvalidValueError(
            "contact", text, "stage (1 to 3), bolt region, nut region, features, separated by colons"
        )
    stage, bolt_region, nut_region, features = (*parts, None, None, None)[:4]
    for name, value, known in (
        ("bolt region", bolt_region, tuple(Region)),
        ("nut region", nut_region, tuple(Region)),
        ("features", features, tuple(FeaturePair)),
    ):
        if value is not None and value not in known:
            raise UnknownNameError(name, value, ", ".join(known))
    return ContactObservation(
        None if stage is None else int(stage),
        None if bolt_region is None else Region(bolt_region),
        None if nut_region is None else Region(nut_region),
        None if features is None else FeaturePair(features),
    )


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


def filter_transitions(network: LibraryNetwork, which: TransitionFilter) -> tuple[Transition, ...]:
    """The transitions of a library that match a filter, in order.

    Raises:
        NotFoundError: the network has no formation with that key.
    """
    found = network.transitions
    if which.source_key is not None:
        found = filters.from_formation(found, network.network.node(which.source_key).formation)
    if which.target_key is not None:
        found = filters.to_formation(found, network.network.node(which.target_key).formation)
    if which.move is not None:
        found = filters.with_move(found, which.move)
    if which.state_class is not None:
        found = tuple(one for one in found if one.source.formation.state_class is which.state_class)
    if which.roll_deg is not None or which.pitch_deg is not None:
        found = tuple(one for one in found if _holds_chunks_of(network, one, which))
    if which.phase_min_deg is not None or which.phase_max_deg is not None:
        high = 360.0 if which.phase_max_deg is None else which.phase_max_deg
        found = filters.within_phases(found, which.phase_min_deg or 0.0, high)
    if which.change is not None:
        found = filters.with_change(found, which.change)
    return found


def _holds_chunks_of(network: LibraryNetwork, one: Transition, which: TransitionFilter) -> bool:
    roll, pitch = network.cell_map.tilt_deg(one.source.orientation)
    return which.roll_deg in (None, roll) and which.pitch_deg in (None, pitch)
