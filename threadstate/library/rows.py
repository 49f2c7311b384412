"""States and histories as rows of the tables; states from rows."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from types import MappingProxyType
from typing import Any

import zstandard

from threadstate.library.fingerprint import answers_sha256, chunk_sha256
from threadstate.library.grid import Orientation
from threadstate.state.json import state_json
from threadstate.state.model import (
    Answer,
    Contact,
    ContactState,
    FeaturePair,
    Flag,
    StagePose,
    StateClass,
    UndecidedPose,
    Vector,
)
from threadstate.state.quantities import QUANTITIES
from threadstate.statics.stored import StoredStatics, cells
from threadstate.thread.regions import Region

_LEVEL = 1
"""Compression level of Zstandard, the fastest: higher ones save nothing worth their time."""

# A dictionary is five times as fast as the call of an enumeration.
_REGIONS = {region.value: region for region in Region}
_FEATURES = {features.value: features for features in FeaturePair}
_ATTRIBUTES = tuple(quantity.attribute for quantity in QUANTITIES)
_quantities_of = attrgetter(*_ATTRIBUTES)

Row = tuple[Any, ...]
"""One row in the order of its table's columns, without the leading ``library_id``."""


@dataclass(frozen=True, slots=True)
class ChunkRows:
    """All rows of one orientation, ready to be written, and their content hash."""

    orientation: Orientation
    content_sha256: str
    states: tuple[Row, ...]
    stage_poses: tuple[Row, ...]
    contacts: tuple[Row, ...]
    flags: tuple[Row, ...]
    undecided: tuple[Row, ...]
    states_json: bytes

    @property
    def pose_count(self) -> int:
        """Number of poses of the orientation, decided or not."""
        return len(self.states) + len(self.undecided)


def chunk_rows(
    orientation: Orientation,
    first_ordinal: int,
    answers: Sequence[Answer],
    statics: Mapping[int, StoredStatics | None] = MappingProxyType({}),
) -> ChunkRows:
    """The rows of the answers for an orientation's poses, which are given in order; the statics by ordinal.

    Raises:
        InvalidValueError: a number of a state is not finite.
    """
    content_sha256 = answers_sha256(answers)
    state_rows: list[Row] = []
    pose_rows: list[Row] = []
    contact_rows: list[Row] = []
    flag_rows: list[Row] = []
    undecided_rows: list[Row] = []
    for ordinal, state in enumerate(answers, first_ordinal):
        if isinstance(state, UndecidedPose):
            angles = _positive_zero(state.roll_deg, state.pitch_deg, state.phase_deg)
            undecided_rows.append((ordinal, *angles, state.reason))
            continue
        state_rows.append(
            (
                ordinal,
                state.roll_deg + 0.0,
                state.pitch_deg + 0.0,
                state.phase_deg + 0.0,
                state.state_class.value,
                *map(_plain, _quantities_of(state)),
                *cells(statics.get(ordinal)),
            )
        )
        for stage, pose in enumerate(state.poses, 1):
            first, second, third = pose.rotation
            pose_rows.append((ordinal, stage, *_positive_zero(*first, *second, *third, *pose.translation)))
        for position, contact in enumerate(state.contacts):
            contact_rows.append(
                (
                    ordinal,
                    position,
                    contact.stage,
                    *_positive_zero(*contact.point, *contact.point_bolt, *contact.normal),
                    contact.bolt_region.value,
                    contact.nut_region.value,
                    contact.features.value,
                    contact.bolt_margin + 0.0,
                    contact.nut_margin + 0.0,
                )
            )
        flag_rows += [(ordinal, position, flag.value) for position, flag in enumerate(state.flags)]
    return ChunkRows(
        orientation,
        content_sha256,
        tuple(state_rows),
        tuple(pose_rows),
        tuple(contact_rows),
        tuple(flag_rows),
        tuple(undecided_rows),
        packed_states(answers),
    )


def packed_states(answers: Iterable[Answer]) -> bytes:
    """The states among an orientation's answers as a JSON array, compressed by Zstandard, as ``chunk.states_json``."""
    texts = (state_json(answer) for answer in answers if isinstance(answer, ContactState))
    return zstandard.compress(b"[" + b",".join(texts) + b"]", _LEVEL)


