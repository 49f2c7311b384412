"""The application's OpenAPI document."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from fastapi import FastAPI
from starlette.types import ASGIApp

from service.examples.responses import EXAMPLES
from service.problems import MEDIA_TYPE, Problem

DESCRIPTION = """Contact states of a bolt that meets a nut askew: the stored library of a thread, and the exact solver
for any other pose. Angles are in degrees; lengths in the thread's own unit or in that of the parameter `unit`; points
in the nut's frame. `pitch` is the pose angle; the thread's is `thread_pitch`."""

PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    "default": {"description": "A problem (RFC 9457)", "model": Problem}
}


class DescribedApplication(FastAPI):
    """An application whose OpenAPI document describes errors as problem documents and responses by examples.

    ``outermost`` wraps all other middleware, including the one that handles unexpected exceptions.
    """

    outermost: Callable[[ASGIApp], ASGIApp]

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._describing = threading.Lock()

    def build_middleware_stack(self) -> ASGIApp:
        """The middleware stack, with ``outermost`` around it."""
        return self.outermost(super().build_middleware_stack())

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document, built once; concurrent calls wait for it."""
        with self._describing:
            if self.openapi_schema is None:
                document = super().openapi()
                # Set only when the document is complete.
                self.openapi_schema = None
                _describe_problems(document)
                _show_examples(document)
                self.openapi_schema = document
            return self.openapi_schema


def _describe_problems(document: dict[str, Any]) -> None:
    for methods in document["paths"].values():
        for operation in methods.values():
            problem = operation["responses"]["default"]
            # FastAPI gives errors the media type of the response.
            (schema,) = problem["content"].values()
            problem["content"] = {MEDIA_TYPE: schema}


def _show_examples(document: dict[str, Any]) -> None:
    # Not among the routes' responses: FastAPI removes every null from those.
    for one in EXAMPLES:
        answer = document["paths"][one.path][one.method]["responses"]["200"]["content"][one.media_type]
        answer["examples"] = {one.name: {"summary": one.summary, "value": one.value}, **answer.get("examples", {})}
