from __future__ import annotations

import json
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from typing import Any

import pytest
from fastapi.testclient import TestClient
from pydantic import BaseModel

from harness.databases import Databases
from service.network.schemas import (
    ComputedFalls,
    ComputedHeights,
    ComputedIntervals,
    FormationsAnswer,
    HeightsAnswer,
    IntervalsAnswer,
    LocationAnswer,
    NetworkSummary,
    NodeAnswer,
    NodeLinkNetwork,
    PathAnswer,
    TransitionsPage,
    WindowsAnswer,
)
from tests.service.conftest import client_of
from tests.service.own_library import OWN_OPTIONS, OWN_PAIR
from tests.service.test_problems import problem
from tests.stored_histories.history_library import SMALL_GRID as GRID
from tests.stored_histories.history_library import histories_of_grid, store_histories
from threadstate.network.loaded import Part
from threadstate.responses.heights import computed_heights, heights_document
from threadstate.responses.histories import computed_history, history_document
from threadstate.responses.loaded_network import LoadedNetwork
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import quarter_twenty_unc, source_of
from worker.cli import run_command_line

pytestmark = pytest.mark.sqlite_alone

LIBRARY = "/v1/libraries/latest"
PAIR = quarter_twenty_unc()


@pytest.fixture(scope="module")
def network_database(databases: Databases) -> str:
    database = databases.migrated()
    store_histories(database, GRID, histories_of_grid(GRID))
    return database


@pytest.fixture(scope="module")
def network_client(network_database: str) -> Iterator[TestClient]:
    with client_of(network_database) as client:
        yield client


def _json(client: TestClient, path: str) -> Any:
    response = client.get(path)
    assert response.status_code == 200, response.text
    return response.json()


def _intervals(client: TestClient) -> list[Any]:
    found: list[Any] = _json(client, f"{LIBRARY}/histories/0/-3/intervals")["history"]["intervals"]
    return found


def _key(client: TestClient) -> str:
    """The key of a decided formation that occurs outside the window."""
    found = (one for one in _intervals(client) if not one["in_window"] and one["formation"]["class"] is not None)
    return str(next(found)["formation"]["key"])


@pytest.mark.slow
def test_answers_have_the_documented_shape(network_client: TestClient) -> None:
    key = _key(network_client)
    answers: list[tuple[str, type[BaseModel]]] = [
        (f"{LIBRARY}/histories/0/-3/intervals", IntervalsAnswer),
        (f"{LIBRARY}/histories/0/-3/heights", HeightsAnswer),
        ("/v1/histories/1.5/-0.5/intervals", ComputedIntervals),
        ("/v1/histories/1.5/-0.5/heights", ComputedHeights),
        ("/v1/histories/1.5/-0.5/falls?tolerance=0.1", ComputedFalls),
        (f"{LIBRARY}/windows", WindowsAnswer),
        (f"{LIBRARY}/transitions", TransitionsPage),
        (f"{LIBRARY}/network", NetworkSummary),
        (f"{LIBRARY}/network?format=node-link", NodeLinkNetwork),
        (f"{LIBRARY}/network/formations", FormationsAnswer),
        (f"{LIBRARY}/network/formations/{key}", NodeAnswer),
        (f"{LIBRARY}/network/paths?from={key}", PathAnswer),
        (f"{LIBRARY}/network/locate?contacts=3", LocationAnswer),
    ]
    for path, schema in answers:
        document = _json(network_client, path)
        assert schema.model_validate(document).model_dump(mode="json", by_alias=True) == document, path


def test_states_have_the_labels_of_their_interval(network_client: TestClient) -> None:
    for interval in _intervals(network_client):
        if interval["formation"]["class"] is None or interval["end"] - interval["start"] < 1e-3:
            continue
        state = solve_pose(PAIR, 0.0, -3.0, 0.5 * (interval["start"] + interval["end"]) % 360.0)
        assert state.state_class == interval["formation"]["class"]
        assert [contact.features for contact in state.contacts] == [
            contact["features"] for contact in interval["formation"]["contacts"]
        ]
        assert state.poses[0].translation[2] == interval["first_height"]


