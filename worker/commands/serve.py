"""``threadstate serve``."""

from __future__ import annotations

from threadstate.settings import read_settings
from worker.options import Database, Host, Port


def serve(database: Database = None, host: Host = None, port: Port = None) -> None:
    r"""Serve the published libraries and the solver over HTTP, until interrupted.

    \b
    Examples:
      threadstate serve
      threadstate serve --host 0.0.0.0 --port 8080
    """
    from threadstate.library.engine import reading
    from threadstate.library.schema import check_schema
    from worker.serving import exec_service

    settings = read_settings()
    chosen = database or settings.database
    with reading(chosen) as engine:
        check_schema(engine)
    exec_service(chosen, host or settings.host, port or settings.port)
