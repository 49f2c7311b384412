"""Starting the service in this process."""

from __future__ import annotations

import errno
import os
import socket
import sys
from importlib.util import find_spec
from typing import NoReturn

from threadstate.errors import MissingExtraError, ThreadstateError
from threadstate.settings import DATABASE, HOST, PORT
from worker.output import print_status

SERVICE = "service"
"""The service by name: the worker does not import it."""


class UnusableAddressError(ThreadstateError):
    """An address that the service cannot listen on."""


def exec_service(database: str, host: str, port: int) -> NoReturn:
    """Replace this process by the service (``exec``), which then receives every signal itself.

    Raises:
        MissingExtraError: the service's packages are not installed.
        UnusableAddressError: the address cannot be listened on.
    """
    if find_spec("uvicorn") is None:
        raise MissingExtraError("the service", "service")
    check_address(host, port)
    print_status(f"Open {address(host, port)} in a browser, or ask {address(host, port)}/v1/libraries/latest.")
    environment = {**os.environ, DATABASE: database, HOST: host, PORT: str(port)}
    # The same interpreter, without a shell.
    os.execve(sys.executable, [sys.executable, "-m", SERVICE], environment)  # nosec B606


def check_address(host: str, port: int) -> None:
    """Check that an address can be listened on, unless systemd passes a listening socket.

    Raises:
        UnusableAddressError: another process listens on the port, or the machine does not have the address.
    """
    if os.environ.get("LISTEN_PID") == str(os.getpid()):
        return
    try:
        family, kind, protocol, _, found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        with socket.socket(family, kind, protocol) as listening:
            # As the service does: the port may have connections that are still being closed.
            listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            listening.bind(found)
            listening.listen()
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise UnusableAddressError(
                f"port {port} of {host} is taken by another process; --port chooses another one"
            ) from None
        raise UnusableAddressError(
            f"cannot listen on {host}, port {port} ({error.strerror or error}); --host and --port choose others"
        ) from None


def address(host: str, port: int) -> str:
    """The address to open in a browser on this machine."""
    reachable = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
    return f"http://[{reachable}]:{port}" if ":" in reachable else f"http://{reachable}:{port}"
