"""The application as OpenAPI describes it."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from fastapi import FastAPI
from starlette.types import ASGIApp

from service.examples.answers import EXAMPLES
from service.problems import MEDIA_TYPE, Problem

DESCRIPTION = """Contact states of a bolt that meets a nut askew: the stored library of a thread, and the exact solver
for any other pose. Angles are in degrees; lengths in the thread's own unit or in the one asked for by `unit`; points
in the nut's frame. `pitch` is the pose angle; the thread's is `thread_pitch`."""

PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    "default": {"description": "A problem (RFC 9457)", "model": Problem}
}


class DescribedApplication(FastAPI):
    """An application that describes its errors as what they are, problem documents, and its answers by examples.

    ``outermost`` is put around all layers, also the one that answers what nobody has foreseen.
    """

    outermost: Callable[[ASGIApp], ASGIApp]

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._describing = threading.Lock()

    def build_middleware_stack(self) -> ASGIApp:
        """All layers, made once."""
        return self.outermost(super().build_middleware_stack())

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document; made once, whoever else asks for it meanwhile."""
        with self._describing:
            if self.openapi_schema is None:
                document = super().openapi()
                # Not to be seen before it is whole.
                self.openapi_schema = None
                _describe_problems(document)
                _show_examples(document)
                self.openapi_schema = document
            return self.openapi_schema


def _describe_problems(document: dict[str, Any]) -> None:
    for methods in document["paths"].values():
        for operation in methods.values():
            problem = operation["responses"]["default"]
            # FastAPI takes an error to be of the media type of the answer.
            (schema,) = problem["content"].values()
            problem["content"] = {MEDIA_TYPE: schema}


def _show_examples(document: dict[str, Any]) -> None:
    # Not among the routes' responses: what FastAPI describes there loses every null.
    for one in EXAMPLES:
        answer = document["paths"][one.path][one.method]["responses"]["200"]["content"][one.media_type]
        answer["examples"] = {one.name: {"summary": one.summary, "value": one.value}, **answer.get("examples", {})}
