"""A contact state as the JSON object that the command line prints and the service returns."""

from __future__ import annotations

from math import isfinite
from typing import TypedDict

from threadstate.errors import InvalidValueError
from threadstate.state.model import Contact, ContactState, StagePose

Lengths = list[float]


class PoseDocument(TypedDict):
    """The bolt's pose at a stage, bolt to nut: rows of the rotation; translation as a length."""

    rotation: list[list[float]]
    translation: Lengths


class ContactDocument(TypedDict):
    """A contact in the pose of its stage; ``point`` and ``normal`` in the nut's frame, margins as lengths."""

    stage: int
    point: Lengths
    point_bolt: Lengths
    normal: list[float]
    bolt_region: str
    nut_region: str
    features: str
    bolt_margin: float
    nut_margin: float


class MarginsDocument(TypedDict):
    """Signed lengths from the thresholds of the class, positive on the stable side; null where not known."""

    drop: float | None
    embedment: float | None
    pivot_offset: float | None


# "class" is a Python keyword, hence the functional form.
StateDocument = TypedDict(
    "StateDocument",
    {
        "roll": float,
        "pitch": float,
        "phase": float,
        "class": str,
        "flags": list[str],
        "poses": list[PoseDocument],
        "turns": list[float | None],
        "drop": float | None,
        "embedment": float | None,
        "pivot_offset": float | None,
        "contacts": list[ContactDocument],
        "margins": MarginsDocument,
    },
)
"""A contact state. Angles in degrees; ``turns`` are lambda and mu, null where a stage was not reached."""


def state_document(state: ContactState, length_factor: float = 1.0) -> StateDocument:
    """The document of a state, every length multiplied by ``length_factor``.

    -0.0 becomes 0.0: a stored state and one solved on demand then have the same document.

    Raises:
        InvalidValueError: a number of the state is not finite.
    """
    return {
        "roll": state.roll_deg + 0.0,
        "pitch": state.pitch_deg + 0.0,
        "phase": state.phase_deg + 0.0,
        "class": state.state_class.value,
        "flags": [flag.value for flag in state.flags],
        "poses": [_pose(pose, length_factor) for pose in state.poses],
        "turns": [_number(state.lambda_deg, 1.0), _number(state.mu_deg, 1.0)],
        "drop": _number(state.drop, length_factor),
        "embedment": _number(state.embedment, length_factor),
        "pivot_offset": _number(state.pivot_offset, length_factor),
        "contacts": [_contact(contact, length_factor) for contact in state.contacts],
        "margins": {
            "drop": _number(state.drop_margin, length_factor),
            "embedment": _number(state.embedment_margin, length_factor),
            "pivot_offset": _number(state.pivot_margin, length_factor),
        },
    }


def _pose(pose: StagePose, length_factor: float) -> PoseDocument:
    return {
        "rotation": [_vector(row, 1.0) for row in pose.rotation],
        "translation": _vector(pose.translation, length_factor),
    }


def _contact(contact: Contact, length_factor: float) -> ContactDocument:
    return {
        "stage": contact.stage,
        "point": _vector(contact.point, length_factor),
        "point_bolt": _vector(contact.point_bolt, length_factor),
        "normal": _vector(contact.normal, 1.0),
        "bolt_region": contact.bolt_region.value,
        "nut_region": contact.nut_region.value,
        "features": contact.features.value,
        "bolt_margin": _finite(contact.bolt_margin * length_factor + 0.0),
        "nut_margin": _finite(contact.nut_margin * length_factor + 0.0),
    }


def _vector(vector: tuple[float, float, float], factor: float) -> list[float]:
    return [_finite(value * factor + 0.0) for value in vector]


def _number(value: float | None, factor: float) -> float | None:
    return None if value is None else _finite(value * factor + 0.0)


def _finite(value: float) -> float:
    if not isfinite(value):
        raise InvalidValueError("number of a state", value, "a finite one")
    return value