def test_heights_stored_and_solved_are_those_computed(network_client: TestClient) -> None:
    stored = _json(network_client, f"{LIBRARY}/histories/0/-3/heights")["heights"]
    assert stored == _json(network_client, "/v1/histories/0/-3/heights")["heights"]
    first = dict(zip(stored["phases"], stored["first_heights"], strict=True))
    rest = dict(zip(stored["phases"], stored["rest_heights"], strict=True))
    for boundary in _json(network_client, f"{LIBRARY}/histories/0/-3/intervals")["history"]["boundaries"]:
        for phase, side in ((boundary["low"], 0), (boundary["high"], 1)):
            assert first[phase] == boundary["first_height"][side]
            assert rest[phase] in (None, boundary["last_height"][side])
    assert {height is None for height in stored["rest_heights"]} == {True, False}
    millimetres = _json(network_client, f"{LIBRARY}/histories/0/-3/heights?unit=mm")["heights"]
    assert millimetres["first_heights"] == [25.4 * height for height in stored["first_heights"]]
    assert millimetres["tolerance"] == pytest.approx(25.4 * stored["tolerance"], rel=1e-12)


def test_the_snap_of_pitch_minus_three(network_client: TestClient) -> None:
    answer = _json(network_client, f"{LIBRARY}/windows?roll=0&pitch=-3")
    (orientation,) = answer["orientations"]
    snap = orientation["snap"]
    assert set(snap) == {"from", "to", "fall", "steepest", "steepest_from", "jump", "jump_at"}
    assert (round(snap["fall"], 4), round(snap["jump"], 4)) == (0.0089, 0.0062)
    assert 356.0 < snap["from"] < snap["jump_at"] <= snap["to"] < 358.0
    assert snap["fall"] >= snap["steepest"] == orientation["steepest"] >= snap["jump"]
    (descent,) = [one for one in orientation["descents"] if one["from"] == snap["from"]]
    assert (descent["to"], descent["fall"]) == (snap["to"], snap["fall"])
    assert max(jump["fall"] for jump in descent["jumps"]) == snap["jump"]
    history = _json(network_client, f"{LIBRARY}/histories/0/-3/intervals")["history"]
    assert {name: history[name] for name in orientation} == orientation
    millimetres = _json(network_client, f"{LIBRARY}/windows?roll=0&pitch=-3&unit=mm")["orientations"][0]
    assert millimetres["snap"]["fall"] == pytest.approx(25.4 * snap["fall"], rel=1e-12)
    assert millimetres["windows"][0]["enter"] == orientation["windows"][0]["enter"]


def test_what_counts_as_a_snap_can_be_chosen(network_client: TestClient) -> None:
    for least, snaps in ((0.0, 9), (0.17, 1), (1.0, 0)):
        found = _json(network_client, f"{LIBRARY}/windows?least={least}")["orientations"]
        assert len(found) == GRID.orientation_count
        assert sum(one["snap"] is not None for one in found) == snaps, least
        assert all(one["snap"] is None or one["steepest"] > least * PAIR.thread_pitch for one in found)


def test_falls_of_any_tilt_are_those_of_its_history(network_client: TestClient) -> None:
    falls = _json(network_client, "/v1/histories/0/-3/falls?library=latest")
    (stored,) = _json(network_client, f"{LIBRARY}/windows?roll=0&pitch=-3")["orientations"]
    assert falls["falls"] == {name: stored[name] for name in falls["falls"]}
    assert falls["range"] is None
    narrow = _json(network_client, "/v1/histories/0/-3/falls?span=0.2&least=0")["falls"]
    assert narrow["steepest"] < falls["falls"]["steepest"]
    assert narrow["snap"]["fall"] == falls["falls"]["snap"]["fall"]


