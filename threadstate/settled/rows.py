"""Settled states as rows of the tables, and back; their content hash."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass
from typing import Any

from threadstate.device.model import Fall, LoadedContact, Outcome, SettledFlag, SettledMargins, SettledState
from threadstate.library.grid import Orientation
from threadstate.state.model import FeaturePair, StagePose, Vector

Row = tuple[Any, ...]
"""One row in the order of its table's columns, without the leading ``library_id``."""


@dataclass(frozen=True, slots=True)
class SettledRows:
    """All rows of one orientation, ready to be written."""

    orientation: Orientation
    states: tuple[Row, ...]
    contacts: tuple[Row, ...]
    falls: tuple[Row, ...]
    flags: tuple[Row, ...]

    @property
    def content_sha256(self) -> str:
        """SHA-256, in hexadecimal, of all rows as JSON, in which every number is its shortest decimal.

        Raises:
            ValueError: a number is not finite.
        """
        rows = (self.states, self.contacts, self.falls, self.flags)
        return hashlib.sha256(json.dumps(rows, separators=(",", ":"), allow_nan=False).encode()).hexdigest()


def settled_rows(orientation: Orientation, first_ordinal: int, states: Sequence[SettledState]) -> SettledRows:
    """The rows of the settled states of an orientation's poses, which are given in order. Their paths are left out."""
    state_rows: list[Row] = []
    contact_rows: list[Row] = []
    fall_rows: list[Row] = []
    flag_rows: list[Row] = []
    for ordinal, state in enumerate(states, first_ordinal):
        pose = (state.roll_deg + 0.0, state.pitch_deg + 0.0, state.phase_deg + 0.0)
        counts = (len(state.contacts), len(state.falls))
        state_rows.append((ordinal, *pose, state.outcome.value, *counts, *_place(state), *_cells(*_margins(state))))
        for position, contact in enumerate(state.contacts):
            places = (*_cells(*contact.point), *_cells(*contact.normal))
            contact_rows.append((ordinal, position, *places, contact.features.value, *_cells(*contact.force)))
        for position, fall in enumerate(state.falls):
            fall_rows.append((ordinal, position, *_cells(*astuple(fall))))
        flag_rows += [(ordinal, position, flag.value) for position, flag in enumerate(state.flags)]
    return SettledRows(orientation, tuple(state_rows), tuple(contact_rows), tuple(fall_rows), tuple(flag_rows))


def states_from_rows(
    states: Iterable[Row], contacts: Iterable[Row], falls: Iterable[Row], flags: Iterable[Row]
) -> list[SettledState]:
    """Settled states, without paths, from their rows, each in the order of its table's primary key.

    The order of the result is that of ``states``.
    """
    contacts_of: dict[int, list[LoadedContact]] = {}
    for ordinal, _, *values in contacts:
        point, normal, force = _vector(values[0:3]), _vector(values[3:6]), _vector(values[7:10])
        contacts_of.setdefault(ordinal, []).append(LoadedContact(point, normal, FeaturePair(values[6]), force))
    falls_of: dict[int, list[Fall]] = {}
    for ordinal, _, *values in falls:
        falls_of.setdefault(ordinal, []).append(Fall(*values))
    flags_of: dict[int, list[SettledFlag]] = {}
    for ordinal, _, flag in flags:
        flags_of.setdefault(ordinal, []).append(SettledFlag(flag))
    return [
        _state(
            row,
            tuple(flags_of.get(row[0], ())),
            tuple(contacts_of.get(row[0], ())),
            tuple(falls_of.get(row[0], ())),
        )
        for row in states
    ]


def _state(
    row: Row, flags: tuple[SettledFlag, ...], contacts: tuple[LoadedContact, ...], falls: tuple[Fall, ...]
) -> SettledState:
    _, roll_deg, pitch_deg, phase_deg, outcome, _, _, *values = row
    rotation, translation, shift, turned = values[0:9], values[9:12], values[12:15], values[15:18]
    rests = values[0] is not None
    return SettledState(
        roll_deg,
        pitch_deg,
        phase_deg,
        Outcome(outcome),
        flags,
        StagePose((_vector(rotation[0:3]), _vector(rotation[3:6]), _vector(rotation[6:9])), _vector(translation))
        if rests
        else None,
        _vector(shift) if rests else None,
        _vector(turned) if rests else None,
        contacts,
        values[18],
        falls,
        SettledMargins(*values[19:]),
        (),
    )


def _place(state: SettledState) -> tuple[float | None, ...]:
    """Where the bolt rests: its pose, the shift, the rotation vector and the elastic energy; all None where it does
    not.
    """
    if state.pose is None or state.shift is None or state.rotation_deg is None:
        return (None,) * 19
    first, second, third = state.pose.rotation
    pose = (*first, *second, *third, *state.pose.translation)
    return _cells(*pose, *state.shift, *state.rotation_deg, state.elastic_energy)


def _margins(state: SettledState) -> tuple[float | None, ...]:
    margins = state.margins
    return margins.force, margins.gap, margins.stability, margins.residual, margins.pressure


def _cells(*values: float | None) -> tuple[float | None, ...]:
    return tuple(None if value is None else value + 0.0 for value in values)


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z
