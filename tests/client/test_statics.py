"""What loads do to states, through both clients, and what is refused before it is sent."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from typing import Any

import anyio
import pytest

from threadstate.client import AsyncClient, Client
from threadstate.client.calls.statics import MOST_COMBINATIONS
from threadstate.client.loads import LoadToBear
from threadstate.client.models.statics import Statics
from threadstate.errors import InvalidValueError
from threadstate.state.solve import solve_pose
from threadstate.statics.document import statics_document
from threadstate.statics.load import Load
from threadstate.statics.solve import statics_of
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.units import MILLIMETRES_PER_INCH

POSE = (0.0, -3.0, 180.0)
FORCE, MOMENT, POINT = (0.1, 0.0, -10.0), (0.0, 0.25, 0.0), (1.0 / 3.0, 0.0, -1e-7)


def _dumped(statics: Statics) -> Any:
    return json.loads(statics.model_dump_json(exclude_unset=True))


def _computed(load: Load, mu: float, factor: float = 1.0) -> Any:
    pair = quarter_twenty_unc()
    return statics_document(statics_of(pair, solve_pose(pair, *POSE), load.with_lengths_over(factor), mu), factor)


def test_a_stored_state_bears_what_the_solver_says(client: Client) -> None:
    assert _dumped(client.statics(*POSE)) == _computed(Load(), 0.2)
    under = client.statics(*POSE, mu=0, force=FORCE, moment=MOMENT, point=POINT, library=2, unit="mm")
    assert _dumped(under) == _computed(Load(FORCE, MOMENT, POINT), 0.0, MILLIMETRES_PER_INCH)


def test_both_clients_get_the_same_for_poses_under_loads(client: Client, address: str) -> None:
    loads: list[LoadToBear] = [{}, {"force": FORCE, "moment": MOMENT, "point": POINT, "mu": 1.5}]

    async def asked() -> Any:
        async with AsyncClient(address) as other:
            return await other.solve_statics([POSE], loads, unit="mm"), await other.statics(*POSE, mu=0.3)

    answer = client.solve_statics([POSE], loads, unit="mm")
    assert anyio.run(asked) == (answer, client.statics(*POSE, mu=0.3))
    assert (answer.designation, answer.library, answer.unit) == ("1/4-20 UNC", None, "mm")
    assert [_dumped(one) for one in answer.statics] == [
        _computed(Load(), 0.2, MILLIMETRES_PER_INCH),
        _computed(Load(FORCE, MOMENT, POINT), 1.5, MILLIMETRES_PER_INCH),
    ]


BAD: list[tuple[Callable[[Client], object], str]] = [
    (lambda client: client.statics(*POSE, mu=-0.1), "mu is -0.1; valid: a finite number >= 0"),
    (lambda client: client.statics(*POSE, mu=math.nan), "mu is nan; valid: a finite number >= 0"),
    (lambda client: client.statics(*POSE, mu=math.inf), "mu is inf; valid: a finite number >= 0"),
    (lambda client: client.statics(*POSE, force=(0, 0, 0)), "force is .*; valid: a force or a moment that is not zero"),
    (lambda client: client.statics(*POSE, point=(1, 2)), r"point is \(1.0, 2.0\); valid: three finite numbers"),
    (lambda client: client.statics(*POSE, moment=(0, 0, math.inf)), "moment is .*; valid: three finite numbers"),
    (lambda client: client.statics(*POSE, force="0,0,-1"), "force is '0,0,-1'; valid: three finite numbers"),  # type: ignore[arg-type]
    (lambda client: client.solve_statics([POSE], [{}, {"mu": -1}]), "loads 1 mu is -1.0; valid: a finite number"),
    (lambda client: client.solve_statics([POSE], [{"force": (0, 0)}]), "loads 0 force is .*; valid: three"),
    (lambda client: client.solve_statics([POSE], [{"muh": 1}]), "loads 0 muh is 1; valid: one of force, moment, "),  # type: ignore[typeddict-unknown-key]
    (lambda client: client.solve_statics([]), "poses times loads is 0; valid: 1 to 1000"),
    (lambda client: client.solve_statics([POSE], []), "poses times loads is 0; valid: 1 to 1000"),
    (
        lambda client: client.solve_statics([POSE] * 7, [{}] * (MOST_COMBINATIONS // 6)),
        "poses times loads is 1162; valid: 1 to 1000",
    ),
]


@pytest.mark.parametrize(("ask", "message"), BAD)
def test_what_is_not_valid_is_refused_before_it_is_sent(ask: Callable[[Client], object], message: str) -> None:
    with Client("http://127.0.0.1:1", retries=0) as nowhere, pytest.raises(InvalidValueError, match=message):
        ask(nowhere)
