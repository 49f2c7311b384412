"""The query parameters of a library's transitions, paths and locations."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

from annotated_types import Ge, Le
from fastapi import Depends, Query
from pydantic import AllowInfNan

from service.quantities import INTEGER_TEXT, NUMBER_TEXT, PhaseMaxQuery, PhaseMinQuery, PitchQuery, RollQuery
from threadstate.network.changes import ChangeKind
from threadstate.network.formation import KEY_DIGITS
from threadstate.network.locate import Observation
from threadstate.network.moves import Move
from threadstate.network.search import Objective
from threadstate.responses.query import TransitionFilter, parse_contact_observations, parse_moves
from threadstate.state.model import Flag, StateClass
from threadstate.statics.verdict import Verdict

_LONGEST_MOVES = len(",".join(Move))
_LONGEST_CONTACT = 80
MOST_CONTACTS = 8

KeyQuery = Annotated[str | None, Query(min_length=KEY_DIGITS, max_length=KEY_DIGITS, description="key of a formation")]
RequiredKey = Annotated[
    str,
    Query(alias="from", min_length=KEY_DIGITS, max_length=KEY_DIGITS, description="key of the formation to start from"),
]
ObjectiveQuery = Annotated[
    Objective,
    Query(description="the objective of the best path: least turning, fewest transitions, largest worst margin"),
]


LeastQuery = Annotated[
    float,
    Ge(0.0),
    Le(1.0),
    AllowInfNan(False),
    NUMBER_TEXT,
    Query(
        description="a steepest fall of more than this many thread pitches is that of a snap",
    ),
]


class NetworkFormat(StrEnum):
    """The formats of a network."""

    SUMMARY = "summary"
    NODE_LINK = "node-link"
    GRAPHML = "graphml"
    DOT = "dot"


def transition_filter(
    move: Annotated[Move | None, Query(description="the move")] = None,
    roll: RollQuery = None,
    pitch: PitchQuery = None,
    phase_min: PhaseMinQuery = None,
    phase_max: PhaseMaxQuery = None,
    source: Annotated[KeyQuery, Query(alias="from")] = None,
    target: Annotated[KeyQuery, Query(alias="to")] = None,
    change: Annotated[ChangeKind | None, Query(description="what changes")] = None,
    state_class: Annotated[StateClass | None, Query(alias="class", description="the class it begins with")] = None,
) -> TransitionFilter:
    """The filter of the query parameters.

    Raises:
        InvalidValueError: ``phase_min`` is above ``phase_max``.
    """
    return TransitionFilter(move, roll, pitch, phase_min, phase_max, source, target, change, state_class)


def path_moves(
    moves: Annotated[
        str,
        Query(max_length=_LONGEST_MOVES, description=f"moves allowed, separated by commas: {', '.join(Move)}"),
    ] = Move.COUNTER_CLOCKWISE.value,
) -> frozenset[Move]:
    """The moves of the query parameter; a plus sign may arrive as a space, which it encodes in a query.

    Raises:
        UnknownNameError: no such move.
    """
    return parse_moves(moves.replace(" ", "+"))


def observation(
    state_class: Annotated[StateClass | None, Query(alias="class", description="the class observed")] = None,
    contacts: Annotated[
        Annotated[int, Ge(1), Le(MOST_CONTACTS), INTEGER_TEXT] | None, Query(description="how many contacts there are")
    ] = None,
    flag: Annotated[Flag | None, Query(description="a flag observed")] = None,
    contact: Annotated[
        str | None,
        Query(
            max_length=MOST_CONTACTS * _LONGEST_CONTACT,
            description="what was observed of contacts, separated by commas; of each stage, bolt region, nut region "
            "and features, separated by colons, `*` or nothing where not observed",
            examples=["1:crest:crest:edge-edge,2:*:flank_pos"],
        ),
    ] = None,
    ordered: Annotated[
        bool,
        Query(
            description="whether the contacts are the first ones in their order",
            json_schema_extra={"enum": [True, False]},
        ),
    ] = False,
    verdict: Annotated[
        Verdict | None, Query(description="what the bolt was seen to do under a load; with `mu`")
    ] = None,
) -> Observation:
    """The observation of the query parameters.

    Raises:
        InvalidValueError: a contact that cannot be read, or more contacts than there are.
        UnknownNameError: a region or a pair of features that does not exist.
    """
    flags = frozenset() if flag is None else frozenset({flag})
    return Observation(state_class, contacts, flags, parse_contact_observations(contact or ""), ordered, verdict)


TransitionQuery = Annotated[TransitionFilter, Depends(transition_filter)]
MovesQuery = Annotated[frozenset[Move], Depends(path_moves)]
ObservationQuery = Annotated[Observation, Depends(observation)]