def unpacked_states(packed: bytes) -> bytes:
    """The JSON array of :func:`packed_states`."""
    return zstandard.decompress(packed)


def states_from_rows(
    states: Iterable[Row], stage_poses: Iterable[Row], contacts: Iterable[Row], flags: Iterable[Row]
) -> list[ContactState]:
    """States from their rows, each without ``library_id`` and in the order of its table's primary key.

    The order of the result is that of ``states``.
    """
    poses_of: dict[int, list[StagePose]] = {}
    for ordinal, _, *values in stage_poses:
        rotation = (_vector(values[0:3]), _vector(values[3:6]), _vector(values[6:9]))
        poses_of.setdefault(ordinal, []).append(StagePose(rotation, _vector(values[9:12])))
    contacts_of: dict[int, list[Contact]] = {}
    for ordinal, _, stage, *values in contacts:
        contacts_of.setdefault(ordinal, []).append(
            Contact(
                stage=stage,
                point=_vector(values[0:3]),
                point_bolt=_vector(values[3:6]),
                normal=_vector(values[6:9]),
                bolt_region=_REGIONS[values[9]],
                nut_region=_REGIONS[values[10]],
                features=_FEATURES[values[11]],
                bolt_margin=values[12],
                nut_margin=values[13],
            )
        )
    flags_of: dict[int, list[Flag]] = {}
    for ordinal, _, flag in flags:
        flags_of.setdefault(ordinal, []).append(Flag(flag))
    return [
        ContactState(
            roll_deg=values[0],
            pitch_deg=values[1],
            phase_deg=values[2],
            state_class=StateClass(values[3]),
            flags=tuple(flags_of.get(ordinal, ())),
            poses=tuple(poses_of.get(ordinal, ())),
            **dict(zip(_ATTRIBUTES, values[4:], strict=False)),
            contacts=tuple(contacts_of.get(ordinal, ())),
        )
        for ordinal, *values in states
    ]


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _plain(value: float | None) -> float | None:
    return None if value is None else value + 0.0


def _positive_zero(*values: float) -> Iterable[float]:
    return [value + 0.0 for value in values]


@dataclass(frozen=True, slots=True)
class FormationRows:
    """A formation: its key, its row and the rows of its contacts, without ``library_id``."""

    key: str
    formation: Row
    contacts: tuple[Row, ...]


@dataclass(frozen=True, slots=True)
class HistoryRows:
    """A history as rows without ``library_id``, with the formations that occur in it."""

    formations: tuple[FormationRows, ...]
    intervals: tuple[Row, ...]
    boundaries: tuple[Row, ...]
    boundary_contacts: tuple[Row, ...]
    windows: tuple[Row, ...]
    window_courses: tuple[Row, ...]
    descents: tuple[Row, ...]
    descent_jumps: tuple[Row, ...]
    steepest_fall: tuple[Row, ...]

    def of_orientation(self) -> Iterator[tuple[str, tuple[Row, ...]]]:
        """The names of the tables of the orientation's rows and the rows, in the order of their foreign keys.

        Computing processes, which make the rows, do not need the database's modules.
        """
        yield "history_interval", self.intervals
        yield "history_boundary", self.boundaries
        yield "history_boundary_contact", self.boundary_contacts
        yield "clearance_window", self.windows
        yield "clearance_window_course", self.window_courses
        yield "descent", self.descents
        yield "descent_jump", self.descent_jumps
        yield "steepest_fall", self.steepest_fall

    @property
    def content_sha256(self) -> str:
        """SHA-256, in hexadecimal, of all rows as JSON, in which every number is its shortest decimal."""
        rows = [[one.formation, one.contacts] for one in self.formations], *(rows for _, rows in self.of_orientation())
        return hashlib.sha256(json.dumps(rows, separators=(",", ":"), allow_nan=False).encode()).hexdigest()


def content_sha256_of(rows: ChunkRows, history: HistoryRows | None) -> str:
    """A chunk's content hash: that of its answers and, where it has one, of its history."""
    return rows.content_sha256 if history is None else chunk_sha256(rows.content_sha256, history.content_sha256)
