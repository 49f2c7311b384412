from __future__ import annotations

import pytest

from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.network.locate import ContactObservation
from threadstate.network.moves import Move
from threadstate.responses.query import parse_contact_observations, parse_moves
from threadstate.state.model import FeaturePair
from threadstate.thread.regions import Region


def test_moves_are_read_by_their_names() -> None:
    assert parse_moves("ccw") == {Move.COUNTER_CLOCKWISE}
    assert parse_moves("ccw,roll+,pitch-") == {Move.COUNTER_CLOCKWISE, Move.ROLL_UP, Move.PITCH_DOWN}
    with pytest.raises(UnknownNameError, match="sideways"):
        parse_moves("ccw,sideways")


def test_contacts_are_read_part_by_part() -> None:
    assert parse_contact_observations("") == ()
    assert parse_contact_observations("1:crest:*:edge-edge,2,*:*:flank_pos") == (
        ContactObservation(1, Region("crest"), None, FeaturePair.EDGE_EDGE),
        ContactObservation(2),
        ContactObservation(None, None, Region("flank_pos"), None),
    )


@pytest.mark.parametrize("text", ["4", "one", "1:crest:crest:edge-edge:more", "-1"])
def test_a_contact_that_cannot_be_read_is_named(text: str) -> None:
    with pytest.raises(InvalidValueError, match=text):
        parse_contact_observations(text)


@pytest.mark.parametrize("text", ["1:valley", "1:*:valley", "1:*:*:edge-on"])
def test_what_does_not_exist_is_named(text: str) -> None:
    with pytest.raises(UnknownNameError):
        parse_contact_observations(text)
