"""Devices as small documents, and settled states as the JSON objects that the command line prints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import astuple
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError
from typing_extensions import TypedDict

from threadstate.device.model import (
    TWIST,
    About,
    Device,
    Limits,
    LoadedContact,
    Outcome,
    SettledFlag,
    SettledState,
    diagonal_device,
)
from threadstate.device.model import default_device as _default
from threadstate.errors import InvalidValueError
from threadstate.state.document import PoseDocument, VectorDocument
from threadstate.state.model import FeaturePair, Vector
from threadstate.units import LengthUnit

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
RIGID = "rigid"

DIAGONAL = ("k_lateral", "k_axial", "k_tilt", "k_twist")
LIMITS = ("tilt_limit", "shift_limit", "torque_limit")
"""The keys of a device's limits, in the order of :class:`threadstate.device.model.Limits`."""


class DeviceDocument(BaseModel):
    """A device as a document (docs/device.md): what it leaves out is as of the default device.

    Lengths are in ``unit``, forces in N; stiffnesses in N a length, N times a length a rad; ``ccw_turn`` and
    ``tilt_limit`` in degrees. A limit that it leaves out is none.
    """

    model_config = ConfigDict(extra="forbid")

    unit: LengthUnit
    k_lateral: Number | None = None
    k_axial: Number | None = None
    k_tilt: Number | None = None
    k_twist: Number | Literal["rigid"] | None = None
    stiffness: list[list[Number]] | None = None
    centre: Number | None = None
    push: Number | None = None
    about: About | None = None
    ccw_turn: Number | None = None
    tilt_limit: Number | None = None
    shift_limit: Number | None = None
    torque_limit: Number | None = None


def device_from_document(values: Mapping[str, Any]) -> Device:
    """The device of a document's values.

    Raises:
        InvalidValueError: a key is unknown, a value is not valid, ``unit`` is missing, or ``stiffness`` stands beside
            one of the stiffnesses that it replaces.
    """
    try:
        document = DeviceDocument.model_validate(values)
    except ValidationError as error:
        raise _refused(error) from None
    default = _default().in_unit(document.unit)
    centre = default.centre if document.centre is None else document.centre
    push = default.push if document.push is None else document.push
    about = document.about or default.about
    ccw_turn_deg = default.ccw_turn_deg if document.ccw_turn is None else document.ccw_turn
    limits = Limits(*(getattr(document, name) for name in LIMITS))
    if document.stiffness is not None:
        for name in DIAGONAL[:3]:
            if getattr(document, name) is not None:
                raise InvalidValueError(name, getattr(document, name), "left out beside stiffness, which has it")
        if document.k_twist not in (None, RIGID):
            raise InvalidValueError("k_twist", document.k_twist, f'"{RIGID}" or left out beside stiffness')
        rows = tuple(tuple(row) for row in document.stiffness)
        return Device(rows, centre, push, document.unit, document.k_twist == RIGID, about, ccw_turn_deg, limits)
    stiffness = default.stiffness
    twist = document.k_twist
    return diagonal_device(
        k_lateral=stiffness[3][3] if document.k_lateral is None else document.k_lateral,
        k_axial=stiffness[5][5] if document.k_axial is None else document.k_axial,
        k_tilt=stiffness[0][0] if document.k_tilt is None else document.k_tilt,
        k_twist=None if twist is None or twist == RIGID else float(twist),
        centre=centre,
        push=push,
        unit=document.unit,
        about=about,
        ccw_turn_deg=ccw_turn_deg,
        limits=limits,
    )


def device_document(device: Device) -> dict[str, Any]:
    """The document of a device: four stiffnesses where it has no more, else all of them; every key with its value, but
    limits that it does not have.

    ``device_from_document`` gives the same device back; equal devices have equal documents.
    """
    stiffness = device.stiffness
    diagonal = [stiffness[i][i] for i in range(6)]
    is_diagonal = all(value == 0.0 for i, row in enumerate(stiffness) for j, value in enumerate(row) if i != j)
    named: dict[str, Any]
    if is_diagonal and diagonal[0] == diagonal[1] and diagonal[3] == diagonal[4]:
        k_twist = RIGID if device.twist_is_rigid else diagonal[TWIST]
        named = {"k_lateral": diagonal[3], "k_axial": diagonal[5], "k_tilt": diagonal[0], "k_twist": k_twist}
    else:
        rigid = {"k_twist": RIGID} if device.twist_is_rigid else {}
        named = {**rigid, "stiffness": [list(row) for row in stiffness]}
    values = {**named, "centre": device.centre, "push": device.push}
    return {
        "unit": device.unit.value,
        **_positive_zeros(values),
        "about": device.about.value,
        "ccw_turn": float(device.ccw_turn_deg),
        **{name: value for name, value in zip(LIMITS, astuple(device.limits), strict=True) if value is not None},
    }


