from __future__ import annotations

import pytest

from threadstate.answer.observed import contact_observations, named_moves
from threadstate.errors import InvalidValueError, UnknownNameError
from threadstate.network.locate import ContactObservation
from threadstate.network.moves import Move
from threadstate.state.model import FeaturePair
from threadstate.thread.regions import Region


def test_moves_are_read_by_their_names() -> None:
    assert named_moves("ccw") == {Move.COUNTER_CLOCKWISE}
    assert named_moves("ccw,roll+,pitch-") == {Move.COUNTER_CLOCKWISE, Move.ROLL_UP, Move.PITCH_DOWN}
    with pytest.raises(UnknownNameError, match="sideways"):
        named_moves("ccw,sideways")


def test_contacts_are_read_part_by_part() -> None:
    assert contact_observations("") == ()
    assert contact_observations("1:crest:*:edge-edge,2,*:*:flank_pos") == (
        ContactObservation(1, Region("crest"), None, FeaturePair.EDGE_EDGE),
        ContactObservation(2),
        ContactObservation(None, None, Region("flank_pos"), None),
    )


@pytest.mark.parametrize("text", ["4", "one", "1:crest:crest:edge-edge:more", "-1"])
def test_a_contact_that_cannot_be_read_is_named(text: str) -> None:
    with pytest.raises(InvalidValueError, match=text):
        contact_observations(text)


@pytest.mark.parametrize("text", ["1:valley", "1:*:valley", "1:*:*:edge-on"])
def test_what_does_not_exist_is_named(text: str) -> None:
    with pytest.raises(UnknownNameError):
        contact_observations(text)
