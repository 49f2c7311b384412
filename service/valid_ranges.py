"""The valid range of a number, with both of its bounds: what is said of a refused one has the bound that it passes."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from threadstate.numbers import number_text

Schema = Mapping[str, Any]

BOUNDS = {
    "minimum": "greater than or equal to",
    "exclusiveMinimum": "greater than",
    "maximum": "less than or equal to",
    "exclusiveMaximum": "less than",
}
"""The keywords of JSON Schema that bound a number, in words."""


def valid_range(description: Schema, path: str, method: str, location: Sequence[Any]) -> str | None:
    """The valid range of the number at a place of a request, None where it has no bound.

    Args:
        description: the OpenAPI description.
        path: the path of the resource, as described.
        method: the method of the request.
        location: where the number is: ``query`` and a name, or ``body`` and the names and indices that lead there.
            Names that no schema has, as those that a validator gives to the types of a union, are passed over.
    """
    operation = description["paths"].get(path, {}).get(method.lower(), {})
    kind, *names = location
    if kind == "body":
        content = operation.get("requestBody", {}).get("content", {})
        schemas = [one["schema"] for one in content.values() if "schema" in one]
    else:
        name, *names = names
        schemas = [one["schema"] for one in operation.get("parameters", ()) if (one["in"], one["name"]) == (kind, name)]
    found = [one for schema in schemas for one in _alternatives(schema, description)]
    for name in names:
        inner = [one for schema in found for one in _inside(schema, name, description)]
        found = inner or found
    return next((text for schema in found if (text := _bounds(schema))), None)


def _alternatives(schema: Schema, description: Schema) -> Iterator[Schema]:
    """A schema, what it refers to, and each of those that it is any or all of."""
    if "$ref" in schema:
        *_, name = schema["$ref"].split("/")
        schema = description["components"]["schemas"][name]
    yield schema
    for keyword in ("anyOf", "oneOf", "allOf"):
        for one in schema.get(keyword, ()):
            yield from _alternatives(one, description)


def _inside(schema: Schema, name: str | int, description: Schema) -> Iterator[Schema]:
    """The schemas of a member of an object or of an array."""
    if isinstance(name, int):
        ahead = schema.get("prefixItems", ())
        inner = ahead[name] if name < len(ahead) else schema.get("items")
    else:
        inner = schema.get("properties", {}).get(name)
    if isinstance(inner, Mapping):
        yield from _alternatives(inner, description)


def _bounds(schema: Schema) -> str:
    # The largest double stands for no bound: it excludes infinity.
    bounds = {keyword: schema[keyword] for keyword in BOUNDS if abs(schema.get(keyword, math.inf)) < sys.float_info.max}
    if {"minimum", "maximum"} <= bounds.keys():
        return f"from {number_text(bounds['minimum'])} to {number_text(bounds['maximum'])}"
    return " and ".join(f"{BOUNDS[keyword]} {number_text(value)}" for keyword, value in bounds.items())
