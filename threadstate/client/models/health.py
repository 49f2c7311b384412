"""Whether the service lives, and whether it can answer."""

from __future__ import annotations

from typing import Literal

from threadstate.client.models.answer import Answer


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
