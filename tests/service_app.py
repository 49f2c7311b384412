"""The application with an OpenAPI document that is built once in a process: each test's own would take 0.3 s."""

from __future__ import annotations

from functools import cache
from typing import Any

from fastapi import FastAPI

from service.app import create_app
from threadstate.settings import DATABASE, READ_KEYS, Settings, read_settings


def service_app(settings: Settings, *, serving: bool = False) -> FastAPI:
    """As ``create_app``, which tests call themselves where the document is what is tested."""
    app = create_app(settings, serving=serving)
    app.openapi_schema = _document(settings.read_keys_required)
    return app


@cache
def _document(read_keys_required: bool) -> dict[str, Any]:
    reading = "required" if read_keys_required else "open"
    return create_app(read_settings({DATABASE: "sqlite:////nowhere", READ_KEYS: reading})).openapi()
