"""The tables of the stored library.

``ordinal`` numbers the states of a library by their place in its grid,
``(i_roll * n_pitch + i_pitch) * n_phase + i_phase`` with every axis ascending, so that it is the same on every
machine and its order is the order of (roll, pitch, phase). ``orientation`` numbers the chunks,
``i_roll * n_pitch + i_pitch``. Lengths are in the unit of the library's row, angles in degrees. All numbers are IEEE
doubles; neither NaN nor -0.0 is ever stored (SQLite preserves neither). Text is compared byte by byte.
"""

from __future__ import annotations

from collections.abc import Iterable
from enum import StrEnum

from sqlalchemy import (
    CheckConstraint,
    Column,
    Double,
    ForeignKeyConstraint,
    Index,
    Integer,
    LargeBinary,
    MetaData,
    PrimaryKeyConstraint,
    Table,
    UniqueConstraint,
)

from threadstate.library.column_types import UtcDateTime, bytewise_string, bytewise_text
from threadstate.state.model import FeaturePair, Flag, StateClass
from threadstate.state.quantities import QUANTITIES
from threadstate.statics.stored import NAMES as STATICS
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS
from threadstate.units import LengthUnit

metadata = MetaData(
    naming_convention={
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
        "uq": "uq_%(table_name)s_%(column_0_N_name)s",
        "ck": "ck_%(table_name)s_%(constraint_name)s",
        "fk": "fk_%(table_name)s_%(referred_table_name)s",
        "pk": "pk_%(table_name)s",
    }
)

NAME_LENGTH = 32
SHA256_LENGTH = 64


def one_of(column: str, names: Iterable[StrEnum]) -> CheckConstraint:
    """The constraint that a column holds one of these names."""
    # Not IN (...): SQLite rebuilds that list for every row, which took a third of the time of writing a library.
    either = " OR ".join(f"{column} = '{name.value}'" for name in names)
    return CheckConstraint(either, name=f"{column}_known")