@pytest.mark.slow
def test_a_tolerance_of_the_angles_gives_a_range(network_client: TestClient) -> None:
    within = _json(network_client, "/v1/histories/2.5/-1.2/falls?tolerance=0.3")
    centre, found = within["falls"], within["range"]
    assert (found["tilts"], found["snaps"]) == (9, 6)
    corner = _json(network_client, "/v1/histories/2.8/-1.5/falls")["falls"]
    for one in (centre, corner):
        for name in ("fall", "jump"):
            low, high = found[name]
            assert low <= one["snap"][name] <= high, name
        low, high = found["steepest"]
        assert low <= one["steepest"] <= high
        low, high = found["snap_from"]
        assert low <= one["snap"]["from"] <= high
    assert found["steepest"][0] < 0.05 * PAIR.thread_pitch < found["fall"][0] < found["fall"][1]


@pytest.mark.parametrize(
    ("query", "name"),
    [("tolerance=0", "tolerance"), ("tolerance=3", "tolerance"), ("steps=4&tolerance=1", "steps"), ("span=0", "span")],
)
def test_a_range_that_cannot_be_asked_for_is_refused(network_client: TestClient, query: str, name: str) -> None:
    response = network_client.get(f"/v1/histories/0/-3/falls?{query}")
    assert response.status_code == 400
    assert name in response.text


def test_a_tolerance_beyond_the_tilts_of_the_solver_is_refused(network_client: TestClient) -> None:
    response = network_client.get("/v1/histories/9.9/0/falls?tolerance=0.3")
    assert response.status_code == 400
    assert "9.9 +- 0.3" in response.text


def test_pages_of_transitions_hold_each_once(network_client: TestClient) -> None:
    path = f"{LIBRARY}/transitions?roll=0&pitch=-3&limit=17"
    walked: list[Any] = []
    while path:
        page = _json(network_client, path)
        walked += page["transitions"]
        path = page["next"]
    assert len(walked) == page["count"]
    assert len({json.dumps(one) for one in walked}) == len(walked)
    turns = [one for one in walked if one["move"] == "ccw"]
    boundaries = _json(network_client, f"{LIBRARY}/histories/0/-3/intervals")["history"]["boundaries"]
    assert [one["phase"] for one in turns] == pytest.approx([one["phase"] for one in boundaries], abs=1e-9)
    assert [one["first_height"] for one in turns] == [one["first_height"] for one in boundaries]


def test_a_turn_back_is_the_turn_reversed(network_client: TestClient) -> None:
    forth, back = (
        _json(network_client, f"{LIBRARY}/transitions?roll=0&pitch=-3&limit=100&move={move}")["transitions"]
        for move in ("ccw", "cw")
    )
    by_phase = {one["phase"]: one for one in back}
    for one in forth:
        other = by_phase[one["phase"]]
        assert (other["source"], other["target"]) == (one["target"], one["source"])
        assert other["first_height"] == one["first_height"][::-1]
        assert [(c["before"], c["after"]) for c in other["changes"]] == [
            (c["after"], c["before"]) for c in one["changes"]
        ]


def test_filters_of_transitions_keep_what_they_say(network_client: TestClient) -> None:
    for query, holds in (
        ("move=roll%2B", lambda one: one["move"] == "roll+"),
        ("roll=3", lambda one: one["source"]["roll"] == 3.0),
        ("class=stable_three_point", lambda one: one["source"]["class"] == "stable_three_point"),
        ("change=lost", lambda one: "lost" in one["text"]),
        ("move=ccw&phase_min=100&phase_max=200", lambda one: 100.0 <= one["phase"] <= 200.0),
    ):
        page = _json(network_client, f"{LIBRARY}/transitions?limit=100&{query}")
        assert page["transitions"], query
        assert all(holds(one) for one in page["transitions"]), query


