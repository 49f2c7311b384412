"""Text in the database: compared byte by byte everywhere.

SQLite does so by itself; PostgreSQL would sort by the rules of a language, which differ from server to server.
"""

from __future__ import annotations

from sqlalchemy import String, Text

BYTEWISE = "C"


def bytewise_string(length: int) -> String:
    """Text of at most ``length`` characters."""
    return String(length).with_variant(String(length, collation=BYTEWISE), "postgresql")


def bytewise_text() -> Text:
    """Text of any length."""
    return Text().with_variant(Text(collation=BYTEWISE), "postgresql")
