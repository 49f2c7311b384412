"""The application as OpenAPI describes it."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI

from service.problems import MEDIA_TYPE, Problem

DESCRIPTION = """Contact states of a bolt that meets a nut askew: the stored library of a thread, and the exact solver
for any other pose. Angles are in degrees; lengths in the thread's own unit or in the one asked for by `unit`; points
in the nut's frame. `pitch` is the pose angle; the thread's is `thread_pitch`."""

PROBLEM_RESPONSES: dict[int | str, dict[str, Any]] = {
    "default": {"description": "A problem (RFC 9457)", "model": Problem}
}


class DescribedApplication(FastAPI):
    """An application whose errors are described as what they are: problem documents."""

    def openapi(self) -> dict[str, Any]:
        """The OpenAPI document; made once."""
        if self.openapi_schema is None:
            document = super().openapi()
            for methods in document["paths"].values():
                for operation in methods.values():
                    content = operation["responses"]["default"]["content"]
                    content[MEDIA_TYPE] = content.pop("application/json")
        return super().openapi()
