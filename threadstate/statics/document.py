"""The statics of a state as the JSON object that the command line prints."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.state.document import VectorDocument
from threadstate.statics.reaction import Reaction
from threadstate.statics.solve import Statics
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
    size: Annotated[float, Field(description="its norm in N, moments over the nominal radius; 0 where none is needed")]
    least_size: Annotated[float, Field(description="no wrench of a smaller size will do")]


def reaction_document(reaction: Reaction, length_factor: float = 1.0) -> ReactionDocument:
    """The least reaction as an object, lengths times a factor from the pair's unit."""
    return ReactionDocument(
        force=list(reaction.force),
        moment=[length_factor * number for number in reaction.moment],
        size=reaction.size,
        least_size=reaction.least_size,
    )


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
        forces=[
            ContactForceDocument(contact=one.contact, normal=one.normal, tangential=list(one.tangential))
            for one in statics.forces
        ],
        verdict=statics.verdict,
    )


def _finite(effort: float | None) -> float | None:
    return None if effort is None or math.isinf(effort) else effort
