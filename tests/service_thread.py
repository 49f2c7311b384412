"""The service in a thread of the test's process: as over a network, without another process that imports everything."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import uvicorn

from service.server import bound_socket
from tests.service_app import service_app
from threadstate.settings import DATABASE, read_settings

HOST = "127.0.0.1"
LOOK_S = 0.01


@contextmanager
def service_thread(database: str, port: int = 0, settings: Mapping[str, str] | None = None) -> Iterator[str]:
    """The address of a service over a database, at that port or (0) at a free one, with these settings more."""
    app = service_app(read_settings({DATABASE: database, **(settings or {})}))
    listening = bound_socket(HOST, port)
    server = uvicorn.Server(uvicorn.Config(app, log_config=None, access_log=False))
    thread = threading.Thread(target=server.run, args=([listening],), daemon=True)
    thread.start()
    try:
        while not server.started:
            assert thread.is_alive(), "the service did not start"
            time.sleep(LOOK_S)
        yield f"http://{HOST}:{listening.getsockname()[1]}"
    finally:
        server.should_exit = True
        thread.join()
        listening.close()
