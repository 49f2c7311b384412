"""The client against the service's own description: neither can change without the other."""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable, Iterator
from types import ModuleType
from typing import Any, cast

import pytest
from pydantic import BaseModel, TypeAdapter

from service.jobs.schemas import EventDocument
from tests.test_architecture import modules_loaded_by
from threadstate.client import AsyncClient, Client
from threadstate.client.call import Call, PagedCall
from threadstate.client.calls import jobs, libraries, network, settled, states, statics, success, threads
from threadstate.client.loads import LoadToBear
from threadstate.client.models import assemblies as assembly_models
from threadstate.client.models import jobs as job_models
from threadstate.client.models import libraries as library_models
from threadstate.client.models import network as network_models
from threadstate.client.models import service as service_models
from threadstate.client.models import settled as settled_models
from threadstate.client.models import states as state_models
from threadstate.client.models import statics as statics_models
from threadstate.client.models import success as success_models
from threadstate.client.models import threads as thread_models
from threadstate.client.models.answer import Answer
from threadstate.device.assembly_document import AssemblyProgressDocument

CALLS = (jobs, libraries, network, settled, states, statics, success, threads)
MODELS = (
    *(job_models, library_models, network_models, service_models),
    *(assembly_models, settled_models, state_models, statics_models, success_models, thread_models),
)
RENAMED = {
    name: f"{name}Document"
    for name in (
        *("State", "Pose", "Contact", "Margins", "StoredStatics", "Load", "ContactForce", "Reaction", "NormalRange"),
        *("Deviation", "SettledContact", "Fall", "SettledMargins", "Settled", "Device", "SettledCounts"),
        "SettledLibrary",
        *("Assembly", "AssemblyEvent", "AssemblyPath", "AssemblyEnergy", "AssemblyMargins", "AssemblyTravel"),
        "AssemblyProgress",
        *("Cell", "PhaseBoundary", "CriticalFriction", "PhaseSummary", "SummarisedOrientation", "FrictionTotals"),
        "SuccessMap",
        *("Twist", "LoadedContact", "Piece", "Jamming", "ComputedJamming", "ContactWrench", "Limits", "StandardThread"),
    )
} | {
    "LibraryState": "ChosenFields",
    "Statics": "RequestedStaticsDocument",
    "ContactMode": "ModeDocument",
    "PathOutcome": "OutcomeDocument",
}
"""Models that go by a shorter name than the service's."""

ARGUMENTS: dict[str, object] = {
    "roll": 1.0,
    "pitch": -2.0,
    "phase": 3.0,
    "library": 7,
    "settled_library": 7,
    "success_map": 7,
    "phase_tolerance": 2.0,
    "mu_tolerance": 0.01,
    "point_limit": 500,
    "time_limit": 5.0,
    "falls": 1,
    "libraries": [7, "m6"],
    "part": "bolt",
    "key": "0123456789",
    "source": "0123456789",
    "target": "abcdef0123",
    "job_id": 5,
    "table": "states",
    "file_format": "csv",
    "poses": [(1.0, 2.0, 3.0)],
    "device": {"unit": "mm", "push": 5.0},
    "grid": {"phase_step": 5.0},
    "tolerances": {"tie_tolerance": 1e-11},
    "mesh": {"checked": True},
    "moves": ["ccw", "roll+"],
    "contact": ["1:crest", "2:*:base"],
    "contacts": 3,
    "ordered": True,
    "limit": 10,
    "mu": 0.1,
    "longest_step": 0.5,
    "confirm": True,
    "include": ["reaction", "forces_range"],
    "avoid": ["held", "wedged"],
    "force": (0.0, 0.0, -10.0),
    "moment": (0.0, 0.5, 0.0),
    "point": (0.0, 0.0, 0.1),
    "loads": [{"force": (0.0, 0.0, -10.0), "moment": (0.0, 0.5, 0.0), "point": (0.0, 0.0, 0.1), "mu": 0.1}],
}
"""A value for every argument that is no text."""
OF_A_DIAGRAM: dict[str, object] = {"axes": ["mx", "my"], "contacts": [1, 2], "window": (2.0, 2.0), "tolerance": 1e-3}

