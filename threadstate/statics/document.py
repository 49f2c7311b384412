"""The statics of a state as the JSON object that the command line prints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Literal, NotRequired

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.state.document import VectorDocument
from threadstate.state.model import Vector
from threadstate.statics.extras import Extra, Extras
from threadstate.statics.modes import ContactMode, ModeStatus, Motion
from threadstate.statics.reaction import Reaction
from threadstate.statics.solve import ContactForce, Statics
from threadstate.statics.verdict import Verdict


class LoadDocument(TypedDict):
    """A load on the bolt: a force, and a moment about a point."""

    force: Annotated[VectorDocument, Field(description="in N")]
    moment: Annotated[VectorDocument, Field(description="in N times the unit of length")]
    point: Annotated[VectorDocument, Field(description="about which the moment is taken")]
    frame: Literal["nut"]


class ContactForceDocument(TypedDict):
    """The force on the bolt at a contact, in N."""

    contact: Annotated[int, Field(ge=1, description="the state's contacts, then the hull of its patch, from 1")]
    normal: float
    tangential: VectorDocument


class StaticsDocument(TypedDict):
    """The statics of a state under a load (forces, section 3)."""

    roll: float
    pitch: float
    phase: float
    load: LoadDocument
    mu: float
    penetrating: Annotated[bool, Field(description="whether the solids overlap, so that no forces can be real")]
    supported: bool
    support_margin: float
    mu_hold: Annotated[float | None, Field(description="null where no friction is known to hold the load")]
    mu_wedge: Annotated[float | None, Field(description="null where no friction is known to wedge")]
    turn_effort_ccw: Annotated[float | None, Field(description="null where no torque turns the bolt that way")]
    turn_effort_cw: float | None
    forces: list[ContactForceDocument]
    verdict: Verdict


class ReactionDocument(TypedDict):
    """The least wrench on the bolt that must be added to the load, about the bolt's origin, in the nut's frame."""

    force: Annotated[VectorDocument, Field(description="in N")]
    moment: Annotated[VectorDocument, Field(description="in N times the unit of length")]
    point: Annotated[VectorDocument, Field(description="about which the moment is taken: the bolt's origin")]
    frame: Literal["nut"]
    size: Annotated[float, Field(description="its norm in N, moments over the nominal radius; 0 where none is needed")]
    least_size: Annotated[float, Field(description="no wrench of a smaller size will do")]


class NormalRangeDocument(TypedDict):
    """The least and the largest normal force of a contact among all balancing forces, in N."""

    contact: Annotated[int, Field(ge=1)]
    normal_min: float
    normal_max: Annotated[float | None, Field(description="null where contacts wedge and it has no limit")]
    uncertainty: Annotated[float, Field(description="how far beyond these the true ends may lie")]


class TwistDocument(TypedDict):
    """A velocity of the bolt, for a viscous medium in which a force of 1 N on its origin gives it the velocity 1."""

    angular: Annotated[VectorDocument, Field(description="over the unit of length")]
    linear: VectorDocument
    point: Annotated[VectorDocument, Field(description="of the bolt that has the linear velocity: its origin")]
    frame: Literal["nut"]


class ModeDocument(TypedDict):
    """A contact mode that is consistent with the load, or one that is undecided."""

    contacts: list[Motion]
    status: ModeStatus
    twist: Annotated[TwistDocument | None, Field(description="null where undecided")]
    forces: list[ContactForceDocument]
    margin: Annotated[float | None, Field(description="by how much the conditions hold, over the load")]


class ContactWrenchDocument(TypedDict):
    """A contact that carries forces, in the last pose: the wrench of a force of 1 N along its normal."""

    contact: Annotated[int, Field(ge=1)]
    point: VectorDocument
    normal: Annotated[VectorDocument, Field(description="from the nut into the bolt: the force")]
    moment: Annotated[VectorDocument, Field(description="about the load's point, in N times the unit of length")]


class ExtrasDocument(TypedDict):
    """What is added to the statics of a state on request."""

    wrenches: NotRequired[list[ContactWrenchDocument]]
    hull_gap: NotRequired[
        Annotated[float, Field(description="the hull of a true patch reaches beyond its contacts by no more")]
    ]

    reaction: NotRequired[ReactionDocument]
    forces_range: NotRequired[
        Annotated[
            list[NormalRangeDocument], Field(description="empty where no forces balance the load, and on a patch")
        ]
    ]
    internal_dimension: NotRequired[
        Annotated[int | None, Field(description="of the forces that balance each other; null on a patch")]
    ]
    modes: NotRequired[Annotated[list[ModeDocument] | None, Field(description="null on a patch")]]


class RequestedStaticsDocument(StaticsDocument, ExtrasDocument):
    """The statics of a state, with what else was requested."""


def statics_document(statics: Statics, length_factor: float = 1.0) -> StaticsDocument:
    """The statics of a state as an object, lengths times a factor from the pair's unit."""
    load = statics.load
    roll, pitch, phase = statics.pose_deg
    return StaticsDocument(
        roll=roll,
        pitch=pitch,
        phase=phase,
        load=LoadDocument(
            force=list(load.force),
            moment=[length_factor * number for number in load.moment],
            point=[length_factor * number for number in load.point or ()],
            frame="nut",
        ),
        mu=statics.mu,
        penetrating=statics.penetrating,
        supported=statics.supported,
        support_margin=statics.support_margin,
        mu_hold=statics.hold.value,
        mu_wedge=statics.wedge.value,
        turn_effort_ccw=_finite(statics.turn_effort_ccw),
        turn_effort_cw=_finite(statics.turn_effort_cw),
        forces=_forces(statics.forces),
        verdict=statics.verdict,
    )