library = Table(
    "library",
    metadata,
    Column("id", Integer, nullable=False),
    Column("designation", bytewise_string(100), nullable=False),
    Column("length_unit", bytewise_string(2), nullable=False),
    # What was computed: the SHA-256 of all inputs, and the inputs themselves as canonical JSON.
    Column("input_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("pair", bytewise_text(), nullable=False),
    Column("method", bytewise_string(NAME_LENGTH), nullable=False),
    Column("options", bytewise_text(), nullable=False),
    Column("code_version", bytewise_string(NAME_LENGTH), nullable=False),
    # The grid: roll and pitch are -tilt_max .. tilt_max, phase 0 .. 360 without the end.
    Column("tilt_max_deg", Double, nullable=False),
    Column("tilt_step_deg", Double, nullable=False),
    Column("phase_step_deg", Double, nullable=False),
    Column("tilt_count", Integer, nullable=False),
    Column("phase_count", Integer, nullable=False),
    # The poses of the grid; each has a state or is undecided.
    Column("state_count", Integer, nullable=False),
    Column("created_at", UtcDateTime, nullable=False),
    # Both null until the library is published; readers see published libraries only.
    Column("content_sha256", bytewise_string(SHA256_LENGTH)),
    Column("published_at", UtcDateTime),
    # How many of the poses are undecided; 0 until the library is published.
    Column("undecided_count", Integer, nullable=False, server_default="0"),
    # Since when "latest" means this library; null in all libraries but one at most.
    Column("pinned_at", UtcDateTime),
    PrimaryKeyConstraint("id"),
    # Serves: the library of given inputs.
    UniqueConstraint("input_sha256"),
    one_of("length_unit", LengthUnit),
    CheckConstraint("tilt_count > 0 AND phase_count > 0", name="grid_not_empty"),
    CheckConstraint("state_count = tilt_count * tilt_count * phase_count", name="state_count_of_grid"),
    CheckConstraint("(content_sha256 IS NULL) = (published_at IS NULL)", name="published_with_content"),
    # Serves: the latest published library, of all or (below) of one designation.
    Index(None, "published_at", "id"),
    Index(None, "designation", "published_at", "id"),
    # Serves: the pinned library.
    Index(None, "pinned_at"),
)
"""A library: one pair over one grid by one solver method. Rows without ``published_at`` are still being computed."""

chunk = Table(
    "chunk",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("roll_deg", Double, nullable=False),
    Column("pitch_deg", Double, nullable=False),
    Column("state_count", Integer, nullable=False),
    Column("content_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    # Its states as one JSON array, compressed by Zstandard: a history is answered from it. It follows from the rows of
    # the states; null where an older threadstate wrote them, until `threadstate migrate` has filled it in.
    Column("states_json", LargeBinary),
    # Serves: the committed orientations; the hashes in order when publishing.
    PrimaryKeyConstraint("library_id", "orientation"),
    ForeignKeyConstraint(["library_id"], ["library.id"], ondelete="CASCADE"),
    CheckConstraint("orientation >= 0", name="orientation_not_negative"),
    CheckConstraint("state_count > 0", name="not_empty"),
    sqlite_with_rowid=False,
)
"""A committed chunk: all phases of one orientation, written in one transaction."""

state = Table(
    "state",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("roll_deg", Double, nullable=False),
    Column("pitch_deg", Double, nullable=False),
    Column("phase_deg", Double, nullable=False),
    Column("state_class", bytewise_string(NAME_LENGTH), nullable=False),
    *(Column(quantity.attribute, Double) for quantity in QUANTITIES),
    # Its statics under the default load. They follow from its contacts, and are no part of the content hash; null where
    # an older threadstate wrote it, until `threadstate migrate` has filled them in.
    *(Column(name, Double) for name in STATICS),
    # Serves: states in the default order (roll, pitch, phase) and the keyset that walks them; a history as a range.
    PrimaryKeyConstraint("library_id", "ordinal"),
    ForeignKeyConstraint(["library_id"], ["library.id"], ondelete="CASCADE"),
    # Serves: one state by its pose; filters roll, and roll with pitch, in the default order.
    UniqueConstraint("library_id", "roll_deg", "pitch_deg", "phase_deg"),
    one_of("state_class", StateClass),
    CheckConstraint("ordinal >= 0", name="ordinal_not_negative"),
    CheckConstraint("phase_deg >= 0 AND phase_deg < 360", name="phase_in_turn"),
    # Serves: filter pitch (without roll) in the default order; sort=pitch.
    Index(None, "library_id", "pitch_deg", "ordinal"),
    # Serves: filters phase, phase_min and phase_max where they leave little; sort=phase.
    Index(None, "library_id", "phase_deg", "ordinal"),
    # Serves: filter class in the default order; the counts of the summary.
    Index(None, "library_id", "state_class", "ordinal"),
    # Serve: sort by that column, with the ordinal as the keyset's tie-breaker.
    *(Index(None, "library_id", quantity.attribute, "ordinal") for quantity in QUANTITIES if quantity.sortable),
    # Serve: sort by that column, filters of its range.
    *(Index(None, "library_id", name, "ordinal") for name in STATICS),
    sqlite_with_rowid=False,
)
"""A contact state: its pose, turns, lengths, class and the distances of the class from its thresholds."""

_OF_STATE = ("library_id", "ordinal")

stage_pose = Table(
    "stage_pose",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("stage", Integer, nullable=False),
    *(Column(f"r{row}{column}", Double, nullable=False) for row in (1, 2, 3) for column in (1, 2, 3)),
    *(Column(f"t{axis}", Double, nullable=False) for axis in "xyz"),
    # Serves: the poses of a state or of a range of states, in order.
    PrimaryKeyConstraint("library_id", "ordinal", "stage"),
    ForeignKeyConstraint(_OF_STATE, ["state.library_id", "state.ordinal"], ondelete="CASCADE"),
    CheckConstraint("stage BETWEEN 1 AND 3", name="stage_known"),
    sqlite_with_rowid=False,
)
"""The bolt's pose at a stage reached, bolt to nut: rotation by rows, translation."""

contact = Table(
    "contact",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("stage", Integer, nullable=False),
    *(Column(f"point_{axis}", Double, nullable=False) for axis in "xyz"),
    *(Column(f"point_bolt_{axis}", Double, nullable=False) for axis in "xyz"),
    *(Column(f"normal_{axis}", Double, nullable=False) for axis in "xyz"),
    Column("bolt_region", bytewise_string(NAME_LENGTH), nullable=False),
    Column("nut_region", bytewise_string(NAME_LENGTH), nullable=False),
    Column("features", bytewise_string(NAME_LENGTH), nullable=False),
    Column("bolt_margin", Double, nullable=False),
    Column("nut_margin", Double, nullable=False),
    # Serves: the contacts of a state or of a range of states, in order.
    PrimaryKeyConstraint("library_id", "ordinal", "position"),
    ForeignKeyConstraint(_OF_STATE, ["state.library_id", "state.ordinal"], ondelete="CASCADE"),
    CheckConstraint("stage BETWEEN 1 AND 3", name="stage_known"),
    CheckConstraint("position >= 0", name="position_not_negative"),
    one_of("bolt_region", BOLT_REGIONS),
    one_of("nut_region", NUT_REGIONS),
    one_of("features", FeaturePair),
    # Serve: filters bolt_region and nut_region (any contact of the state), in the default order.
    Index(None, "library_id", "bolt_region", "ordinal"),
    Index(None, "library_id", "nut_region", "ordinal"),
    sqlite_with_rowid=False,
)
"""A contact of a state; ``position`` is its place, from 0, among the state's contacts."""

state_flag = Table(
    "state_flag",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("flag", bytewise_string(NAME_LENGTH), nullable=False),
    # Serves: the flags of a state or of a range of states, in order.
    PrimaryKeyConstraint("library_id", "ordinal", "position"),
    ForeignKeyConstraint(_OF_STATE, ["state.library_id", "state.ordinal"], ondelete="CASCADE"),
    # Serves: filter flag in the default order; the counts of the summary. Unique: a state has a flag once.
    UniqueConstraint("library_id", "flag", "ordinal"),
    CheckConstraint("position >= 0", name="position_not_negative"),
    one_of("flag", Flag),
    sqlite_with_rowid=False,
)
"""A flag of a state; ``position`` is its place, from 0, among the state's flags."""

undecided = Table(
    "undecided",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("ordinal", Integer, nullable=False),
    Column("roll_deg", Double, nullable=False),
    Column("pitch_deg", Double, nullable=False),
    Column("phase_deg", Double, nullable=False),
    Column("reason", bytewise_text(), nullable=False),
    # Serves: the undecided poses in order, page by page; those of an orientation as a range.
    PrimaryKeyConstraint("library_id", "ordinal"),
    ForeignKeyConstraint(["library_id"], ["library.id"], ondelete="CASCADE"),
    # Serves: why a pose has no state.
    UniqueConstraint("library_id", "roll_deg", "pitch_deg", "phase_deg"),
    CheckConstraint("ordinal >= 0", name="ordinal_not_negative"),
    sqlite_with_rowid=False,
)
"""A pose of the grid that the solver method could not decide, in place of its state, and why."""
