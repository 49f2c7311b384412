"""Logs as JSON, one object a line, or as text for people; those of libraries have the same form."""

from __future__ import annotations

import json
import logging
import sys
from collections.abc import Callable
from datetime import UTC, datetime
from typing import NamedTuple

import orjson
import structlog
from structlog.typing import EventDict, Processor, WrappedLogger

from service.request_scope import current_request_id
from threadstate.settings import LogForm, LogLevel

_SERVER = ("uvicorn", "uvicorn.error", "uvicorn.access", "uvicorn.asgi")


def configure_logs(form: LogForm, level: LogLevel) -> None:
    """Configure this process to log to stderr, unbuffered, so that no line is lost."""
    number = logging.getLevelNamesMapping()[level.upper()]
    add_time: Processor = structlog.processors.TimeStamper(fmt="iso", utc=True)
    last: list[Processor] = [structlog.dev.ConsoleRenderer(colors=sys.stderr.isatty())]
    if form is LogForm.JSON:
        add_time = _add_time
        last = [structlog.processors.format_exc_info, structlog.processors.JSONRenderer(serializer=_as_json)]
    shared: list[Processor] = [structlog.processors.add_log_level, _add_request_id, add_time]
    structlog.configure(
        processors=[*shared, *last],
        wrapper_class=structlog.make_filtering_bound_logger(number),
        logger_factory=structlog.WriteLoggerFactory(sys.stderr),
        cache_logger_on_first_use=True,
    )
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(
        structlog.stdlib.ProcessorFormatter(
            foreign_pre_chain=[_add_logger_name, *shared],
            processors=[structlog.stdlib.ProcessorFormatter.remove_processors_meta, *last],
        )
    )
    logging.basicConfig(handlers=[handler], level=number, force=True)
    for name in _SERVER:
        logger = logging.getLogger(name)
        logger.handlers.clear()
        logger.propagate = True
    logging.getLogger("uvicorn.access").disabled = True


def _add_request_id(_logger: WrappedLogger, _name: str, event: EventDict) -> EventDict:
    number = current_request_id.get()
    if number is not None:
        event["request_id"] = number
    return event


def _add_time(_logger: WrappedLogger, _name: str, event: EventDict) -> EventDict:
    event["timestamp"] = datetime.now(UTC)
    return event


def _as_json(event: EventDict, default: Callable[[object], object]) -> str:
    try:
        return orjson.dumps(event, default=default, option=orjson.OPT_UTC_Z).decode()
    except orjson.JSONEncodeError:
        # A lone surrogate, or an integer of more than 64 bits.
        return json.dumps(event, default=str)


def _add_logger_name(_logger: WrappedLogger, _name: str, event: EventDict) -> EventDict:
    record = event.get("_record")
    if record is not None:
        event["logger"] = record.name
        # uvicorn's second copy of its message, with colour codes.
        event.pop("color_message", None)
    return event


_log = structlog.get_logger()


class AccessLine(NamedTuple):
    """The logged values of a request: neither address nor query, and of its headers the request id alone.

    ``sent_bytes`` counts the content.
    """

    method: str
    route: str
    status: int
    seconds: float
    sent_bytes: int
    client: str


def log_access(line: AccessLine) -> None:
    """Log a request; a status 500 as an error."""
    say = _log.error if line.status == 500 else _log.info
    say(
        "request",
        method=line.method,
        route=line.route,
        status=line.status,
        duration_ms=round(1000.0 * line.seconds, 3),
        bytes=line.sent_bytes,
        client=line.client,
    )
