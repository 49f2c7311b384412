"""Whether the service lives, and whether it can answer."""

from __future__ import annotations

from threadstate.client.models.answer import Answer


class Health(Answer):
    """The process lives."""

    status: str


class Readiness(Answer):
    """The service can answer; ``library`` is the number of the latest one."""

    status: str
    schema_revision: str
    library: int
