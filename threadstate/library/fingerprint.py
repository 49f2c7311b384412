"""The content hash: SHA-256 over the canonical binary of every value of every state, in order."""

from __future__ import annotations

import hashlib
import math
import struct
from collections.abc import Iterable, Sequence
from operator import attrgetter

from threadstate.errors import InvalidValueError
from threadstate.state.model import Answer, ContactState, UndecidedPose
from threadstate.state.quantities import QUANTITIES

_ABSENT = math.nan
"""Stands for None: no stored number is NaN, and ``struct`` writes this one always alike."""


_quantities_of = attrgetter(*(quantity.attribute for quantity in QUANTITIES))


def state_bytes(state: ContactState) -> bytes:
    """One state as bytes: a line of its names, a line of counts, then its numbers as little-endian doubles.

    -0.0 counts as 0.0, because not every database can tell them apart.

    Raises:
        InvalidValueError: a number of the state is not finite.
    """
    numbers: list[float] = [state.roll_deg, state.pitch_deg, state.phase_deg]
    quantities: tuple[float | None, ...] = _quantities_of(state)
    names: list[str] = [state.state_class, *state.flags]
    for pose in state.poses:
        for row in pose.rotation:
            numbers += row
        numbers += pose.translation
    for contact in state.contacts:
        numbers += contact.point
        numbers += contact.point_bolt
        numbers += contact.normal
        numbers.append(contact.bolt_margin)
        numbers.append(contact.nut_margin)
        names += (str(contact.stage), contact.bolt_region, contact.nut_region, contact.features)
    present = [quantity for quantity in quantities if quantity is not None]
    if not (all(map(math.isfinite, numbers)) and all(map(math.isfinite, present))):
        raise InvalidValueError("state", state, "finite numbers only")
    values = [_ABSENT if quantity is None else quantity + 0.0 for quantity in quantities]
    values += [number + 0.0 for number in numbers]
    head = f"{' '.join(names)}\n{len(state.flags)} {len(state.poses)} {len(state.contacts)}\n"
    return head.encode() + struct.pack(f"<{len(values)}d", *values)


def undecided_bytes(pose: UndecidedPose) -> bytes:
    """One undecided pose as bytes: a line that says so, a line of its reason, then its angles as doubles."""
    angles = (pose.roll_deg + 0.0, pose.pitch_deg + 0.0, pose.phase_deg + 0.0)
    return f"undecided\n{pose.reason}\n".encode() + struct.pack("<3d", *angles)


def answers_sha256(answers: Iterable[Answer]) -> str:
    """SHA-256, in hexadecimal, of states and undecided poses in the order given: the content hash of a chunk."""
    digest = hashlib.sha256()
    for answer in answers:
        content = undecided_bytes(answer) if isinstance(answer, UndecidedPose) else state_bytes(answer)
        digest.update(f"{len(content)}\n".encode())
        digest.update(content)
    return digest.hexdigest()


def chunk_sha256(answers_hash: str, history_hash: str) -> str:
    """SHA-256, in hexadecimal, of the hashes of an orientation's answers and of its history: a chunk's content hash."""
    return hashlib.sha256(f"{answers_hash}\n{history_hash}".encode()).hexdigest()


def library_sha256(chunk_hashes: Sequence[str]) -> str:
    """SHA-256, in hexadecimal, of the chunks' hashes in the order of their orientations: a library's content hash."""
    return hashlib.sha256("\n".join(chunk_hashes).encode()).hexdigest()
