"""Problem documents (RFC 9457), and the service's own state."""

from __future__ import annotations

from typing import Literal

from threadstate.client.models.answer import Answer


class ProblemItem(Answer):
    """An invalid value: its location, the value as received, and the valid ones."""

    location: str
    value: str
    valid: str


class Problem(Answer):
    """A problem document: type, title, the detail of this occurrence, and the invalid values."""

    type: str = "about:blank"
    title: str = ""
    status: int
    detail: str = ""
    instance: str | None = None
    errors: tuple[ProblemItem, ...] = ()


class Health(Answer):
    """The process is alive."""

    status: str


class Readiness(Answer):
    """The service is ready; ``library`` is the number of the latest one.

    ``kernels`` is ``ready``, or ``compiling`` for one to two minutes, when nothing is solved.
    """

    status: str
    schema_revision: str
    library: int
    kernels: Literal["compiling", "ready"]
