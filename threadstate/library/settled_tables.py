"""The tables of stored settled states: where a bolt comes to rest that a device holds, pose by pose of a grid.

Ordinals, orientations, units and numbers are those of ``threadstate.library.tables``; forces are in N. All of an
orientation is written in one transaction. Names are checked when they are read, so that a new flag needs no migration.
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

MARGINS = ("force", "gap", "stability", "residual", "pressure")
"""The margins of a settled state, in order."""

settled_library = Table(
    "settled_library",
    metadata,
    Column("id", Integer, nullable=False),
    Column("designation", bytewise_string(100), nullable=False),
    Column("length_unit", bytewise_string(2), nullable=False),
    # What was computed: the SHA-256 of all inputs, and the inputs themselves; the device as its document.
    Column("input_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("pair", bytewise_text(), nullable=False),
    Column("device", bytewise_text(), nullable=False),
    Column("code_version", bytewise_string(NAME_LENGTH), nullable=False),
    Column("tilt_max_deg", Double, nullable=False),
    Column("tilt_step_deg", Double, nullable=False),
    Column("phase_step_deg", Double, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    # Both null until the library is published; readers see published libraries only.
    Column("content_sha256", bytewise_string(SHA256_LENGTH)),
    Column("published_at", UtcDateTime),
    PrimaryKeyConstraint("id"),
    # Serves: the library of given inputs.
    UniqueConstraint("input_sha256"),
    one_of("length_unit", LengthUnit),
    CheckConstraint("(content_sha256 IS NULL) = (published_at IS NULL)", name="published_with_content"),
    # Serves: the published libraries, and the latest.
    Index(None, "published_at", "id"),
)
"""A library of settled states: one pair over one grid, held by one device."""

_LIBRARY = "library_id"

settled_chunk = Table(
    "settled_chunk",
    metadata,
    Column(_LIBRARY, Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("state_count", Integer, nullable=False),
    Column("content_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    # Serves: the committed orientations; the hashes in order when publishing.
    PrimaryKeyConstraint(_LIBRARY, "orientation"),
    ForeignKeyConstraint([_LIBRARY], ["settled_library.id"], ondelete="CASCADE"),
    CheckConstraint("orientation >= 0", name="orientation_not_negative"),
    sqlite_with_rowid=False,
)
"""A committed chunk: all phases of one orientation."""

settled_state = Table(
    "settled_state",
    metadata,
    Column(_LIBRARY, Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("roll_deg", Double, nullable=False),
    Column("pitch_deg", Double, nullable=False),
    Column("phase_deg", Double, nullable=False),
    Column("outcome", bytewise_string(NAME_LENGTH), nullable=False),
    Column("contact_count", Integer, nullable=False),
    Column("fall_count", Integer, nullable=False),
    # Null where the bolt is not settled: its pose, what the device gives way, and the elastic energy.
    *(Column(f"r{row}{column}", Double) for row in (1, 2, 3) for column in (1, 2, 3)),
    *(Column(f"t{axis}", Double) for axis in "xyz"),
    *(Column(f"shift_{axis}", Double) for axis in "xyz"),
    *(Column(f"rotation_{axis}_deg", Double) for axis in "xyz"),
    Column("elastic_energy", Double),
    *(Column(f"{name}_margin", Double) for name in MARGINS),
    # Serves: states in the order of roll, pitch and phase; an orientation as a range.
    PrimaryKeyConstraint(_LIBRARY, "ordinal"),
    ForeignKeyConstraint([_LIBRARY], ["settled_library.id"], ondelete="CASCADE"),
    # Serves: one state by its pose; filters roll, and roll with pitch.
    UniqueConstraint(_LIBRARY, "roll_deg", "pitch_deg", "phase_deg"),
    CheckConstraint("ordinal >= 0", name="ordinal_not_negative"),
    # Serve: filters of that column in the default order; of outcome, contacts and falls the counts, too.
    *(
        Index(None, _LIBRARY, name, "ordinal")
        for name in ("pitch_deg", "phase_deg", "outcome", "contact_count", "fall_count")
    ),
    sqlite_with_rowid=False,
)
"""A settled state: its pose, how the push ended, where the bolt rests and how far the device gave way."""

_OF_STATE = (_LIBRARY, "ordinal")
_STATE = ("settled_state.library_id", "settled_state.ordinal")

settled_contact = Table(
    "settled_contact",
    metadata,
    Column(_LIBRARY, Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    *(Column(f"point_{axis}", Double, nullable=False) for axis in "xyz"),
    *(Column(f"normal_{axis}", Double, nullable=False) for axis in "xyz"),
    Column("features", bytewise_string(NAME_LENGTH), nullable=False),
    *(Column(f"force_{axis}", Double, nullable=False) for axis in "xyz"),
    # Serves: the contacts of a state or of a range of states, in order.
    PrimaryKeyConstraint(*_OF_STATE, "position"),
    ForeignKeyConstraint(_OF_STATE, _STATE, ondelete="CASCADE"),
    CheckConstraint("position >= 0", name="position_not_negative"),
    sqlite_with_rowid=False,
)
"""A contact of a settled state with the force on the bolt; ``position`` is its place, from 0."""

settled_fall = Table(
    "settled_fall",
    metadata,
    Column(_LIBRARY, Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("push", Double, nullable=False),
    Column("drop", Double, nullable=False),
    Column("way", Double, nullable=False),
    Column("energy", Double, nullable=False),
    # Serves: the falls of a state or of a range of states, in order.
    PrimaryKeyConstraint(*_OF_STATE, "position"),
    ForeignKeyConstraint(_OF_STATE, _STATE, ondelete="CASCADE"),
    CheckConstraint("position >= 0", name="position_not_negative"),
    sqlite_with_rowid=False,
)
"""A fall on the way to a settled state; ``position`` is its place, from 0."""

settled_flag = Table(
    "settled_flag",
    metadata,
    Column(_LIBRARY, Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("flag", bytewise_string(NAME_LENGTH), nullable=False),
    # Serves: the flags of a state or of a range of states, in order.
    PrimaryKeyConstraint(*_OF_STATE, "position"),
    # Serves: filter flag in the default order; the counts. Unique: a state has a flag once.
    UniqueConstraint(_LIBRARY, "flag", "ordinal"),
    ForeignKeyConstraint(_OF_STATE, _STATE, ondelete="CASCADE"),
    CheckConstraint("position >= 0", name="position_not_negative"),
    sqlite_with_rowid=False,
)
"""A flag of a settled state; ``position`` is its place, from 0."""