def requested_document(statics: Statics, extras: Extras | None, length_factor: float = 1.0) -> RequestedStaticsDocument:
    """The statics of a state with what else was requested, lengths times a factor from the pair's unit."""
    added = ExtrasDocument() if extras is None else extras_document(extras, length_factor)
    return RequestedStaticsDocument(**statics_document(statics, length_factor), **added)


def extras_document(extras: Extras, length_factor: float = 1.0) -> ExtrasDocument:
    """What was requested beside the statics of a state, lengths times a factor from the pair's unit."""
    document = ExtrasDocument()
    if extras.wrenches is not None:
        document["wrenches"] = [
            ContactWrenchDocument(
                contact=one.contact,
                point=_times(length_factor, one.point),
                normal=list(one.normal),
                moment=_times(length_factor, one.moment),
            )
            for one in extras.wrenches
        ]
        document["hull_gap"] = length_factor * extras.hull_gap
    if extras.reaction is not None:
        document["reaction"] = _reaction(extras.reaction, extras.origin, length_factor)
    if extras.forces_range is not None:
        document["forces_range"] = [
            NormalRangeDocument(
                contact=one.contact,
                normal_min=one.normal_min,
                normal_max=_finite(one.normal_max),
                uncertainty=one.uncertainty,
            )
            for one in extras.forces_range.contacts
        ]
        document["internal_dimension"] = extras.forces_range.internal_dimension
    if Extra.MODES in extras.requested:
        modes = extras.modes
        document["modes"] = None if modes is None else [_mode(one, extras.origin, length_factor) for one in modes]
    return document


def _reaction(reaction: Reaction, origin: Vector, length_factor: float) -> ReactionDocument:
    return ReactionDocument(
        force=list(reaction.force),
        moment=_times(length_factor, reaction.moment),
        point=_times(length_factor, origin),
        frame="nut",
        size=reaction.size,
        least_size=reaction.least_size,
    )


def _mode(mode: ContactMode, origin: Vector, length_factor: float) -> ModeDocument:
    twist = None
    if mode.angular is not None and mode.linear is not None:
        twist = TwistDocument(
            angular=_times(1.0 / length_factor, mode.angular),
            linear=list(mode.linear),
            point=_times(length_factor, origin),
            frame="nut",
        )
    return ModeDocument(
        contacts=list(mode.contacts), status=mode.status, twist=twist, forces=_forces(mode.forces), margin=mode.margin
    )


def _forces(forces: Sequence[ContactForce]) -> list[ContactForceDocument]:
    return [
        ContactForceDocument(contact=one.contact, normal=one.normal, tangential=list(one.tangential)) for one in forces
    ]


def _times(factor: float, vector: Vector) -> VectorDocument:
    return [factor * number for number in vector]


def _finite(effort: float | None) -> float | None:
    return None if effort is None or math.isinf(effort) else effort
