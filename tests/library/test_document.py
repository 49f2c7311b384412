from __future__ import annotations

import json
import math
from dataclasses import replace

from hypothesis import given

from tests.library.states import plain_state, states_at
from threadstate.state.document import state_document
from threadstate.state.json import state_json
from threadstate.state.model import ContactState


def test_the_document_is_the_one_that_is_promised() -> None:
    assert state_json(plain_state()).decode() == (
        '{"roll":1.0,"pitch":-2.0,"phase":30.0,"class":"stable_three_point","flags":["tie"],'
        '"poses":[{"rotation":[[1.0,0.0,0.25],[0.5,1.0,0.75],[0.125,0.375,1.0]],"translation":[0.01,0.02,0.03]}],'
        '"turns":[1.5,null],"drop":0.001,"embedment":0.002,"pivot_offset":0.003,'
        '"contacts":[{"stage":1,"point":[0.1,0.2,0.3],"point_bolt":[0.4,0.5,0.6],"normal":[0.0,0.6,0.8],'
        '"bolt_region":"crest","nut_region":"surface","features":"edge-surface","bolt_margin":0.007,"nut_margin":0.008}],'
        '"margins":{"drop":-0.001,"embedment":0.004,"pivot_offset":0.005}}'
    )


def test_lengths_alone_are_converted() -> None:
    inch, millimetre = state_document(plain_state()), state_document(plain_state(), 25.4)
    contact = millimetre["contacts"][0]
    assert contact["point"] == [25.4 * x for x in (0.1, 0.2, 0.3)]
    assert contact["point_bolt"] == [25.4 * x for x in (0.4, 0.5, 0.6)]
    assert (contact["bolt_margin"], contact["nut_margin"]) == (25.4 * 0.007, 25.4 * 0.008)
    assert contact["normal"] == inch["contacts"][0]["normal"]
    assert millimetre["poses"][0]["translation"] == [25.4 * x for x in (0.01, 0.02, 0.03)]
    assert millimetre["poses"][0]["rotation"] == inch["poses"][0]["rotation"]
    assert millimetre["turns"] == inch["turns"] == [1.5, None]
    assert millimetre["drop"] == 25.4 * 0.001
    assert millimetre["embedment"] == 25.4 * 0.002
    assert millimetre["pivot_offset"] == 25.4 * 0.003
    assert millimetre["margins"] == {"drop": -25.4 * 0.001, "embedment": 25.4 * 0.004, "pivot_offset": 25.4 * 0.005}


@given(states_at(1.0, 2.0, 3.0))
def test_every_number_reads_back_the_same(state: ContactState) -> None:
    assert json.loads(state_json(state)) == state_document(state)


def test_minus_zero_is_written_as_zero() -> None:
    document = state_document(replace(plain_state(), roll_deg=-0.0, drop=-0.0))
    assert math.copysign(1.0, document["roll"]) == 1.0
    assert document["drop"] is not None
    assert math.copysign(1.0, document["drop"]) == 1.0


def test_what_is_absent_is_null() -> None:
    state = replace(
        plain_state(),
        lambda_deg=None,
        drop=None,
        embedment=None,
        pivot_offset=None,
        drop_margin=None,
        embedment_margin=None,
        pivot_margin=None,
    )
    document = state_document(state, 25.4)
    assert document["turns"] == [None, None]
    assert document["drop"] is document["embedment"] is document["pivot_offset"] is None
    assert document["margins"] == {"drop": None, "embedment": None, "pivot_offset": None}
