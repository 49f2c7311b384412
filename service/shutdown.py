"""Whether the process is shutting down: connections are then closed after their next response, and streams at once."""

from __future__ import annotations

from fastapi import Request


class Shutdown:
    """Started once, by SIGTERM."""

    def __init__(self) -> None:
        self.started = False

    def start(self) -> None:
        """Announce the shutdown to clients from now on."""
        self.started = True


def shutdown_of(request: Request) -> Shutdown:
    """The shutdown state of the application."""
    shutdown: Shutdown = request.app.state.shutdown
    return shutdown
