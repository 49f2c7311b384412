"""Handing this process over to the service."""

from __future__ import annotations

import os
import sys
from typing import NoReturn

from threadstate.settings import DATABASE, HOST, PORT
from worker.output import tell

SERVICE = "service"
"""The service by name: the worker does not import it."""


def become_service(database: str, host: str, port: int) -> NoReturn:
    """Replace this process by the service, which so gets every signal itself.

    What ``serve`` and ``run`` end with.
    """
    tell(f"Open {address(host, port)} in a browser, or ask {address(host, port)}/v1/libraries/latest.")
    environment = {**os.environ, DATABASE: database, HOST: host, PORT: str(port)}
    # This very interpreter, and arguments that no shell reads.
    os.execve(sys.executable, [sys.executable, "-m", SERVICE], environment)  # nosec B606


def address(host: str, port: int) -> str:
    """The address to open in a browser on this machine."""
    reachable = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return f"http://[{reachable}]:{port}" if ":" in reachable else f"http://{reachable}:{port}"
