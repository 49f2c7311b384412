"""The tables of stored success maps: how the paths of an orientation end, a row an orientation of the grid.

An orientation is its document (``threadstate.success.document``), which is what its hash is of; lengths are in the
pair's unit, forces in N. Maps are read by orientation and never searched by what is in a document.
"""

from __future__ import annotations

from sqlalchemy import (
    CheckConstraint,
    Column,
    Double,
    ForeignKeyConstraint,
    Index,
    Integer,
    PrimaryKeyConstraint,
    Table,
    UniqueConstraint,
)

from threadstate.library.column_types import UtcDateTime, bytewise_string, bytewise_text
from threadstate.library.tables import NAME_LENGTH, SHA256_LENGTH, metadata, one_of
from threadstate.units import LengthUnit

success_map = Table(
    "success_map",
    metadata,
    Column("id", Integer, nullable=False),
    Column("designation", bytewise_string(100), nullable=False),
    Column("length_unit", bytewise_string(2), nullable=False),
    # What was computed: the SHA-256 of all inputs, and the inputs themselves as JSON.
    Column("input_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("inputs", bytewise_text(), nullable=False),
    Column("code_version", bytewise_string(NAME_LENGTH), nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    # Both null until the map is published.
    Column("content_sha256", bytewise_string(SHA256_LENGTH)),
    Column("published_at", UtcDateTime),
    PrimaryKeyConstraint("id"),
    # Serves: the map of given inputs.
    UniqueConstraint("input_sha256"),
    one_of("length_unit", LengthUnit),
    CheckConstraint("(content_sha256 IS NULL) = (published_at IS NULL)", name="published_with_content"),
    # Serves: the published maps, and the latest.
    Index(None, "published_at", "id"),
)
"""A success map: a pair, a device and a strategy over a grid and several frictions."""

success_orientation = Table(
    "success_orientation",
    metadata,
    Column("map_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("roll_deg", Double, nullable=False),
    Column("pitch_deg", Double, nullable=False),
    Column("content_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("document", bytewise_text(), nullable=False),
    # Serves: the orientations in the order of the grid; the committed ones.
    PrimaryKeyConstraint("map_id", "orientation"),
    ForeignKeyConstraint(["map_id"], ["success_map.id"], ondelete="CASCADE"),
    # Serves: one orientation.
    UniqueConstraint("map_id", "roll_deg", "pitch_deg"),
    CheckConstraint("orientation >= 0", name="orientation_not_negative"),
    sqlite_with_rowid=False,
)
"""A committed orientation of a success map."""
