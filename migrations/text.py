"""Text columns as migrations make them: compared byte by byte on every database."""

from __future__ import annotations

import sqlalchemy as sa


def bytewise_string(length: int) -> sa.String:
    """Text of at most ``length`` characters."""
    return sa.String(length).with_variant(sa.String(length, collation="C"), "postgresql")


def bytewise_text() -> sa.Text:
    """Text of any length."""
    return sa.Text().with_variant(sa.Text(collation="C"), "postgresql")
