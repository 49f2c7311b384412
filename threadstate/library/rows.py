"""States as rows of the tables, and back."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from threadstate.library.fingerprint import states_sha256
from threadstate.library.grid import Orientation
from threadstate.state.model import (
    Contact,
    ContactState,
    FeaturePair,
    Flag,
    StagePose,
    StateClass,
)
from threadstate.thread.regions import Region

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


def chunk_rows(orientation: Orientation, first_ordinal: int, states: Sequence[ContactState]) -> ChunkRows:
    """The rows of an orientation's states, which are given in order.

    Raises:
        InvalidValueError: a number of a state is not finite.
    """
    content_sha256 = states_sha256(states)
    state_rows: list[Row] = []
    pose_rows: list[Row] = []
    contact_rows: list[Row] = []
    flag_rows: list[Row] = []
    for ordinal, state in enumerate(states, first_ordinal):
        state_rows.append(
            (
                ordinal,
                state.roll_deg + 0.0,
                state.pitch_deg + 0.0,
                state.phase_deg + 0.0,
                state.state_class.value,
                _plain(state.lambda_deg),
                _plain(state.mu_deg),
                _plain(state.drop),
                _plain(state.embedment),
                _plain(state.pivot_offset),
                _plain(state.drop_margin),
                _plain(state.embedment_margin),
                _plain(state.pivot_margin),
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
        orientation, content_sha256, tuple(state_rows), tuple(pose_rows), tuple(contact_rows), tuple(flag_rows)
    )


def states_from_rows(
    states: Iterable[Row], stage_poses: Iterable[Row], contacts: Iterable[Row], flags: Iterable[Row]
) -> list[ContactState]:
    """States from their rows, each without ``library_id`` and in the order of its table's primary key.

    The order of the result is that of ``states``.
    """
    poses_of: dict[int, list[StagePose]] = {}
    for ordinal, _, *values in stage_poses:
        rotation = (tuple(values[0:3]), tuple(values[3:6]), tuple(values[6:9]))
        poses_of.setdefault(ordinal, []).append(StagePose(rotation, tuple(values[9:12])))  # type: ignore[arg-type]
    contacts_of: dict[int, list[Contact]] = {}
    for ordinal, _, stage, *values in contacts:
        contacts_of.setdefault(ordinal, []).append(
            Contact(
                stage=stage,
                point=tuple(values[0:3]),  # type: ignore[arg-type]
                point_bolt=tuple(values[3:6]),  # type: ignore[arg-type]
                normal=tuple(values[6:9]),  # type: ignore[arg-type]
                bolt_region=Region(values[9]),
                nut_region=Region(values[10]),
                features=FeaturePair(values[11]),
                bolt_margin=values[12],
                nut_margin=values[13],
            )
        )
    flags_of: dict[int, list[Flag]] = {}
    for ordinal, _, flag in flags:
        flags_of.setdefault(ordinal, []).append(Flag(flag))
    return [
        ContactState(
            roll_deg,
            pitch_deg,
            phase_deg,
            StateClass(state_class),
            tuple(flags_of.get(ordinal, ())),
            tuple(poses_of.get(ordinal, ())),
            *lengths,
            tuple(contacts_of.get(ordinal, ())),
        )
        for ordinal, roll_deg, pitch_deg, phase_deg, state_class, *lengths in states
    ]


def _plain(value: float | None) -> float | None:
    return None if value is None else value + 0.0


def _positive_zero(*values: float) -> Iterable[float]:
    return [value + 0.0 for value in values]