OF_THE_CLIENT_ITSELF = {"cursor", "after", "before", "format", "fields"}
"""Parameters that the client fills in: of pages, of the shape that a model has."""


def _functions(module: ModuleType) -> Iterator[Callable[..., Any]]:
    for name, value in vars(module).items():
        if inspect.isfunction(value) and value.__module__ == module.__name__ and not name.startswith("_"):
            yield value


def _described(function: Callable[..., Any]) -> Call[object]:
    """The request of a function, given all the arguments that it takes."""
    known = ARGUMENTS | OF_A_DIAGRAM if "jamming" in function.__name__ else ARGUMENTS
    arguments = {name: known.get(name, "text") for name in inspect.signature(function).parameters}
    call = function(**arguments)
    return call.first if isinstance(call, PagedCall) else cast("Call[object]", call)


def _pattern(path: str) -> re.Pattern[str]:
    return re.compile(re.sub(r"\\\{\w+\\\}", "[^/]+?", re.escape(path)))


def _operation(openapi: dict[str, Any], call: Call[object]) -> tuple[str, str, dict[str, Any]]:
    """The most specific operation that a request is one of."""
    found = [
        (path, call.method.lower(), methods[call.method.lower()])
        for path, methods in openapi["paths"].items()
        if call.method.lower() in methods and _pattern(path).fullmatch(call.path)
    ]
    assert found, (call.method, call.path)
    return min(found, key=lambda one: one[0].count("{"))


DESCRIBED = [function for module in CALLS for function in _functions(module)]


def test_every_operation_has_a_method(openapi: dict[str, Any]) -> None:
    reached = {_operation(openapi, _described(function))[:2] for function in DESCRIBED}
    operations = {(path, method) for path, methods in openapi["paths"].items() for method in methods}
    assert operations - reached == set()


@pytest.mark.parametrize("function", DESCRIBED, ids=lambda function: function.__name__)
def test_a_method_asks_for_all_that_can_be_asked_and_for_nothing_else(
    openapi: dict[str, Any], function: Callable[..., Any]
) -> None:
    call = _described(function)
    _, _, operation = _operation(openapi, call)
    known = {one["name"] for one in operation.get("parameters", ()) if one["in"] == "query"}
    assert set(call.parameters) <= known
    assert known - OF_THE_CLIENT_ITSELF <= set(call.parameters)


def test_a_body_has_all_that_the_service_knows(openapi: dict[str, Any]) -> None:
    schemas = openapi["components"]["schemas"]
    for function, schema in (
        (jobs.ask, "JobRequest"),
        (states.solve, "SolveRequest"),
        (statics.solve_statics, "StaticsRequest"),
        (settled.settle, "SettleRequest"),
        (settled.assemble, "AssemblyRequest"),
    ):
        body = _described(function).body
        assert body is not None
        assert set(json.loads(body)) == set(schemas[schema]["properties"])
    assert set(LoadToBear.__annotations__) == set(schemas["LoadToBear"]["properties"])
    assert schemas["StaticsRequest"]["properties"]["loads"]["maxItems"] == statics.MOST_COMBINATIONS


def test_requests_that_write_are_those_that_may_be_repeated(openapi: dict[str, Any]) -> None:
    """A new one has to be thought about: the same job asked for, or cancelled, twice is the same as once."""
    writing = {(path, method) for path, methods in openapi["paths"].items() for method in methods if method != "get"}
    assert writing == {
        ("/v1/jobs", "post"),
        ("/v1/jobs/{id}", "delete"),
        ("/v1/settled", "post"),
        ("/v1/success-maps", "post"),
        ("/v1/solve", "post"),
        ("/v1/statics", "post"),
        ("/v1/settle", "post"),
        ("/v1/assemblies", "post"),
        ("/v1/outcomes", "post"),
    }


def test_both_clients_have_the_same_methods() -> None:
    def methods(client: type[object]) -> dict[str, list[str]]:
        return {
            name: list(inspect.signature(value).parameters)
            for name, value in vars(client).items()
            if inspect.isfunction(value) and not name.startswith("_")
        }

    assert methods(Client) == methods(AsyncClient)
    # A description of a job's own methods, or one that both clients have a method for.
    assert {function.__name__ for function in DESCRIBED} - {"cancel", "events"} <= set(methods(Client))


