"""A request and what its answer is read as: the one description that both clients send, and have methods of."""

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
LATEST = "latest"
LibraryName = int | str
"""A library's number, ``latest``, ``latest-mesh``, or the designation of a thread or its slug."""


@dataclass(frozen=True)
class Call(Generic[Result_co]):
    """A request, and what the bytes of its answer are read as.

    Attributes:
        method: of HTTP.
        path: percent-encoded, from the service's address; may hold a query.
        read: makes the result of the answer's content; a ``ValueError`` says that it is another answer than described.
        query: further query parameters; None is left out.
        body: JSON to be sent.
        accept: media type of the answer.
        repeatable: whether the request may be sent again where it may have been acted upon.
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
        """The headers that say what is sent and what is wanted."""
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
        item: what the pages hold.
    """

    first: Call[Page[Item]]
    item: type[Item]

    def after(self, page: Page[Item]) -> Call[Page[Item]] | None:
        """The request for the page after ``page``; None after the last."""
        return None if page.next is None else Call("GET", page.next, self.first.read)


def get(path: str, answer: type[Model], **query: QueryValue) -> Call[Model]:
    """Read ``path`` as a model."""
    return Call("GET", path, answer.model_validate_json, query)


def get_content(path: str, accept: str, **query: QueryValue) -> Call[bytes]:
    """Read ``path`` as it comes."""
    return Call("GET", path, bytes, query, accept=accept)


def post(
    path: str, answer: type[Model], body: Mapping[str, object], *, repeatable: bool, **query: QueryValue
) -> Call[Model]:
    """Send ``body``, without what is None in it, to ``path``."""
    content = json.dumps({name: value for name, value in body.items() if value is not None}, allow_nan=False)
    return Call("POST", path, answer.model_validate_json, query, content.encode(), repeatable=repeatable)


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

    ``returned`` is what the method returns, with ``{}`` for what the described request is answered by.
    """
    method.__name__ = describe.__name__
    method.__doc__ = describe.__doc__
    signature = inspect.signature(describe)
    client = inspect.Parameter("self", inspect.Parameter.POSITIONAL_ONLY)
    answer = str(signature.return_annotation).removeprefix("Paged").removeprefix("Call[").removesuffix("]")
    method.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[client, *signature.parameters.values()], return_annotation=returned.format(answer)
    )
