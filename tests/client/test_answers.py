"""What both clients get from the real service over real libraries, each method."""

from __future__ import annotations

import json
from collections.abc import Awaitable, Callable
from typing import Any

import anyio
import httpx2
import pytest

from tests.service.made_up_states import made_up_state
from threadstate.client import AsyncClient, Client, InvalidRequestError, NotFoundError
from threadstate.client.models.states import State
from threadstate.state.document import state_document
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.standards.designation import standard_threads
from threadstate.thread.standards.document import standard_thread_list


def _asynchronously(address: str, ask: Callable[[AsyncClient], Awaitable[Any]]) -> Any:
    async def asked() -> Any:
        async with AsyncClient(address) as client:
            return await ask(client)

    return anyio.run(asked)


def _dumped(state: State) -> Any:
    return json.loads(state.model_dump_json(by_alias=True))


def test_a_state_is_the_same_to_the_last_bit(client: Client, made_up_id: int) -> None:
    for pose in ((1.0, 0.0, 30.0), (-1.0, 1.0, 0.0), (0.0, 0.0, 330.0)):
        state = client.state(*pose, library=made_up_id)
        assert _dumped(state) == state_document(made_up_state(*pose))
        assert (state.roll, state.pitch, state.phase) == pose


def test_solved_states_are_those_of_the_solver(client: Client) -> None:
    poses = [(1.0, -2.0, 10.5), (3.0, 0.25, -77.0)]
    answer = client.solve(poses)
    assert answer.unit == "in"
    assert [_dumped(one) for one in answer.states] == [
        state_document(solve_pose(quarter_twenty_unc(), *pose)) for pose in poses
    ]


def test_lists_follow_their_pages_as_far_as_they_are_walked(client: Client, made_up_id: int) -> None:
    states = client.states(library=made_up_id, limit=50)
    assert [len(page.items) for page in states.pages()] == [50, 50, 8]
    walked = [(one.roll, one.pitch, one.phase) for one in states]
    assert walked == sorted(walked)
    assert len(set(walked)) == 108
    assert next(iter(states)) == next(iter(states))


def test_filters_and_orders_arrive(client: Client, made_up_id: int) -> None:
    found = list(
        client.states(library=made_up_id, state_class="stable_three_point", phase_min=90, sort="-drop", limit=7)
    )
    assert found
    assert all(one.state_class == "stable_three_point" and one.phase >= 90 for one in found)
    drops = [-1.0 if one.drop is None else one.drop for one in found]
    assert drops == sorted(drops, reverse=True)
    in_mm = next(iter(client.states(library=made_up_id, sort="-drop", unit="mm")))
    in_inches = next(iter(client.states(library=made_up_id, sort="-drop")))
    assert in_mm.drop == in_inches.drop * 25.4 if in_inches.drop else None


@pytest.mark.parametrize("name", [1, "latest", "1/4-20 UNC", "1-4-20-unc"])
def test_a_library_goes_by_any_of_its_names(client: Client, name: int | str) -> None:
    assert client.library(name).designation == "1/4-20 UNC"


def test_standard_threads_are_those_of_the_catalogue(client: Client) -> None:
    assert json.loads(client.threads().model_dump_json()) == standard_thread_list(standard_threads())
    (found,) = client.threads("1/4-16 acme").threads
    assert found.bolt.pitch == (0.2043, 0.2148)
    (found,) = client.threads(search="m6").threads
    assert (found.designation, found.unit, found.nut.major) == ("M6x1-6g/6H", "mm", (6.0, None))
    with pytest.raises(InvalidRequestError, match=r"GET /v1/threads: 400 Invalid value: tolerance class is '6k'"):
        client.threads("M6-6k")