def test_a_tilt_has_heights_and_normals_on_both_sides(network_client: TestClient) -> None:
    page = _json(network_client, f"{LIBRARY}/transitions?move=pitch%2B&change=class&limit=20")
    told = [one for one in page["transitions"] if one["phase_end"] - one["phase"] > 0.1]
    assert told
    for one in told:
        middle = 0.5 * (one["phase"] + one["phase_end"]) % 360.0
        for place, height in zip((one["source"], one["target"]), one["first_height"], strict=True):
            assert height == solve_pose(PAIR, place["roll"], place["pitch"], middle).poses[0].translation[2]
        assert one["changes"]
        assert all(change["before"] or change["after"] for change in one["changes"])


def test_the_network_is_exported_whole(network_client: TestClient) -> None:
    summary = _json(network_client, f"{LIBRARY}/network")["network"]
    node_link = _json(network_client, f"{LIBRARY}/network?format=node-link")
    assert (len(node_link["nodes"]), len(node_link["edges"])) == (summary["formations"], summary["edges"])
    graphml = network_client.get(f"{LIBRARY}/network?format=graphml")
    assert graphml.headers["Content-Type"] == "application/graphml+xml"
    space = "{http://graphml.graphdrawing.org/xmlns}"
    assert len(list(ET.fromstring(graphml.text).iter(f"{space}node"))) == summary["formations"]
    dot = network_client.get(f"{LIBRARY}/network?format=dot").text
    assert dot.count(" -> ") == summary["edges"]


def test_the_list_of_formations_says_the_same_as_each(network_client: TestClient) -> None:
    listed = _json(network_client, f"{LIBRARY}/network/formations")["formations"]
    assert len(listed) == _json(network_client, f"{LIBRARY}/network")["network"]["formations"]
    for one in listed[::7]:
        node = _json(network_client, f"{LIBRARY}/network/formations/{one['key']}")["node"]
        assert {name: node[name] for name in ("share", "window_share", "orientations", "to_window")} == {
            name: one[name] for name in ("share", "window_share", "orientations", "to_window")
        }
        assert (one["class"], one["contacts"]) == (node["formation"]["class"], len(node["formation"]["contacts"]))
    assert sum(one["share"] for one in listed) == pytest.approx(1.0)


def test_a_formation_a_path_and_a_location_belong_together(network_client: TestClient) -> None:
    key = _key(network_client)
    node = _json(network_client, f"{LIBRARY}/network/formations/{key}")["node"]
    assert sum(one["end"] - one["start"] for one in node["occurrences"]) == pytest.approx(node["cover"])
    path = _json(network_client, f"{LIBRARY}/network/paths?from={key}&roll=0&pitch=-3")["path"]
    assert path["steps"][0]["formation"] == key
    assert path["steps"][-1]["in_window"]
    assert all(one["move"] == "ccw" for one in path["steps"][1:])
    first = node["formation"]["contacts"][0]
    seen = f"1:{first['bolt_region']}:{first['nut_region']}:{first['features']}"
    location = _json(network_client, f"{LIBRARY}/network/locate?contact={seen}&class={node['formation']['class']}")
    stretches = location["location"]["stretches"]
    for one in node["occurrences"]:
        assert any(
            (left["roll"], left["pitch"]) == (one["roll"], one["pitch"])
            and any(left["start"] <= one["start"] + turn and one["end"] + turn <= left["end"] for turn in (0.0, 360.0))
            for left in stretches
        )


