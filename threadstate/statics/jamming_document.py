"""The jamming diagram of a state as the JSON object that the command line prints and the picture is drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

from pydantic import Field
from typing_extensions import TypedDict

from threadstate.state.document import VectorDocument
from threadstate.state.model import ContactState
from threadstate.statics.cone_slice import SliceKind
from threadstate.statics.document import LoadDocument
from threadstate.statics.jamming import Axis, JammingDiagram, LoadedContact, Mode, Piece, Side
from threadstate.thread.standards.document import SourceDocument

PlanePointDocument = Annotated[list[float], Field(min_length=2, max_length=2)]


MOST_NAMED = 4
"""Contacts of a piece that its text names one by one."""


class LoadedContactDocument(TypedDict):
    """A contact that carries a force on a piece of the boundary of a jamming diagram."""

    contact: Annotated[int, Field(ge=1, description="the state's contacts, then the hull of its patch, from 1")]
    mode: Mode
    side: Annotated[Side | None, Field(description="of its friction cone, half way; null where it sticks")]
    friction_start: Annotated[VectorDocument | None, Field(description="direction of friction on the bolt")]
    friction_end: VectorDocument | None


class PieceDocument(TypedDict):
    """A piece of the boundary of a jamming diagram, counter-clockwise."""

    first: Annotated[int, Field(ge=0, description="of vertices")]
    last: Annotated[int, Field(ge=0, description="of vertices; the same at the end of a segment")]
    straight: bool
    window: Annotated[bool, Field(description="whether it is a cut by the window alone")]
    contacts: Annotated[list[LoadedContactDocument], Field(description="all others carry no force there")]


class JammingDocument(TypedDict):
    """The loads over their push that the contacts of a state can balance, in a plane of loads (forces, section 3)."""

    roll: float
    pitch: float
    phase: float
    mu: float
    axes: Annotated[list[Axis], Field(min_length=2, max_length=2)]
    load: LoadDocument
    load_at: Annotated[PlanePointDocument, Field(description="where the load itself is")]
    contacts: Annotated[list[int], Field(description="the state's, or those of the hull of its level patch")]
    kind: SliceKind
    dimension: int | None
    vertices: Annotated[list[PlanePointDocument], Field(description="counter-clockwise; moments over the radius")]
    pieces: list[PieceDocument]
    rays: Annotated[list[PlanePointDocument], Field(max_length=2, description="extreme directions without an end")]
    window: Annotated[PlanePointDocument | None, Field(description="half widths of what is seen of it")]
    gap: Annotated[float, Field(description="the diagram reaches beyond the vertices by no more")]
    hull_gap: Annotated[float, Field(description="the hull of a true patch reaches beyond its contacts by no more")]
    wedged: Annotated[list[int], Field(description="contacts that can press against each other without a load")]
    penetrating: Annotated[bool, Field(description="whether the solids overlap, so that no forces can be real")]


class ComputedJammingDocument(JammingDocument):
    """The same of any pose, computed on request."""

    designation: str
    source: SourceDocument
    library: Annotated[int | None, Field(description="number of the library whose pair and tolerances these are")]


def jamming_document(state: ContactState, diagram: JammingDiagram, length_factor: float = 1.0) -> JammingDocument:
    """The diagram of a state as an object; the load's lengths times a factor from the pair's unit."""
    load = diagram.load
    return JammingDocument(
        roll=state.roll_deg,
        pitch=state.pitch_deg,
        phase=state.phase_deg,
        mu=diagram.mu,
        axes=list(diagram.axes),
        load=LoadDocument(
            force=list(load.force),
            moment=[length_factor * number for number in load.moment],
            point=[length_factor * number for number in load.point or ()],
            frame="nut",
        ),
        load_at=list(diagram.load_at),
        contacts=list(diagram.contacts),
        kind=diagram.kind,
        dimension=diagram.dimension,
        vertices=diagram.vertices.tolist(),
        pieces=[_piece(piece) for piece in diagram.pieces],
        rays=diagram.rays.tolist(),
        window=None if diagram.window is None else list(diagram.window),
        gap=diagram.gap,
        hull_gap=diagram.hull_gap,
        wedged=list(diagram.wedged),
        penetrating=diagram.penetrating,
    )


def _piece(piece: Piece) -> PieceDocument:
    return PieceDocument(
        first=piece.first,
        last=piece.last,
        straight=piece.straight,
        window=piece.window,
        contacts=[_contact(contact) for contact in piece.contacts],
    )


def _contact(contact: LoadedContact) -> LoadedContactDocument:
    return LoadedContactDocument(
        contact=contact.contact,
        mode=contact.mode,
        side=contact.side,
        friction_start=None if contact.friction_start is None else list(contact.friction_start),
        friction_end=None if contact.friction_end is None else list(contact.friction_end),
    )


def piece_text(document: JammingDocument, piece: PieceDocument) -> str:
    """What contacts do on a piece: those that slide with the side of their cone, those that stick, those that lift."""
    sliding = [one for one in piece["contacts"] if one["mode"] == Mode.SLIDES]
    sticking = [one["contact"] for one in piece["contacts"] if one["mode"] == Mode.STICKS]
    loaded = {one["contact"] for one in piece["contacts"]}
    lifted = [number for number in document["contacts"] if number not in loaded]
    if len(sliding) > MOST_NAMED:
        parts = [f"{len(sliding)} contacts slide"]
    else:
        parts = [
            f"contact {one['contact']} " + (f"slides, friction {one['side']}" if one["side"] else "presses")
            for one in sliding
        ]
    if sticking:
        parts.append(f"{contacts_text(sticking)} {'sticks' if len(sticking) == 1 else 'stick'}")
    if 0 < len(lifted) <= MOST_NAMED:
        parts.append(f"{contacts_text(lifted)} {'lifts' if len(lifted) == 1 else 'lift'} off")
    return "; ".join(parts)


def contacts_text(numbers: Sequence[int]) -> str:
    """Contacts by their numbers; how many, of many."""
    if len(numbers) > MOST_NAMED:
        return f"{len(numbers)} contacts"
    return f"contact{'s' if len(numbers) > 1 else ''} " + ", ".join(map(str, numbers))
