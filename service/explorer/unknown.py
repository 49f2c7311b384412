"""A friendly page for a person at an address that there is not; programs get a problem document as ever."""

from __future__ import annotations

from typing import Any

from fastapi import FastAPI, Request, Response
from starlette.exceptions import HTTPException

from service.explorer.files import UNKNOWN, page


def install_unknown_page(app: FastAPI) -> None:
    """Make ``app`` answer 404 by the page where a browser asks for one; its other handlers are set before."""
    answer: Any = app.exception_handlers[HTTPException]

    def answer_or_page(request: Request, error: Any) -> Response:
        if error.status_code == 404 and _asks_for_a_page(request):
            unknown = page().files[UNKNOWN]
            return Response(unknown.content, 404, {"Cache-Control": "no-store"}, unknown.media_type)
        response: Response = answer(request, error)
        return response

    app.add_exception_handler(HTTPException, answer_or_page)


def _asks_for_a_page(request: Request) -> bool:
    return "text/html" in request.headers.get("accept", "") and not request.url.path.startswith("/v1/")
