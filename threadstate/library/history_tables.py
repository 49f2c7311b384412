"""The tables of stored histories: the phase circle of every orientation, cut where anything changes.

``orientation`` is the number of the chunk, ``position`` a place in it from 0 in the order of phase. Angles are in
degrees, lengths in the unit of the library's row. All of an orientation is written with its chunk.
"""

from __future__ import annotations

from sqlalchemy import (
    Boolean,
    CheckConstraint,
    Column,
    Double,
    ForeignKeyConstraint,
    Index,
    Integer,
    PrimaryKeyConstraint,
    Table,
)

from threadstate.library.column_types import bytewise_string, bytewise_text
from threadstate.library.tables import NAME_LENGTH, metadata, one_of
from threadstate.state.model import FeaturePair, StateClass
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS

KEY_LENGTH = 10
_OF_CHUNK = ("library_id", "orientation")
_OF_FORMATION = ("library_id", "formation")
_OF_BOUNDARY = ("library_id", "orientation", "position")
_OF_WINDOW = ("library_id", "orientation", "position")
_OF_DESCENT = ("library_id", "orientation", "position")

formation = Table(
    "formation",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("formation", bytewise_string(KEY_LENGTH), nullable=False),
    # Null where the solver is not certain of the states.
    Column("state_class", bytewise_string(NAME_LENGTH)),
    # Serves: the formations of a library; one by its key.
    PrimaryKeyConstraint(*_OF_FORMATION),
    ForeignKeyConstraint(["library_id"], ["library.id"], ondelete="CASCADE"),
    one_of("state_class", StateClass),
    sqlite_with_rowid=False,
)
"""A contact formation that occurs in a library: a class and contacts by their labels; its key is a hash of them."""

formation_contact = Table(
    "formation_contact",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("formation", bytewise_string(KEY_LENGTH), nullable=False),
    Column("position", Integer, nullable=False),
    Column("stage", Integer, nullable=False),
    Column("bolt_region", bytewise_string(NAME_LENGTH), nullable=False),
    Column("nut_region", bytewise_string(NAME_LENGTH), nullable=False),
    Column("features", bytewise_string(NAME_LENGTH), nullable=False),
    # Serves: the contacts of all formations, in order.
    PrimaryKeyConstraint(*_OF_FORMATION, "position"),
    ForeignKeyConstraint(_OF_FORMATION, ["formation.library_id", "formation.formation"], ondelete="CASCADE"),
    CheckConstraint("stage BETWEEN 1 AND 3", name="stage_known"),
    one_of("bolt_region", BOLT_REGIONS),
    one_of("nut_region", NUT_REGIONS),
    one_of("features", FeaturePair),
    sqlite_with_rowid=False,
)
"""A contact of a formation."""

history_interval = Table(
    "history_interval",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("start_deg", Double, nullable=False),
    Column("end_deg", Double, nullable=False),
    Column("formation", bytewise_string(KEY_LENGTH), nullable=False),
    # Names separated by spaces.
    Column("flags", bytewise_text(), nullable=False),
    # At the middle; null where the state there is not decided, the margin also where nothing has one.
    Column("margin", Double),
    Column("first_height", Double),
    Column("last_height", Double),
    Column("in_window", Boolean, nullable=False),
    # Serves: the intervals of an orientation, and of all, in order.
    PrimaryKeyConstraint(*_OF_CHUNK, "position"),
    ForeignKeyConstraint(_OF_CHUNK, ["chunk.library_id", "chunk.orientation"], ondelete="CASCADE"),
    ForeignKeyConstraint(_OF_FORMATION, ["formation.library_id", "formation.formation"], ondelete="CASCADE"),
    CheckConstraint("start_deg >= 0 AND start_deg < 360 AND end_deg > start_deg", name="phases_in_order"),
    # Serves: the occurrences of a formation.
    Index(None, *_OF_FORMATION, "orientation", "position"),
    sqlite_with_rowid=False,
)
"""Phases over which every label of an orientation's states is the same; the one that holds phase 0 ends above 360."""

history_boundary = Table(
    "history_boundary",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("low_deg", Double, nullable=False),
    Column("high_deg", Double, nullable=False),
    # At the low and at the high end; null where the state there is not decided.
    Column("first_height_before", Double),
    Column("first_height_after", Double),
    Column("last_height_before", Double),
    Column("last_height_after", Double),
    # Flags, separated by spaces, of labels that hold at single phases in between.
    Column("flags_between", bytewise_text(), nullable=False),
    # Serves: the boundaries of an orientation, and of all, in order.
    PrimaryKeyConstraint(*_OF_BOUNDARY),
    ForeignKeyConstraint(_OF_CHUNK, ["chunk.library_id", "chunk.orientation"], ondelete="CASCADE"),
    CheckConstraint("low_deg <= high_deg", name="phases_in_order"),
    sqlite_with_rowid=False,
)
"""Where the interval of the same position begins: between two phases that were solved."""

