"""Paths of held bolts that are turned, through both clients."""

from __future__ import annotations

import json
from threading import Event
from typing import Any

import anyio
import pytest

from service.assemblies import endpoints, running
from tests.client.scripted_server import BREAK_OFF, answer, scripted_server
from threadstate.client import (
    AsyncClient,
    Client,
    InvalidRequestError,
    ServiceUnavailableError,
    UnexpectedAnswerError,
    retrying,
)
from threadstate.client.models.assemblies import Assembly, AssemblyProgress
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_document import assembly_document
from threadstate.device.assembly_model import AssemblyPath
from threadstate.device.document import device_from_document
from threadstate.device.watch import PathStoppedError
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import MILLIMETRES_PER_INCH, LengthUnit

POSE = (0.0, -4.0, 300.0)
DEVICE: dict[str, Any] = {"unit": "mm", "k_tilt": 250.0, "push": 4.0}
LITTLE_FRICTION = 0.02
"""With which the path takes many seconds."""
LONGEST_S = 60.0
STREAM = "text/event-stream"
PROGRESS = 'event: progress\ndata: {"leg": 1, "points": 2, "phase": 3.5, "events": []}\n\n'
OUT_OF_TIME = (
    'event: problem\ndata: {"type": "urn:threadstate:problem:out-of-time", "title": "Out of time", "status": 503}\n\n'
)


def test_both_clients_get_what_is_computed(client: Client, address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(running, "LOOK_S", 0.001)
    seen: list[AssemblyProgress] = []

    async def ask() -> Assembly:
        async with AsyncClient(address) as other:
            return await other.assemble(*POSE, device=DEVICE, unit="mm", progress=seen.append)

    path = client.assemble(*POSE, device=DEVICE, unit="mm")
    assert anyio.run(ask) == path
    computed = assemble_pose(quarter_twenty_unc(), *POSE, device_from_document(DEVICE))
    expected = assembly_document(computed, LengthUnit.MILLIMETRE, MILLIMETRES_PER_INCH)
    assert json.loads(path.model_dump_json()) == expected
    assert tuple(event for one in seen for event in one.events) == path.events
    assert len(seen) > 1
    assert seen[-1].leg == 2


class LeavingError(Exception):
    """Whoever watches has seen enough."""


def test_who_leaves_stops_the_service(client: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    stopped = Event()

    def noted(*args: Any, **kwargs: Any) -> AssemblyPath:
        try:
            return assemble_pose(*args, **kwargs)
        except PathStoppedError:
            stopped.set()
            raise

    def leave(_progress: AssemblyProgress) -> None:
        raise LeavingError

    monkeypatch.setattr(endpoints, "assemble_pose", noted)
    with pytest.raises(LeavingError):
        client.assemble(*POSE, mu=LITTLE_FRICTION, progress=leave)
    assert stopped.wait(LONGEST_S)


def test_what_is_not_valid_is_named(client: Client) -> None:
    for progress in (None, lambda _progress: None):
        with pytest.raises(InvalidRequestError, match=r"body mu is '-1\.0'"):
            client.assemble(*POSE, mu=-1.0, progress=progress)
        with pytest.raises(InvalidRequestError, match="body longest_step"):
            client.assemble(*POSE, longest_step=3.0, progress=progress)
        with pytest.raises(InvalidRequestError, match="body strategy"):
            client.assemble(*POSE, strategy="sideways", progress=progress)


@pytest.mark.parametrize(
    ("stream", "error", "words"),
    [
        (PROGRESS + OUT_OF_TIME, ServiceUnavailableError, "POST /v1/assemblies: 503 Out of time"),
        (PROGRESS, UnexpectedAnswerError, "ended without an answer"),
        (PROGRESS + "event: answer\ndata: {}\n\n", UnexpectedAnswerError, "is not an event of a path"),
        (PROGRESS + "event: progress\ndata: x\n\n", UnexpectedAnswerError, "'x' is not an event of a path"),
        (PROGRESS + "event: news\ndata: 1\n\n: nothing new\n\n", UnexpectedAnswerError, "ended without an answer"),
    ],
)
def test_a_stream_without_an_answer_is_an_error(stream: str, error: type[Exception], words: str) -> None:
    seen: list[AssemblyProgress] = []
    with (
        scripted_server([answer(200, stream, STREAM)]) as server,
        Client(server.address, retries=0) as client,
        pytest.raises(error, match=words),
    ):
        client.assemble(*POSE, progress=seen.append)
    assert [(one.leg, one.points, one.phase) for one in seen] == [(1, 2, 3.5)]
    assert f"accept: {STREAM}" in server.heads[0].lower()


def test_a_stream_that_did_not_begin_is_asked_for_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(retrying, "FIRST_PAUSE_S", 0.001)
    script = [BREAK_OFF, answer(200, PROGRESS, STREAM)]
    with (
        scripted_server(script) as server,
        Client(server.address, retries=1) as client,
        pytest.raises(UnexpectedAnswerError, match="ended without an answer"),
    ):
        client.assemble(*POSE, progress=lambda _progress: None)
    assert len(server.heads) == 2
