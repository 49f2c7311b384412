"""``python -m service``: the service as a process; ``threadstate serve`` replaces itself by it."""

from __future__ import annotations

import gc
import os
import sys

import uvicorn

from service.app import create_app
from service.logs import configure_logs
from service.server import DRAIN_S, FIRST_REQUEST_S, Server, bound_socket, inherited_socket
from threadstate.errors import SchemaError, ThreadstateError
from threadstate.library.engine import reading
from threadstate.library.schema import check_schema
from threadstate.settings import read_settings

SWITCH_S = 0.0005
"""Python's thread switch interval: how long a computing thread may delay the event loop; the default is ten times
that.
"""
SCHEMA_EXIT_CODE = 3
"""The same as that of the command line."""


def main() -> int:
    """Serve until SIGTERM or SIGINT.

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
        timeout_graceful_shutdown=max(1, round(settings.grace_s - DRAIN_S - FIRST_REQUEST_S)),
    )
    sys.setswitchinterval(SWITCH_S)
    gc.freeze()  # all objects so far live as long as the process
    Server(config, app.state.shutdown).run([listening])
    return 0


if __name__ == "__main__":
    try:
        code = main()
    except ThreadstateError as error:
        sys.stderr.write(f"threadstate: {error}\n")
        code = SCHEMA_EXIT_CODE if isinstance(error, SchemaError) else 1
    sys.stdout.flush()
    sys.stderr.flush()
    # Does not wait for threads that still compute for requests that timed out.
    os._exit(code)
