"""A contact state as the JSON object that the command line prints and the service returns: its shape, and its making.

The OpenAPI document has its schema from these types; a test compares the client's models with it.
"""

from __future__ import annotations

from math import isfinite
from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.errors import InvalidValueError
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, StagePose, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region

VectorDocument = Annotated[list[float], Field(min_length=3, max_length=3)]


class PoseDocument(TypedDict):
    """The bolt's pose at a stage, bolt to nut: x_nut = rotation x_bolt + translation."""

    rotation: Annotated[list[VectorDocument], Field(min_length=3, max_length=3, description="by rows")]
    translation: VectorDocument


class ContactDocument(TypedDict):
    """A contact in the pose of its stage."""

    stage: Annotated[int, Field(ge=1, le=3)]
    point: Annotated[VectorDocument, Field(description="in the nut's frame")]
    point_bolt: Annotated[VectorDocument, Field(description="in the bolt's frame")]
    normal: Annotated[VectorDocument, Field(description="of length 1, in the nut's frame, from the nut into the bolt")]
    bolt_region: Annotated[Region, Field(json_schema_extra={"enum": [region.value for region in BOLT_REGIONS]})]
    nut_region: Annotated[Region, Field(json_schema_extra={"enum": [region.value for region in NUT_REGIONS]})]
    features: Annotated[FeaturePair, Field(description="what touches, the bolt's first")]
    bolt_margin: Annotated[float, Field(description="arc length to the nearest boundary of the bolt's region")]
    nut_margin: Annotated[float, Field(description="arc length to the nearest boundary of the nut's region")]


class MarginsDocument(TypedDict):
    """Signed distances of the class from its thresholds, positive on the stable side; null where not known."""

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
        "class": StateClass,
        "flags": list[Flag],
        "poses": Annotated[list[PoseDocument], Field(description="one per stage reached")],
        "turns": Annotated[
            list[float | None],
            Field(min_length=2, max_length=2, description="lambda and mu; null where a stage was not reached"),
        ],
        "drop": Annotated[
            float | None, Field(description="how far the bolt's origin sinks from the second pose to the third")
        ],
        "embedment": Annotated[
            float | None, Field(description="least lift of the third pose after which the solids do not overlap")
        ],
        "pivot_offset": Annotated[
            float | None, Field(description="from the bolt's origin to the line through the first two contacts")
        ],
        "contacts": list[ContactDocument],
        "margins": MarginsDocument,
    },
)
"""A contact state; angles in degrees, lengths in the unit of the answer."""


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
        "class": state.state_class,
        "flags": list(state.flags),
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
        "bolt_region": contact.bolt_region,
        "nut_region": contact.nut_region,
        "features": contact.features,
        "bolt_margin": _finite(contact.bolt_margin * length_factor + 0.0),
        "nut_margin": _finite(contact.nut_margin * length_factor + 0.0),
    }


def _vector(vector: tuple[float, float, float], factor: float) -> list[float]:
    x, y, z = vector
    if not (isfinite(x) and isfinite(y) and isfinite(z)):
        raise _not_finite(vector)
    return [x * factor + 0.0, y * factor + 0.0, z * factor + 0.0]


def _number(value: float | None, factor: float) -> float | None:
    return None if value is None else _finite(value * factor + 0.0)


def _finite(value: float) -> float:
    if not isfinite(value):
        raise _not_finite(value)
    return value


def _not_finite(value: object) -> InvalidValueError:
    return InvalidValueError("number of a state", value, "a finite one")
