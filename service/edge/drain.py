"""Whether the process is about to end: then connections are closed after their next answer, and streams now."""

from __future__ import annotations

from fastapi import Request


class Drain:
    """Begun once, by SIGTERM."""

    def __init__(self) -> None:
        self.begun = False

    def begin(self) -> None:
        """From now on the process takes leave of its clients."""
        self.begun = True


def drain_of(request: Request) -> Drain:
    """The application's."""
    drain: Drain = request.app.state.drain
    return drain
