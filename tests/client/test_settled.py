"""Where held bolts come to rest, through both clients."""

from __future__ import annotations

import json
from typing import Any

import anyio
import pytest

from threadstate.client import AsyncClient, Client, InvalidRequestError
from threadstate.client.models.settled import SettleAnswer
from threadstate.device.document import device_from_document, settled_document
from threadstate.device.settle import settle_poses
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import MILLIMETRES_PER_INCH, LengthUnit

POSES = [(0.0, 3.0, 250.0), (1.0, 0.5, 120.0)]
DEVICE: dict[str, Any] = {"unit": "mm", "k_tilt": 250.0, "push": 1.0 / 3.0}


def test_both_clients_get_what_is_computed(client: Client, address: str) -> None:
    async def ask() -> SettleAnswer:
        async with AsyncClient(address) as other:
            return await other.settle(POSES, device=DEVICE, unit="mm")

    answer = client.settle(POSES, device=DEVICE, unit="mm")
    assert anyio.run(ask) == answer
    settled = settle_poses(quarter_twenty_unc(), POSES, device_from_document(DEVICE))
    expected = [settled_document(state, LengthUnit.MILLIMETRE, MILLIMETRES_PER_INCH) for state in settled]
    assert [json.loads(state.model_dump_json()) for state in answer.states] == expected
    assert (answer.designation, answer.unit) == ("1/4-20 UNC", LengthUnit.MILLIMETRE)


def test_without_a_device_it_is_the_default_one(client: Client) -> None:
    (state,) = client.settle(POSES[:1]).states
    (again,) = client.settle(POSES[:1], device={"unit": "in"}, designation="1/4-20 UNC").states
    assert state == again
    assert sum(contact.force[2] for contact in state.contacts) == pytest.approx(10.0)


def test_what_is_not_valid_is_named(client: Client) -> None:
    with pytest.raises(InvalidRequestError, match=r"body device push is '-1\.0'"):
        client.settle(POSES, device={"unit": "mm", "push": -1.0})
    with pytest.raises(InvalidRequestError, match="body poses"):
        client.settle([])
