"""Moves and observations as they are written in a query or on a command line."""

from __future__ import annotations

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.network.locate import ContactObservation
from threadstate.network.moves import Move
from threadstate.state.model import FeaturePair
from threadstate.thread.regions import Region


def named_moves(text: str) -> frozenset[Move]:
    """Moves by their names, separated by commas.

    Raises:
        UnknownNameError: no such move.
    """
    names = text.split(",")
    for name in names:
        if name not in tuple(Move):
            raise UnknownNameError("moves", name, ", ".join(Move))
    return frozenset(Move(name) for name in names)


def contact_observations(text: str) -> tuple[ContactObservation, ...]:
    """What was observed of contacts, separated by commas, each as :func:`contact_observation`; nothing of none.

    Raises:
        InvalidValueError: a contact cannot be read.
        UnknownNameError: a region or a pair of features that does not exist.
    """
    return tuple(contact_observation(one) for one in text.split(",")) if text else ()


def contact_observation(text: str) -> ContactObservation:
    """What was observed of a contact, written as ``stage:bolt_region:nut_region:features``.

    Raises:
        InvalidValueError: it cannot be read.
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
