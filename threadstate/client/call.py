"""Descriptions of requests and of how their responses are parsed, from which both clients have their methods."""

from __future__ import annotations

import inspect
import json
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar
from urllib.parse import quote

from pydantic import BaseModel

from threadstate.client.models.answer import Page
from threadstate.numbers import number_text

Result_co = TypeVar("Result_co", covariant=True)
Item = TypeVar("Item")
Model = TypeVar("Model", bound=BaseModel)

QueryValue = str | float | bool | None
JSON = "application/json"
SVG = "image/svg+xml"
EVENT_STREAM = "text/event-stream"
LATEST = "latest"
LibraryName = int | str
"""A library's number, ``latest``, ``latest-mesh``, or the designation of a thread or its slug."""


@dataclass(frozen=True)
class Call(Generic[Result_co]):
    """A request, and how its response is parsed.

    Attributes:
        method: the HTTP method.
        path: percent-encoded, from the service's address; may hold a query.
        read: parses the response's content; raises ``ValueError`` if it is not of the documented form.
        query: further query parameters; None is left out.
        body: the JSON to send.
        accept: media type of the response.
        repeatable: whether the request may be repeated although it may have had an effect.
    """

    method: str
    path: str
    read: Callable[[bytes], Result_co]
    query: Mapping[str, QueryValue] = field(default_factory=dict)
    body: bytes | None = None
    accept: str = JSON
    repeatable: bool = True

    @property
    def headers(self) -> dict[str, str]:
        """The content negotiation headers."""
        return {"Accept": self.accept} | ({} if self.body is None else {"Content-Type": JSON})

    @property
    def parameters(self) -> dict[str, str]:
        """The query parameters as they are written; every double reads back the same."""
        return {name: _written(value) for name, value in self.query.items() if value is not None}


@dataclass(frozen=True)
class PagedCall(Generic[Item]):
    """The request for the first page of a list.

    Attributes:
        first: that request.
        item: type of the pages' items.
    """

    first: Call[Page[Item]]
    item: type[Item]

    def after(self, page: Page[Item]) -> Call[Page[Item]] | None:
        """The request for the page after ``page``; None after the last."""
        return None if page.next is None else Call("GET", page.next, self.first.read)


def get(path: str, answer: type[Model], **query: QueryValue) -> Call[Model]:
    """A GET request whose response is parsed as a model."""
    return Call("GET", path, answer.model_validate_json, query)


def get_content(path: str, accept: str, **query: QueryValue) -> Call[bytes]:
    """A GET request whose response is returned as bytes."""
    return Call("GET", path, bytes, query, accept=accept)


def post(
    path: str, answer: type[Model], body: Mapping[str, object], *, repeatable: bool, **query: QueryValue
) -> Call[Model]:
    """A POST request with ``body``, without its values that are None."""
    content = json.dumps({name: value for name, value in body.items() if value is not None}, allow_nan=False)
    return Call("POST", path, answer.model_validate_json, query, content.encode(), repeatable=repeatable)


def name_of(call: Call[object]) -> str:
    """Method and path of a request, as errors name it."""
    return f"{call.method} {call.path.partition('?')[0]}"


def path_of(*segments: str | float) -> str:
    """A path of these segments, each percent-encoded, its slashes too."""
    return "".join(f"/{quote(_written(segment), safe='')}" for segment in segments)


def library_path(library: LibraryName, *segments: str | float) -> str:
    """The path of a library, or of something below it."""
    return path_of("v1", "libraries", library, *segments)


def joined(names: Iterable[str] | None) -> str | None:
    """Names separated by commas."""
    return None if names is None else ",".join(str(name) for name in names)


def _written(value: str | float | bool) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return number_text(value) if isinstance(value, float) else str(value)


def describe_as(method: Callable[..., Any], describe: Callable[..., Any], returned: str = "{}") -> None:
    """Give a method the name and the documentation of ``describe``, and its parameters behind the client.

    ``returned`` is the method's return annotation, with ``{}`` for the result of the described request.
    """
    method.__name__ = describe.__name__
    method.__doc__ = describe.__doc__
    signature = inspect.signature(describe)
    client = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    answer = str(signature.return_annotation).removeprefix("Paged").removeprefix("Call[").removesuffix("]")
    method.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[client, *signature.parameters.values()], return_annotation=returned.format(answer)
    )
