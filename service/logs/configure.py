"""Logs as JSON, one object a line, or as text for people; those of libraries in the same form as our own."""

from __future__ import annotations

import json
import logging
import sys
from collections.abc import Callable
from datetime import UTC, datetime

import orjson
import structlog
from structlog.typing import EventDict, Processor, WrappedLogger

from service.request_id import current_request_id
from threadstate.settings import LogForm, LogLevel

_SERVER = ("uvicorn", "uvicorn.error", "uvicorn.access", "uvicorn.asgi")


def configure_logs(form: LogForm, level: LogLevel) -> None:
    """Log to stderr from now on, in this process; a line is written when it is logged, so that none is lost."""
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
        # Half a surrogate pair, or a number of more than 64 bits: the line is not lost for it.
        return json.dumps(event, default=str)


def _add_logger_name(_logger: WrappedLogger, _name: str, event: EventDict) -> EventDict:
    record = event.get("_record")
    if record is not None:
        event["logger"] = record.name
        # The server's own copy of its message, with the codes of colours.
        event.pop("color_message", None)
    return event
