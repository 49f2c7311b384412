"""No number of a request is read by a syntax of Python's own."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any, get_args

import pytest
from fastapi.dependencies.utils import get_flat_params
from fastapi.routing import APIRoute
from fastapi.testclient import TestClient
from pydantic import TypeAdapter, ValidationError

from service.app import create_app
from tests.service.test_problems import problem
from threadstate.settings import DATABASE, read_settings

pytestmark = pytest.mark.sqlite_alone

ODD = ["1_0", " 1", "1 ", "nan", "infinity", "٣", "1\N{NO-BREAK SPACE}", "0x1"]


def _routes(routes: list[Any]) -> Iterator[APIRoute]:
    for route in routes:
        if isinstance(route, APIRoute):
            yield route
        else:
            yield from _routes(route.original_router.routes)


def _is_number(annotation: Any) -> bool:
    return annotation in (int, float) or any(_is_number(one) for one in get_args(annotation))


def _fields() -> Iterator[Any]:
    """Every parameter that is a number, with its route."""
    for route in _routes(create_app(read_settings({DATABASE: "sqlite:////nowhere"})).routes):
        for field in get_flat_params(route.dependant):
            if _is_number(field.field_info.annotation):
                yield pytest.param(field.field_info, id=f"{route.path} {field.alias}")


@pytest.mark.parametrize("field", list(_fields()))
def test_every_parameter_refuses_an_odd_number(field: Any) -> None:
    for text in ODD:
        assert _faults(field, text) in ({"float_parsing"}, {"int_parsing"}), text
    assert not _faults(field, "3") & {"float_parsing", "int_parsing"}


def _faults(field: Any, text: str) -> set[str]:
    """What is wrong with a text as that parameter."""
    adapter: TypeAdapter[Any] = TypeAdapter(field.rebuild_annotation())
    try:
        adapter.validate_python(text)
    except ValidationError as error:
        return {one["type"] for one in error.errors()}
    return set()


@pytest.mark.parametrize("text", ODD)
def test_an_odd_number_is_refused_by_its_place_and_text(client: TestClient, text: str) -> None:
    for place, response in (
        ("query roll", client.get("/v1/libraries/1/states", params={"roll": text})),
        ("query limit", client.get("/v1/libraries/1/states", params={"limit": text})),
        ("path pitch", client.get(f"/v1/libraries/1/states/0/{text}/30")),
        ("path id", client.get(f"/v1/jobs/{text}")),
    ):
        refused = problem(response, 400)
        assert refused.type.endswith(":invalid-value")
        assert f"{place} is {text!r}" in refused.detail


def test_limits_are_described(client: TestClient) -> None:
    """They are not where they come after a check of the text."""
    assert re.findall(r'"(?:ge|gt|le|lt)":', client.get("/openapi.json").text) == []


def test_a_body_has_numbers_and_no_texts_of_them(client: TestClient) -> None:
    pose = '{"roll": %s, "pitch": 0, "phase": 0}'
    for text in ('"1"', "1_0", "NaN", "+1", "01", ".5", "1e999"):
        problem(client.post("/v1/solve", content='{"poses": [' + pose % text + "]}"), 400)
