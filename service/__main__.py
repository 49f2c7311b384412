"""``python -m service``: the service as a process of its own; what ``threadstate serve`` becomes."""

from __future__ import annotations

import gc
import os
import sys

import uvicorn

from service.app import create_app
from service.logs.configure import configure_logs
from service.server import LEAVE_TAKING_S, Server, bound_socket, inherited_socket
from threadstate.errors import SchemaError, ThreadstateError
from threadstate.library.engine import reading
from threadstate.library.schema import check_schema
from threadstate.settings import read_settings

SWITCH_S = 0.0005
"""How long a thread that computes may hold up the one that answers; Python's own default is ten times that."""
SCHEMA_EXIT_CODE = 3
"""As that of the command line."""


def main() -> int:
    """Serve until told to end.

    Returns:
        The exit code.
    """
    settings = read_settings()
    with reading(settings.database) as engine:
        check_schema(engine)
    listening = inherited_socket(os.environ) or bound_socket(settings.host, settings.port)
    configure_logs(settings.log, settings.log_level)
    app = create_app(settings, serving=True)
    config = uvicorn.Config(
        app,
        log_config=None,
        access_log=False,
        server_header=False,
        timeout_graceful_shutdown=max(1, round(settings.grace_s - LEAVE_TAKING_S)),
    )
    sys.setswitchinterval(SWITCH_S)
    gc.freeze()  # what is here now stays for good
    Server(config, app.state.drain).run([listening])
    return 0


if __name__ == "__main__":
    try:
        code = main()
    except ThreadstateError as error:
        sys.stderr.write(f"threadstate: {error}\n")
        code = SCHEMA_EXIT_CODE if isinstance(error, SchemaError) else 1
    sys.stdout.flush()
    sys.stderr.flush()
    # A thread that still computes for a request that was given up would be waited for otherwise.
    os._exit(code)