@pytest.mark.slow
def test_both_clients_get_the_same_of_every_method(client: Client, address: str) -> None:
    """Each of the methods that answer, but those of jobs, and what is listed."""
    key = next(
        one.formation.key
        for one in client.intervals(0, -3).history.intervals
        if one.formation.state_class is not None and not one.in_window
    )
    asked: dict[str, dict[str, Any]] = {
        "libraries": {},
        "library": {"unit": "mm"},
        "building": {},
        "orientations": {},
        "compare": {"libraries": ["latest", "latest"]},
        "mesh": {"part": "bolt"},
        "state": {"roll": 0, "pitch": -3, "phase": 180},
        "history": {"roll": 0, "pitch": -3},
        "history_columns": {"roll": 0, "pitch": -3},
        "history_csv": {"roll": 0, "pitch": -3},
        "solve": {"poses": [(0.5, 0.5, 0.5)]},
        "statics": {"roll": 0, "pitch": -3, "phase": 180, "force": (1, 0, -10), "unit": "mm"},
        "jamming": {"roll": 0, "pitch": -3, "phase": 180, "mu": 0.5, "axes": ["mx", "my"], "window": (3, 3)},
        "jamming_svg": {"roll": 0, "pitch": -3, "phase": 180, "contacts": [5, 6, 7], "tolerance": 1e-3},
        "computed_jamming": {"roll": 0.5, "pitch": 0.5, "phase": 0.5},
        "held": {"roll": 0, "pitch": -3, "mu": (0.1, 0.3), "force": (1, 0, -10)},
        "computed_held": {"roll": 1.5, "pitch": 0, "mu": 0.1},
        "solve_statics": {"poses": [(0.5, 0.5, 0.5)], "loads": [{"mu": 0.5}, {}]},
        "settle": {"poses": [(0.5, 0.5, 0.5)], "device": {"unit": "mm", "push": 5}},
        "assemble": {"roll": 1, "pitch": -2, "phase": 10, "strategy": "cw", "progress": lambda _progress: None},
        "settled_libraries": {},
        "settled_library": {"settled_library": 1},
        "settled_state": {"roll": 0, "pitch": 0, "phase": 90, "unit": "mm"},
        "outcomes": {"poses": [(1, -2, 10)], "strategy": "cw", "unit": "mm"},
        "success_maps": {"library": 1},
        "success_map": {},
        "success_orientation": {"roll": 1, "pitch": -1, "unit": "mm"},
        "intervals": {"roll": 0, "pitch": -3},
        "heights": {"roll": 0, "pitch": -3},
        "computed_intervals": {"roll": 1.5, "pitch": 0},
        "computed_heights": {"roll": 1.5, "pitch": 0},
        "computed_falls": {"roll": 1.5, "pitch": 0, "tolerance": 0.1},
        "windows": {"roll": 0},
        "network": {},
        "loaded_network": {"mu": 0.15, "avoid": ["held"]},
        "network_node_link": {},
        "network_graphml": {},
        "network_dot": {},
        "formations": {},
        "formation": {"key": key},
        "path": {"source": key, "moves": ["ccw", "roll+"], "objective": "transitions"},
        "locate": {"contact": ["1:*:*:edge-edge"], "ordered": True, "verdict": "can_stay", "mu": 0.15},
        "threads": {"search": "M6-4g6g/5H"},
        "profiles_svg": {"designation": "M6"},
        "health": {},
        "readiness": {},
    }
    lists: dict[str, dict[str, Any]] = {
        "states": {"roll": 3, "limit": 4},
        "undecided": {},
        "transitions": {"move": "roll+", "roll": 0, "limit": 40},
        "jobs": {},
        "settled_states": {"limit": 3, "outcome": "settled"},
        "success_orientations": {"limit": 4},
    }
    public = {name for name in vars(Client) if not name.startswith("_")}
    of_jobs = {"ask", "ask_settled", "ask_success_map", "growing_map", "job"}
    assert public - {*asked, *lists} == {*of_jobs, "export", "close"}

    async def all_of_them(other: AsyncClient) -> dict[str, Any]:
        found = {name: await getattr(other, name)(**arguments) for name, arguments in asked.items()}
        return found | {
            name: [one async for one in getattr(other, name)(**arguments)] for name, arguments in lists.items()
        }

    found = {name: getattr(client, name)(**arguments) for name, arguments in asked.items()}
    found |= {name: list(getattr(client, name)(**arguments)) for name, arguments in lists.items()}
    assert _asynchronously(address, all_of_them) == found
    assert found["mesh"].startswith(b"glTF")
    assert found["history_csv"].startswith(b"phase,class,")
    assert b"<graphml" in found["network_graphml"]
    assert found["network_dot"].startswith(b"digraph")
    assert found["path"].path.steps[-1].in_window
    assert found["windows"].windows
    assert found["jamming_svg"].startswith(b"<svg")
    assert [one.mu for one in found["held"].held] == [0.1, 0.3]
    assert 0.0 < found["loaded_network"].network.shares["held"] < 1.0
    assert len(found["transitions"]) > 40
    assert found["readiness"].library == found["library"].id


def test_asynchronous_clients_run_on_trio(address: str) -> None:
    async def asked() -> str:
        async with AsyncClient(address) as client:
            return (await client.health()).status

    assert anyio.run(asked, backend="trio") == "ok"


def test_what_is_not_there_is_an_error_of_its_own(client: Client) -> None:
    with pytest.raises(
        NotFoundError, match=r"GET /v1/libraries/latest/states/1.5/0/0: 404 Not found: .*roll 1\.5"
    ) as found:
        client.state(1.5, 0, 0)
    assert (found.value.name, found.value.status) == ("not-found", 404)


def test_an_address_may_have_a_path(address: str) -> None:
    """As behind a proxy; what the client asks is below it, what it is told to follow may be so already."""
    from threadstate.client.options import url_of

    base = httpx2.URL("http://host/threads")
    assert str(url_of(base, "/v1/jobs?before=3")) == "http://host/threads/v1/jobs?before=3"
    assert str(url_of(base, "/threads/v1/jobs?before=3")) == "http://host/threads/v1/jobs?before=3"
    assert str(url_of(httpx2.URL(address), "/v1/libraries/1%2F4")) == f"{address}/v1/libraries/1%2F4"