@pytest.mark.parametrize(
    ("path", "status"),
    [
        (f"{LIBRARY}/histories/1/0/intervals", 404),
        (f"{LIBRARY}/histories/1/0/heights", 404),
        (f"{LIBRARY}/network/formations/0123456789", 404),
        (f"{LIBRARY}/network/formations/short", 400),
        (f"{LIBRARY}/network/paths", 400),
        (f"{LIBRARY}/network/paths?from=0123456789", 404),
        (f"{LIBRARY}/network/paths?from=0123456789&moves=sideways", 400),
        (f"{LIBRARY}/network/locate?contact=5", 400),
        (f"{LIBRARY}/network/locate?contact=1:valley", 400),
        (f"{LIBRARY}/transitions?phase_min=2&phase_max=1", 400),
        (f"{LIBRARY}/transitions?limit=101", 400),
        (f"{LIBRARY}/transitions?colour=red", 400),
        ("/v1/histories/11/0/intervals", 400),
        ("/v1/histories/1/0/intervals?designation=M99", 400),
        ("/v1/histories/1/0/intervals?designation=1/4-20 UNC&library=1", 400),
        ("/v1/histories/1/0/heights?library=99", 404),
    ],
)
def test_what_is_wrong_is_said(network_client: TestClient, path: str, status: int) -> None:
    response = network_client.get(path)
    assert response.status_code == status, response.text
    assert response.headers["Content-Type"] == "application/problem+json"


@pytest.mark.slow
def test_histories_off_the_grid_are_of_a_librarys_own_pair_and_tolerances(own_client: TestClient) -> None:
    found = computed_history(OWN_PAIR, -4.0, 1.5, OWN_OPTIONS)
    intervals = _json(own_client, "/v1/histories/-4/1.5/intervals?library=m6x1")
    assert ComputedIntervals.model_validate(intervals) == ComputedIntervals(
        designation="M6x1",
        source=None,
        library=1,
        unit=OWN_PAIR.unit,
        history=history_document(found, -4.0, 1.5, OWN_PAIR, 1.0),
    )
    curve = computed_heights(OWN_PAIR, -4.0, 1.5, OWN_OPTIONS)
    heights = _json(own_client, "/v1/histories/-4/1.5/heights?library=1")
    assert ComputedHeights.model_validate(heights) == ComputedHeights(
        designation="M6x1",
        source=None,
        library=1,
        unit=OWN_PAIR.unit,
        heights=heights_document(curve, -4.0, 1.5, OWN_PAIR.thread_pitch, 1.0),
    )


def test_the_heights_of_a_library_are_solved_with_its_own_tolerances(own_client: TestClient) -> None:
    stored = _json(own_client, f"{LIBRARY}/histories/-4/0/heights")["heights"]
    assert stored == _json(own_client, "/v1/histories/-4/0/heights?library=1")["heights"]


def test_a_path_needs_both_angles_of_an_orientation(network_client: TestClient) -> None:
    key = _key(network_client)
    response = network_client.get(f"{LIBRARY}/network/paths?from={key}&roll=0")
    assert response.status_code == 400
    assert "roll and pitch" in response.text


def test_a_library_without_histories_says_so(client: TestClient) -> None:
    response = client.get(f"{LIBRARY}/windows")
    assert response.status_code == 404
    assert "no histories" in response.text


def test_what_follows_is_told_by_its_class_and_by_what_changes(network_client: TestClient) -> None:
    node = _json(network_client, f"{LIBRARY}/network/formations/{_key(network_client)}")["node"]
    assert node["following"]
    for one in node["following"]:
        other = _json(network_client, f"{LIBRARY}/network/formations/{one['formation']}")["node"]["formation"]
        assert one["class"] == other["class"]
        same_class, same_contacts = (
            other["class"] == node["formation"]["class"],
            other["contacts"] == node["formation"]["contacts"],
        )
        assert ("contact" in one["change"]) is not same_contacts
        assert (" to " in one["change"].partition(";")[0] and not one["change"].startswith("contact")) is not same_class


UNDER = "mu=0.15&force=0.1,0,-10&unit=mm"
LOADED = ["--mu=0.15", "--force=0.1,0,-10", "--unit=mm"]


def _printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> list[Any]:
    capsys.readouterr()
    assert run_command_line([*arguments, "--json"]) == 0
    return [json.loads(line) for line in capsys.readouterr().out.splitlines()]


