"""The table of API keys."""

from __future__ import annotations

from sqlalchemy import Column, PrimaryKeyConstraint, Table

from threadstate.access.scope import Scope
from threadstate.library.column_types import UtcDateTime, bytewise_string
from threadstate.library.tables import NAME_LENGTH, SHA256_LENGTH, metadata, one_of

KEY_ID_LENGTH = 12
KEY_NAME_LENGTH = 100

api_key = Table(
    "api_key",
    metadata,
    # Stands at the beginning of the key.
    Column("id", bytewise_string(KEY_ID_LENGTH), nullable=False),
    Column("name", bytewise_string(KEY_NAME_LENGTH), nullable=False),
    Column("scope", bytewise_string(NAME_LENGTH), nullable=False),
    # Of the whole key, which is random: nothing slower than SHA-256 would make it any harder to guess.
    Column("sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    Column("revoked_at", UtcDateTime),
    # Serves: the key of a request.
    PrimaryKeyConstraint("id"),
    one_of("scope", Scope),
    sqlite_with_rowid=False,
)
"""An API key; it is valid until it is revoked."""
