"""Whatever is read from a library is answered with the same bytes from SQLite and from PostgreSQL.

The other tests of the service read SQLite, so that each question is asked of PostgreSQL here.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from fastapi.testclient import TestClient

from harness.databases import Databases
from tests.service.conftest import client_of, store_library
from tests.service.made_up_states import made_up_states
from tests.service.settled_library import store_settled
from tests.service.success_map import store_success_map
from tests.stored_histories.history_library import SMALL_GRID, histories_of_grid, store_histories
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Clients = tuple[TestClient, TestClient]

MADE_UP, WITH_HISTORIES = "/v1/libraries/1", "/v1/libraries/2"
OF_ONE_ANSWER = re.compile(r"\d{4}-\d\d-\d\dT[\d:.]+Z|urn:threadstate:request:\w+")
READ = {
    "/v1/success-maps": ["/v1/success-maps", "/v1/success-maps?library=1", "/v1/success-maps?library=9"],
    "/v1/success-maps/{id}": ["/v1/success-maps/latest", "/v1/success-maps/1", "/v1/success-maps/9"],
    "/v1/success-maps/{id}/orientations": [
        "/v1/success-maps/1/orientations?unit=mm",
        "/v1/success-maps/1/orientations?limit=4&after=3",
    ],
    "/v1/success-maps/{id}/orientations/{roll}/{pitch}": [
        f"/v1/success-maps/latest/orientations/{tilt}" for tilt in ("0/0", "-1/1?unit=mm", "9/9")
    ],
    "/v1/libraries": ["/v1/libraries", "/v1/libraries?unit=mm"],
    "/v1/libraries/{id}": [MADE_UP, WITH_HISTORIES, "/v1/libraries/1-4-20-unc", "/v1/libraries/3"],
    "/v1/building": ["/v1/building"],
    "/v1/libraries/{id}/states": [
        f"{MADE_UP}/states?{query}"
        for query in (
            "",
            "unit=mm&fields=class,first_height",
            "roll=1",
            "pitch=-1&phase=30",
            "phase_min=300&phase_max=60",
            "class=stable_three_point,unstable_two_point",
            "bolt_region=crest&nut_region=surface",
            "flag=tie",
            "roll=7",
            "limit=5&cursor=AAAA",
        )
    ],
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/statics": [
        f"{WITH_HISTORIES}/states/{pose}/statics?mu=0.1" for pose in ("0/-3/180", "3/3/0", "9/9/0")
    ],
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}/jamming": [f"{WITH_HISTORIES}/states/0/-3/180/jamming"],
    "/v1/libraries/{id}/states/{roll}/{pitch}/{phase}": [
        f"{MADE_UP}/states/{pose}" for pose in ("0/0/0", "-1/1/330?unit=mm", "1/1/5", "9/9/0")
    ],
    "/v1/libraries/{id}/orientations": [f"{MADE_UP}/orientations", f"{WITH_HISTORIES}/orientations?unit=mm"],
    "/v1/compare": [f"/v1/compare?libraries={WITH_HISTORIES.rpartition('/')[2]},latest", "/v1/compare?libraries=,"],
    "/v1/libraries/{id}/histories/{roll}/{pitch}": [
        f"{MADE_UP}/histories/{tilt}" for tilt in ("0/0", "1/-1?format=frames", "1/1?unit=mm", "3/3")
    ],
    "/v1/libraries/{id}/undecided": [f"{MADE_UP}/undecided", f"{MADE_UP}/undecided?limit=1&after=2"],
    "/v1/libraries/{id}/export/{table}.{format}": [
        *(f"{MADE_UP}/export/{table}.ndjson" for table in ("states", "undecided")),
        *(f"{WITH_HISTORIES}/export/{table}.csv?unit=mm" for table in ("states", "intervals")),
    ],
    "/v1/libraries/{id}/histories/{roll}/{pitch}/intervals": [
        f"{WITH_HISTORIES}/histories/{tilt}/intervals" for tilt in ("0/-3", "3/3?unit=mm", "-3/0")
    ],
    "/v1/libraries/{id}/histories/{roll}/{pitch}/heights": [f"{WITH_HISTORIES}/histories/0/-3/heights"],
    "/v1/libraries/{id}/histories/{roll}/{pitch}/held": [f"{WITH_HISTORIES}/histories/0/-3/held?mu=0.15"],
    "/v1/libraries/{id}/transitions": [
        f"{WITH_HISTORIES}/transitions?limit=20&{query}"
        for query in (
            "",
            "move=ccw&roll=0&pitch=-3",
            "phase_min=300&phase_max=60&after=3",
            "change=appears&class=stable_three_point",
        )
    ],
    "/v1/libraries/{id}/windows": [f"{WITH_HISTORIES}/windows", f"{WITH_HISTORIES}/windows?roll=0&pitch=-3&unit=mm"],
    "/v1/libraries/{id}/network": [f"{WITH_HISTORIES}/network", f"{WITH_HISTORIES}/network?format=graphml"],
    "/v1/libraries/{id}/network/loaded": [f"{WITH_HISTORIES}/network/loaded?mu=0.15&avoid=held"],
    "/v1/libraries/{id}/network/formations": [f"{WITH_HISTORIES}/network/formations"],
    "/v1/settled": ["/v1/settled"],
    "/v1/settled/{id}": ["/v1/settled/1", "/v1/settled/latest", "/v1/settled/2"],
    "/v1/settled/{id}/states": [
        f"/v1/settled/1/states?{query}"
        for query in ("", "unit=mm&limit=3", "flag=flush", "contacts=2&falls=0", "outcome=settled&phase_min=90&after=0")
    ],
    "/v1/settled/{id}/states/{roll}/{pitch}/{phase}": [
        f"/v1/settled/latest/states/0/0/{phase}" for phase in ("0", "180?unit=mm", "7")
    ],
    "/v1/libraries/{id}/network/locate": [f"{WITH_HISTORIES}/network/locate?class=stable_three_point&contacts=3"],
}
ELSEWHERE = {
    "/v1/libraries/{id}/network/formations/{key}",
    "/v1/libraries/{id}/network/paths",
    "/v1/libraries/{id}/meshes/{part}",
    "/v1/jobs",
    "/v1/jobs/{id}",
    "/v1/jobs/{id}/events",
    "/v1/jobs/{id}/success-map",
}
"""A formation and paths have a test below; a mesh is made of the pair that the library's entry shows; jobs are tested
on both kinds in ``tests/jobs``."""


@pytest.fixture(scope="module")
def clients(sqlite_databases: Databases, postgresql_databases: Databases) -> Iterator[Clients]:
    """Clients of two services over the same content: made-up states, histories, settled states and a success map."""
    urls = [databases.migrated() for databases in (sqlite_databases, postgresql_databases)]
    for url in urls:
        store_library(url, quarter_twenty_unc(), Grid(1.0, 1.0, 30.0), made_up_states)
        store_histories(url, SMALL_GRID, histories_of_grid(SMALL_GRID))
        store_settled(url)
        store_success_map(url)
    with client_of(urls[0]) as one, client_of(urls[1]) as other:
        yield one, other


def same_answer(clients: Clients, address: str) -> str:
    """The body, which both services answer with, apart from what each answer has of its own."""
    one, other = (client.get(address) for client in clients)
    assert one.status_code == other.status_code, address
    texts = [OF_ONE_ANSWER.sub("", response.text) for response in (one, other)]
    assert texts[0] == texts[1], address
    assert one.status_code < 500
    return texts[0]


@pytest.mark.parametrize("path", READ)
def test_an_answer_is_the_same_from_either_kind(clients: Clients, path: str) -> None:
    answers = [same_answer(clients, address) for address in READ[path]]
    assert len(answers[0]) > 2


def test_pages_in_every_order_are_the_same_from_either_kind(clients: Clients) -> None:
    states = clients[0].get("/openapi.json").json()["paths"]["/v1/libraries/{id}/states"]["get"]
    (sorts,) = (one["schema"]["enum"] for one in states["parameters"] if one["name"] == "sort")
    assert len(sorts) > 10
    for sort in sorts:
        address, pages = f"{MADE_UP}/states?limit=40&sort={sort}", 0
        while address:
            following = re.search(r'"next":"([^"]+)"', same_answer(clients, address))
            address, pages = following[1] if following else "", pages + 1
        assert pages == 3


def test_a_formation_and_its_paths_are_the_same_from_either_kind(clients: Clients) -> None:
    keys = re.findall(r'"key":"(\w+)"', same_answer(clients, f"{WITH_HISTORIES}/network/formations"))
    for key in keys[:3]:
        same_answer(clients, f"{WITH_HISTORIES}/network/formations/{key}")
        same_answer(clients, f"{WITH_HISTORIES}/network/paths?from={key}")


def test_no_question_of_a_library_is_left_out(clients: Clients) -> None:
    paths = clients[0].get("/openapi.json").json()["paths"]
    elsewhere = ("/v1/histories", "/v1/states", "/v1/threads")
    read = {path for path, methods in paths.items() if "get" in methods and not path.startswith(elsewhere)}
    assert read - {"/healthz", "/readyz"} == set(READ) | ELSEWHERE