history_boundary_contact = Table(
    "history_boundary_contact",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("stage", Integer, nullable=False),
    Column("place", Integer, nullable=False),
    *(
        column
        for side in ("before", "after")
        for column in (
            *(
                Column(f"{name}_{side}", bytewise_string(NAME_LENGTH))
                for name in ("bolt_region", "nut_region", "features")
            ),
            *(Column(f"normal_{axis}_{side}", Double) for axis in "xyz"),
        )
    ),
    Column("moved", Double),
    # Serves: what changes at a boundary, and at all, in order.
    PrimaryKeyConstraint(*_OF_BOUNDARY, "stage", "place"),
    ForeignKeyConstraint(_OF_BOUNDARY, [f"history_boundary.{column}" for column in _OF_BOUNDARY], ondelete="CASCADE"),
    CheckConstraint("stage BETWEEN 1 AND 3", name="stage_known"),
    sqlite_with_rowid=False,
)
"""A contact that changes at a boundary: the ``place``-th, from 0, of its stage; null where it is not there."""

clearance_window = Table(
    "clearance_window",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    *(Column(name, Double, nullable=False) for name in ("enter_deg", "leave_deg", "enter_height", "leave_height")),
    *(Column(name, Double, nullable=False) for name in ("lowest_deg", "lowest_height")),
    # Serves: the windows of an orientation, and of all, in order.
    PrimaryKeyConstraint(*_OF_WINDOW),
    ForeignKeyConstraint(_OF_CHUNK, ["chunk.library_id", "chunk.orientation"], ondelete="CASCADE"),
    CheckConstraint("leave_deg > enter_deg", name="phases_in_order"),
    sqlite_with_rowid=False,
)
"""A clearance window of an orientation, met when the bolt is turned counter-clockwise."""

clearance_window_course = Table(
    "clearance_window_course",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("place", Integer, nullable=False),
    Column("features", bytewise_string(NAME_LENGTH), nullable=False),
    *(Column(name, Double, nullable=False) for name in ("start_deg", "end_deg", "start_height", "end_height")),
    # Serves: the courses of a window, and of all, in order.
    PrimaryKeyConstraint(*_OF_WINDOW, "place"),
    ForeignKeyConstraint(_OF_WINDOW, [f"clearance_window.{column}" for column in _OF_WINDOW], ondelete="CASCADE"),
    one_of("features", FeaturePair),
    sqlite_with_rowid=False,
)
"""A stretch of a window over which the first contact is of the same features and its height does not jump."""

descent = Table(
    "descent",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    *(Column(name, Double, nullable=False) for name in ("start_deg", "end_deg", "start_height", "end_height")),
    *(Column(name, Double, nullable=False) for name in ("fall_error", "undecided_deg")),
    # Serves: the descents of an orientation, and of all, in order.
    PrimaryKeyConstraint(*_OF_DESCENT),
    ForeignKeyConstraint(_OF_CHUNK, ["chunk.library_id", "chunk.orientation"], ondelete="CASCADE"),
    CheckConstraint("start_deg >= 0 AND start_deg < 360 AND end_deg >= start_deg", name="phases_in_order"),
    CheckConstraint("start_height > end_height", name="falls"),
    sqlite_with_rowid=False,
)
"""Where the bolt, turned counter-clockwise, goes down; one that holds phase 0 ends above 360."""

descent_jump = Table(
    "descent_jump",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("position", Integer, nullable=False),
    Column("place", Integer, nullable=False),
    *(Column(name, Double, nullable=False) for name in ("phase_deg", "width_deg")),
    *(Column(name, Double, nullable=False) for name in ("height_before", "height_after", "height_error")),
    # Serves: the jumps of a descent, and of all, in order.
    PrimaryKeyConstraint(*_OF_DESCENT, "place"),
    ForeignKeyConstraint(_OF_DESCENT, [f"descent.{column}" for column in _OF_DESCENT], ondelete="CASCADE"),
    sqlite_with_rowid=False,
)
"""A fall of the height at one phase, within a descent."""

steepest_fall = Table(
    "steepest_fall",
    metadata,
    Column("library_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    Column("fall", Double, nullable=False),
    # Null where the bolt never goes down.
    Column("start_deg", Double),
    Column("descent", Integer),
    # Serves: the steepest fall of an orientation, and of all, in order.
    PrimaryKeyConstraint(*_OF_CHUNK),
    ForeignKeyConstraint(_OF_CHUNK, ["chunk.library_id", "chunk.orientation"], ondelete="CASCADE"),
    sqlite_with_rowid=False,
)
"""An orientation's largest fall within three degrees of phase; one row for every orientation that has a history."""