def test_help_shows_what_a_method_takes_and_returns() -> None:
    signature = inspect.signature(Client("http://127.0.0.1").state)
    assert list(signature.parameters) == ["roll", "pitch", "phase", "library", "unit"]
    assert signature.return_annotation == "State"
    assert inspect.signature(Client.states).return_annotation == "Items[LibraryState]"
    assert inspect.signature(AsyncClient.job).return_annotation == "AsyncJob"
    assert Client.state.__doc__ == states.state.__doc__


def _expanded(schema: Any, definitions: dict[str, Any]) -> Any:
    """A schema with what it refers to in place, and without words and bounds, which do not matter to a reader."""
    if isinstance(schema, list):
        return [_expanded(one, definitions) for one in schema]
    if not isinstance(schema, dict):
        return schema
    if "$ref" in schema:
        return _expanded(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    if "prefixItems" in schema:
        first, *others = schema["prefixItems"]
        assert all(one == first for one in others)
        return {"type": "array", "items": _expanded(first, definitions)}
    kept = {
        "type",
        "enum",
        "format",
        "items",
        "anyOf",
        "properties",
        "required",
        "additionalProperties",
        "propertyNames",
        "const",
    }
    plain = {name: value for name, value in schema.items() if name in kept}
    if "properties" in plain:
        plain["properties"] = {
            name: _expanded(value, definitions) for name, value in sorted(plain["properties"].items())
        }
        plain["required"] = sorted(plain.get("required", ()))
    return {
        name: _expanded(value, definitions) if name not in ("properties", "required", "enum") else value
        for name, value in plain.items()
    }


def _models() -> Iterator[type[BaseModel]]:
    for module in MODELS:
        for value in vars(module).values():
            if inspect.isclass(value) and issubclass(value, Answer) and value.__module__ == module.__name__:
                yield value


@pytest.mark.parametrize("model", list(_models()), ids=lambda model: model.__name__)
def test_models_are_what_the_service_describes(openapi: dict[str, Any], model: type[BaseModel]) -> None:
    # The data of an event stream is nothing that OpenAPI describes.
    event = EventDocument.model_json_schema()
    progress = TypeAdapter(AssemblyProgressDocument).json_schema(ref_template="#/components/schemas/{model}")
    components = {**openapi["components"]["schemas"], **event["$defs"], "EventDocument": event}
    components["AssemblyProgressDocument"] = progress
    # The client never asks for some of a state's fields, so that none is missing.
    chosen = components["ChosenFields"]
    components["ChosenFields"] = {**chosen, "required": list(chosen["properties"])}
    # What was not requested is None to a reader.
    statics = components["RequestedStaticsDocument"]
    properties = {
        name: value if name in statics["required"] or "anyOf" in value else {"anyOf": [value, {"type": "null"}]}
        for name, value in statics["properties"].items()
    }
    components["RequestedStaticsDocument"] = {**statics, "properties": properties}
    # A document that is sent may have nothing beside; one that is read may.
    device = components["DeviceDocument"]
    components["DeviceDocument"] = {name: value for name, value in device.items() if name != "additionalProperties"}
    told = components[RENAMED.get(model.__name__, model.__name__)]
    read = model.model_json_schema(mode="serialization")
    expected = _expanded(told, components)
    found = _expanded(read, read.get("$defs", {}))
    if model in (service_models.Problem, service_models.ProblemItem):
        # Of a problem alone a reader takes less than all that is promised: proxies have their own.
        expected.pop("required")
        found.pop("required")
    assert found == expected


def test_importing_the_client_loads_neither_service_nor_solver() -> None:
    loaded = modules_loaded_by("import threadstate.client")
    assert "threadstate.client._sync.client" in loaded
    heavy = {
        "fastapi",
        "starlette",
        "numba",
        "sqlalchemy",
        "scipy",
        "networkx",
        "pandas",
        "polars",
        "pyarrow",
        "service",
    }
    assert not heavy & {name.partition(".")[0] for name in loaded}