@pytest.fixture
def solved_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """The cells of an orientation under a load are solved once, whether the service or a command asks."""
    solve = LoadedNetwork.parts
    solved: dict[Any, list[list[Part]]] = {}

    def parts(network: LoadedNetwork, orientation: int) -> list[list[Part]]:
        key = network.pair, network.options, network.load, network.mu, orientation
        if key not in solved:
            solved[key] = solve(network, orientation)
        return solved[key]

    monkeypatch.setattr(LoadedNetwork, "parts", parts)


@pytest.mark.slow
@pytest.mark.usefixtures("solved_once")
def test_under_a_load_it_answers_as_the_command_line(
    network_client: TestClient, network_database: str, capsys: pytest.CaptureFixture[str]
) -> None:
    where = [*LOADED, f"--database={network_database}"]
    held = _json(network_client, f"{LIBRARY}/histories/0/-3/held?{UNDER.replace('0.15', '0.1,0.15')}")["held"]
    tilt = ["--roll=0", "--pitch=-3", "--library=latest"]
    printed_held = _printed(capsys, "held", *tilt, *where, "--mu=0.1,0.15")
    assert [{**one, "source": source_of(quarter_twenty_unc())} for one in held] == printed_held
    assert {one["verdict"] for one in held[1]["stretches"]} == {"moves", "can_stay"}
    summary = _json(network_client, f"{LIBRARY}/network/loaded?{UNDER}&avoid=held,wedged")["network"]
    assert [summary] == _printed(capsys, "network", *where, "--avoid=held,wedged")
    page = _json(network_client, f"{LIBRARY}/transitions?roll=0&pitch=-3&move=ccw&limit=30&{UNDER}")["transitions"]
    printed = _printed(capsys, "transitions", "--roll=0", "--pitch=-3", "--move=ccw", "--limit=30", *where)
    assert [{"unit": "mm", **one} for one in page] == printed
    assert {one["mark"] for one in page} == {"free", "held"}
    located = _json(network_client, f"{LIBRARY}/network/locate?verdict=can_stay&{UNDER}")["location"]
    assert [located] == _printed(capsys, "locate", "--verdict=can_stay", *where)
    key = _key(network_client)
    free, avoiding = (
        _json(network_client, f"{LIBRARY}/network/paths?from={key}&{query}")["path"]
        for query in (UNDER, f"{UNDER}&avoid=held,wedged")
    )
    assert free is not None
    assert free != avoiding
    (path,) = _printed(capsys, "path", f"--from={key}", "--avoid=held,wedged", *where)
    assert path == (None if avoiding is None else {"unit": "mm", **avoiding})


@pytest.mark.slow
def test_any_orientation_is_held_as_a_stored_one(network_client: TestClient) -> None:
    stored = _json(network_client, f"{LIBRARY}/histories/0/-3/held?mu=0.15")["held"]
    computed = _json(network_client, "/v1/histories/0/-3/held?mu=0.15&library=latest")
    assert (computed["designation"], computed["library"]) == ("1/4-20 UNC", 1)
    assert computed["held"] == stored


@pytest.mark.parametrize(
    ("path", "location", "valid"),
    [
        ("transitions?force=0,0,-10", "force", "with mu"),
        ("network/paths?from=0123456789&avoid=held", "avoid", "with mu"),
        ("network/paths?from=0123456789&mu=0.1&avoid=stuck", "avoid", "free, held, wedged, undecided"),
        ("network/locate?verdict=moves", "verdict, mu", "both or none"),
        ("network/locate?contacts=3&mu=0.1", "verdict, mu", "both or none"),
        ("network/loaded?mu=-1", "query mu", "greater than or equal to 0"),
        ("histories/0/-3/held?mu=0.1,-1", "mu", ">= 0"),
        ("histories/0/-3/held?mu=0.1,x", "mu", "separated by commas"),
        ("histories/0/-3/held?force=0,0,0", "force", "not zero"),
    ],
)
def test_a_bad_load_is_named(network_client: TestClient, path: str, location: str, valid: str) -> None:
    (error,) = problem(network_client.get(f"{LIBRARY}/{path}"), 400).errors
    assert error.location == location
    assert valid in error.valid
