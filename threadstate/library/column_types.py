"""Column types with one meaning on both databases: text compared byte by byte, and times in UTC.

SQLite compares text by bytes; PostgreSQL would compare it by the rules of a language, which differ from server to
server. SQLite stores a time without its zone, so the zone is always UTC and is added on reading.
"""

from __future__ import annotations

from datetime import UTC, datetime

from sqlalchemy import DateTime, Dialect, String, Text
from sqlalchemy.types import TypeDecorator

BYTEWISE = "C"


def bytewise_string(length: int) -> String:
    """Text of at most ``length`` characters."""
    return String(length).with_variant(String(length, collation=BYTEWISE), "postgresql")


def bytewise_text() -> Text:
    """Text of any length."""
    return Text().with_variant(Text(collation=BYTEWISE), "postgresql")


class UtcDateTime(TypeDecorator[datetime]):
    """An aware time, stored and returned in UTC."""

    impl = DateTime(timezone=True)
    cache_ok = True

    def process_bind_param(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 - the base class names it
        """The time in UTC.

        Raises:
            ValueError: the value has no time zone.
        """
        if value is None:
            return None
        if value.tzinfo is None:
            raise ValueError(f"time {value!r} has no time zone")
        return value.astimezone(UTC)

    def process_result_value(self, value: datetime | None, dialect: Dialect) -> datetime | None:  # noqa: ARG002 - the base class names it
        """The stored time, aware."""
        if value is None:
            return None
        return value.replace(tzinfo=UTC) if value.tzinfo is None else value.astimezone(UTC)
