"""Where held bolts come to rest, through both clients."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import anyio
import pytest

from harness.databases import Databases
from tests.service.settled_library import LEVEL as GRID
from tests.service.settled_library import store_settled
from tests.service_thread import service_thread
from threadstate.client import AsyncClient, Client, InvalidRequestError, NotFoundError
from threadstate.client.models.settled import SettleAnswer, Settled
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


@pytest.fixture(scope="module")
def settled_address(sqlite_databases: Databases) -> Iterator[str]:
    """The address of a service over a library of the level orientation's settled states at four phases."""
    database = sqlite_databases.migrated()
    store_settled(database, GRID, device_from_document(DEVICE))
    with service_thread(database) as address:
        yield address


def test_stored_settled_states_are_read_by_both_clients(settled_address: str) -> None:
    async def ask() -> list[Settled]:
        async with AsyncClient(settled_address) as other:
            return [state async for state in other.settled_states(limit=3)]

    with Client(settled_address) as client:
        (record,) = client.settled_libraries().settled
        detail = client.settled_library(record.id)
        states = list(client.settled_states())
        assert anyio.run(ask) == states
        assert [client.settled_state(0, 0, phase) for phase in GRID.phases_deg] == states
        few = list(client.settled_states(outcome="settled", phase_min=90, phase_max=180, settled_library=record.id))
        frame = client.settled_states(unit="mm").to_polars()
        with pytest.raises(NotFoundError, match="its grid"):
            client.settled_state(1, 0, 0)
    assert few == states[1:3]
    assert (record.device.k_tilt, record.device.push, record.device.stiffness) == (250.0, 1.0 / 3.0, None)
    assert sum(detail.counts.outcomes.values()) == sum(detail.counts.contacts.values()) == GRID.pose_count
    settled = settle_poses(quarter_twenty_unc(), GRID.poses(0), device_from_document(DEVICE))
    assert [json.loads(state.model_dump_json()) for state in states] == [
        settled_document(state, LengthUnit.INCH) for state in settled
    ]
    assert frame["origin_z"].to_list() == [
        None if state.pose is None else state.pose.translation[2] * MILLIMETRES_PER_INCH for state in settled
    ]
    assert frame["contacts"].to_list() == [len(state.contacts) for state in states]