def _positive_zeros(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _positive_zeros(one) for name, one in value.items()}
    if isinstance(value, list):
        return [_positive_zeros(one) for one in value]
    return value if isinstance(value, str) else float(value) + 0.0


def _refused(error: ValidationError) -> InvalidValueError:
    first = error.errors()[0]
    key, *inside = first["loc"]
    name = f"{key}{''.join(f'[{part}]' for part in inside if isinstance(part, int))}"
    if first["type"] == "extra_forbidden":
        return InvalidValueError(name, first["input"], f"one of the keys {', '.join(DeviceDocument.model_fields)}")
    if first["type"] == "missing":
        return InvalidValueError(name, None, 'the unit of all lengths, "in" or "mm"')
    if key == "k_twist":
        return InvalidValueError(name, first["input"], f'a stiffness >= 0 or "{RIGID}"')
    return InvalidValueError(name, first["input"], first["msg"].removeprefix("Input should be "))


class DeviationDocument(TypedDict):
    """How far the device gives way: the shift of its centre, and a rotation vector in degrees."""

    shift: VectorDocument
    rotation: VectorDocument


class SettledContactDocument(TypedDict):
    """A contact with the force on the bolt, in N."""

    point: VectorDocument
    normal: VectorDocument
    features: FeaturePair
    force: VectorDocument


class FallDocument(TypedDict):
    """A fall on the way: the push in N, how far the origin sank and how far it went, and the potential lost."""

    push: float
    drop: float
    way: float
    energy: float


class SettledMarginsDocument(TypedDict):
    """How far a settled state is from its next event; null where it has none of the kind."""

    force: float | None
    gap: float | None
    stability: float | None
    residual: float | None
    pressure: float | None


class SettledDocument(TypedDict):
    """A settled state; angles in degrees, lengths in the unit of the answer, energies in N times that unit."""

    roll: float
    pitch: float
    phase: float
    unit: LengthUnit
    outcome: Outcome
    pose: PoseDocument | None
    deviation: DeviationDocument | None
    contacts: list[SettledContactDocument]
    elastic_energy: float | None
    falls: list[FallDocument]
    flags: list[SettledFlag]
    margins: SettledMarginsDocument


def settled_document(state: SettledState, unit: LengthUnit, factor: float = 1.0) -> SettledDocument:
    """The document of a settled state, its lengths multiplied by ``factor`` to be in ``unit``."""
    margins = state.margins
    return {
        "roll": state.roll_deg + 0.0,
        "pitch": state.pitch_deg + 0.0,
        "phase": state.phase_deg + 0.0,
        "unit": unit,
        "outcome": state.outcome,
        "pose": None
        if state.pose is None
        else {
            "rotation": [vector_document(row) for row in state.pose.rotation],
            "translation": vector_document(state.pose.translation, factor),
        },
        "deviation": None
        if state.shift is None or state.rotation_deg is None
        else {"shift": vector_document(state.shift, factor), "rotation": vector_document(state.rotation_deg)},
        "contacts": [contact_document(contact, factor) for contact in state.contacts],
        "elastic_energy": scaled(state.elastic_energy, factor),
        "falls": [
            {
                "push": fall.push,
                "drop": fall.drop * factor + 0.0,
                "way": fall.way * factor,
                "energy": fall.energy * factor + 0.0,
            }
            for fall in state.falls
        ],
        "flags": list(state.flags),
        "margins": {
            "force": margins.force,
            "gap": scaled(margins.gap, factor),
            "stability": scaled(margins.stability, 1.0 / factor),
            "residual": margins.residual,
            "pressure": scaled(margins.pressure, factor),
        },
    }


def contact_document(contact: LoadedContact, factor: float) -> SettledContactDocument:
    """The document of a contact, its lengths multiplied by ``factor``."""
    return {
        "point": vector_document(contact.point, factor),
        "normal": vector_document(contact.normal),
        "features": contact.features,
        "force": vector_document(contact.force),
    }


def vector_document(vector: Vector, factor: float = 1.0) -> list[float]:
    """A vector times a factor, without negative zeros."""
    return [number * factor + 0.0 for number in vector]


def scaled(value: float | None, factor: float) -> float | None:
    """A number times a factor, without a negative zero; None stays."""
    return None if value is None else value * factor + 0.0
