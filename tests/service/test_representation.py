from __future__ import annotations

import pytest
from fastapi.testclient import TestClient

from tests.service.conftest import StoredLibrary
from threadstate.units import MILLIMETRES_PER_INCH

pytestmark = pytest.mark.sqlite_alone

RESOURCES = (
    "/v1/libraries",
    "/v1/libraries/latest",
    "/v1/libraries/latest/states",
    "/v1/libraries/latest/states/1/-1/30",
    "/v1/libraries/latest/orientations",
    "/v1/libraries/latest/meshes/nut",
    "/v1/libraries/latest/histories/1/-1",
    "/v1/libraries/latest/histories/1/-1?format=csv",
    "/v1/threads",
    "/v1/threads?search=M6",
    "/openapi.json",
    "/docs",
    "/docs/assets/swagger-ui.css",
    "/",
)


@pytest.mark.parametrize("path", RESOURCES)
def test_etag_is_strong_stable_and_answered_by_304(client: TestClient, path: str) -> None:
    first = client.get(path)
    etag = first.headers["ETag"]
    assert first.status_code == 200
    assert etag.startswith('"')
    assert client.get(path).headers["ETag"] == etag
    for sent in (etag, f"W/{etag}", f'"other", {etag}', "*"):
        again = client.get(path, headers={"If-None-Match": sent})
        assert again.status_code == 304
        assert again.content == b""
        assert again.headers["ETag"] == etag
        assert again.headers["Cache-Control"] == first.headers["Cache-Control"] == "public, no-cache"
    assert client.get(path, headers={"If-None-Match": '"other"'}).content == first.content


def test_each_representation_has_its_own_etag(client: TestClient) -> None:
    history = "/v1/libraries/latest/histories/1/-1"
    queries = ("", "?format=columns", "?format=csv", "?unit=mm", "?unit=mm&format=csv")
    assert len({client.get(history + query).headers["ETag"] for query in queries}) == len(queries)


@pytest.mark.parametrize("path", [*RESOURCES, "/healthz", "/readyz", "/nowhere"])
def test_head_is_get_without_content(client: TestClient, path: str) -> None:
    got, head = client.get(path), client.head(path)
    assert head.status_code == got.status_code
    for headers in (head.headers, got.headers):
        assert headers.pop("X-Request-ID")
    assert head.headers == got.headers
    assert head.content == b""


@pytest.mark.parametrize("path", [*RESOURCES, "/healthz", "/nowhere", "/v1/libraries?x=1"])
def test_every_answer_has_the_security_headers(client: TestClient, path: str) -> None:
    headers = client.get(path, follow_redirects=False).headers
    assert headers["Content-Security-Policy"].startswith("default-src 'self';")
    assert headers["X-Content-Type-Options"] == "nosniff"


def converted(document: object, name: str = "") -> object:
    """A state's document in inches with its lengths in millimetres."""
    angles_and_directions = ("roll", "pitch", "phase", "turns", "rotation", "normal", "stage")
    statics = ("support_margin", "mu_hold", "mu_wedge")
    if isinstance(document, dict):
        return {key: converted(value, key) for key, value in document.items()}
    if isinstance(document, list):
        return [converted(value, name) for value in document]
    if isinstance(document, float) and name not in (*angles_and_directions, *statics):
        return document * MILLIMETRES_PER_INCH
    return document


@pytest.mark.parametrize("resource", ["states", "histories/1/-1", "states/1/-1/30"])
def test_unit_converts_every_length_and_nothing_else(client: TestClient, resource: str) -> None:
    path = f"/v1/libraries/latest/{resource}"
    inches, millimetres = (client.get(path, params={"unit": unit}) for unit in ("in", "mm"))
    assert inches.headers["Length-Unit"] == "in"
    assert millimetres.headers["Length-Unit"] == "mm"
    of_default, of_inches, of_millimetres = client.get(path).json(), inches.json(), millimetres.json()
    if "states" in of_inches:
        assert (of_default["unit"], of_inches["unit"], of_millimetres["unit"]) == ("in", "in", "mm")
        of_default, of_inches, of_millimetres = (one["states"] for one in (of_default, of_inches, of_millimetres))
    assert of_millimetres == converted(of_inches)
    assert of_default == of_inches


def test_library_converts_its_dimensions(client: TestClient, made_up: StoredLibrary) -> None:
    document = client.get("/v1/libraries/latest?unit=mm").json()
    assert document["unit"] == document["pair"]["unit"] == "mm"
    assert document["stored_unit"] == "in"
    assert document["pair"]["thread_pitch"] == made_up.pair.thread_pitch * MILLIMETRES_PER_INCH
    assert document["pair"]["fit"]["bolt_major_diameter"] == made_up.pair.fit.bolt_major_diameter * MILLIMETRES_PER_INCH
    assert document["pair"]["form"]["bolt_root_fillet"] == made_up.pair.form.bolt_root_fillet
