"""Problem documents (RFC 9457), and the service's own state."""

from __future__ import annotations

from typing import Literal

from threadstate.client.models.answer import Answer


class ProblemItem(Answer):
    """A value that was refused: where it was, the value as the service received it, and what would be valid."""

    location: str
    value: str
    valid: str


class Problem(Answer):
    """A problem document: which problem, in words that do not change and of this occurrence, and the values refused."""

    type: str = "about:blank"
    title: str = ""
    status: int
    detail: str = ""
    instance: str | None = None
    errors: tuple[ProblemItem, ...] = ()


class Health(Answer):
    """The process lives."""

    status: str


class Readiness(Answer):
    """The service can answer; ``library`` is the number of the latest one.

    ``kernels`` is ``ready``, or ``compiling`` for a minute or two, when nothing is solved.
    """

    status: str
    schema_revision: str
    library: int
    kernels: Literal["compiling", "ready"]
