"""Histories of the orientations, and the formations that occur in them.

Revision ID: 0003
Revises: 0002
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_string, bytewise_text

revision = "0003"
down_revision = "0002"
branch_labels = None
depends_on = None

_CLASSES = (
    "unstable_two_point",
    "quasi_stable_two_point",
    "stable_three_point",
)
_BOLT_REGIONS = (
    "root",
    "root_fillet_pos",
    "flank_pos",
    "crest_fillet_pos",
    "crest",
    "crest_fillet_neg",
    "flank_neg",
    "root_fillet_neg",
    "base",
)
_NUT_REGIONS = (
    "crest",
    "crest_fillet_pos",
    "flank_pos",
    "root_fillet_pos",
    "root",
    "root_fillet_neg",
    "flank_neg",
    "crest_fillet_neg",
    "surface",
)
_FEATURES = (
    "edge-edge",
    "edge-surface",
    "base-edge",
    "edge-thread",
    "thread-edge",
    "thread-thread",
    "flush",
)


def _one_of(column: str, names: tuple[str, ...]) -> str:
    return " OR ".join(f"{column} = '{name}'" for name in names)


def upgrade() -> None:
    """Make the tables; the libraries that are there have no histories."""
    op.create_table(
        "formation",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("formation", bytewise_string(10), nullable=False),
        sa.Column("state_class", bytewise_string(32), nullable=True),
        sa.CheckConstraint(
            _one_of("state_class", _CLASSES),
            name=op.f("ck_formation_state_class_known"),
        ),
        sa.ForeignKeyConstraint(["library_id"], ["library.id"], name=op.f("fk_formation_library"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("library_id", "formation", name=op.f("pk_formation")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "clearance_window",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("enter_deg", sa.Double(), nullable=False),
        sa.Column("leave_deg", sa.Double(), nullable=False),
        sa.Column("enter_height", sa.Double(), nullable=False),
        sa.Column("leave_height", sa.Double(), nullable=False),
        sa.Column("lowest_deg", sa.Double(), nullable=False),
        sa.Column("lowest_height", sa.Double(), nullable=False),
        sa.Column("snap_deg", sa.Double(), nullable=True),
        sa.Column("snap_width_deg", sa.Double(), nullable=True),
        sa.Column("snap_height_before", sa.Double(), nullable=True),
        sa.Column("snap_height_after", sa.Double(), nullable=True),
        sa.CheckConstraint("leave_deg > enter_deg", name=op.f("ck_clearance_window_phases_in_order")),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation"],
            ["chunk.library_id", "chunk.orientation"],
            name=op.f("fk_clearance_window_chunk"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "orientation", "position", name=op.f("pk_clearance_window")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "formation_contact",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("formation", bytewise_string(10), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("stage", sa.Integer(), nullable=False),
        sa.Column("bolt_region", bytewise_string(32), nullable=False),
        sa.Column("nut_region", bytewise_string(32), nullable=False),
        sa.Column("features", bytewise_string(32), nullable=False),
        sa.CheckConstraint(
            _one_of("bolt_region", _BOLT_REGIONS),
            name=op.f("ck_formation_contact_bolt_region_known"),
        ),
        sa.CheckConstraint(
            _one_of("features", _FEATURES),
            name=op.f("ck_formation_contact_features_known"),
        ),
        sa.CheckConstraint(
            _one_of("nut_region", _NUT_REGIONS),
            name=op.f("ck_formation_contact_nut_region_known"),
        ),
        sa.CheckConstraint("stage BETWEEN 1 AND 3", name=op.f("ck_formation_contact_stage_known")),
        sa.ForeignKeyConstraint(
            ["library_id", "formation"],
            ["formation.library_id", "formation.formation"],
            name=op.f("fk_formation_contact_formation"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "formation", "position", name=op.f("pk_formation_contact")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "history_boundary",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("low_deg", sa.Double(), nullable=False),
        sa.Column("high_deg", sa.Double(), nullable=False),
        sa.Column("first_height_before", sa.Double(), nullable=True),
        sa.Column("first_height_after", sa.Double(), nullable=True),
        sa.Column("last_height_before", sa.Double(), nullable=True),
        sa.Column("last_height_after", sa.Double(), nullable=True),
        sa.Column("flags_between", bytewise_text(), nullable=False),
        sa.CheckConstraint("low_deg <= high_deg", name=op.f("ck_history_boundary_phases_in_order")),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation"],
            ["chunk.library_id", "chunk.orientation"],
            name=op.f("fk_history_boundary_chunk"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "orientation", "position", name=op.f("pk_history_boundary")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "history_interval",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("start_deg", sa.Double(), nullable=False),
        sa.Column("end_deg", sa.Double(), nullable=False),
        sa.Column("formation", bytewise_string(10), nullable=False),
        sa.Column("flags", bytewise_text(), nullable=False),
        sa.Column("margin", sa.Double(), nullable=True),
        sa.Column("first_height", sa.Double(), nullable=True),
        sa.Column("last_height", sa.Double(), nullable=True),
        sa.Column("in_window", sa.Boolean(), nullable=False),
        sa.CheckConstraint(
            "start_deg >= 0 AND start_deg < 360 AND end_deg > start_deg",
            name=op.f("ck_history_interval_phases_in_order"),
        ),
        sa.ForeignKeyConstraint(
            ["library_id", "formation"],
            ["formation.library_id", "formation.formation"],
            name=op.f("fk_history_interval_formation"),
            ondelete="CASCADE",
        ),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation"],
            ["chunk.library_id", "chunk.orientation"],
            name=op.f("fk_history_interval_chunk"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "orientation", "position", name=op.f("pk_history_interval")),
        sqlite_with_rowid=False,
    )
    op.create_index(
        op.f("ix_history_interval_library_id_formation_orientation_position"),
        "history_interval",
        ["library_id", "formation", "orientation", "position"],
        unique=False,
    )
    op.create_table(
        "clearance_window_course",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("features", bytewise_string(32), nullable=False),
        sa.Column("start_deg", sa.Double(), nullable=False),
        sa.Column("end_deg", sa.Double(), nullable=False),
        sa.Column("start_height", sa.Double(), nullable=False),
        sa.Column("end_height", sa.Double(), nullable=False),
        sa.CheckConstraint(
            _one_of("features", _FEATURES),
            name=op.f("ck_clearance_window_course_features_known"),
        ),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation", "position"],
            ["clearance_window.library_id", "clearance_window.orientation", "clearance_window.position"],
            name=op.f("fk_clearance_window_course_clearance_window"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint(
            "library_id", "orientation", "position", "place", name=op.f("pk_clearance_window_course")
        ),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "history_boundary_contact",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("stage", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("bolt_region_before", bytewise_string(32), nullable=True),
        sa.Column("nut_region_before", bytewise_string(32), nullable=True),
        sa.Column("features_before", bytewise_string(32), nullable=True),
        sa.Column("normal_x_before", sa.Double(), nullable=True),
        sa.Column("normal_y_before", sa.Double(), nullable=True),
        sa.Column("normal_z_before", sa.Double(), nullable=True),
        sa.Column("bolt_region_after", bytewise_string(32), nullable=True),
        sa.Column("nut_region_after", bytewise_string(32), nullable=True),
        sa.Column("features_after", bytewise_string(32), nullable=True),
        sa.Column("normal_x_after", sa.Double(), nullable=True),
        sa.Column("normal_y_after", sa.Double(), nullable=True),
        sa.Column("normal_z_after", sa.Double(), nullable=True),
        sa.Column("moved", sa.Double(), nullable=True),
        sa.CheckConstraint("stage BETWEEN 1 AND 3", name=op.f("ck_history_boundary_contact_stage_known")),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation", "position"],
            ["history_boundary.library_id", "history_boundary.orientation", "history_boundary.position"],
            name=op.f("fk_history_boundary_contact_history_boundary"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint(
            "library_id", "orientation", "position", "stage", "place", name=op.f("pk_history_boundary_contact")
        ),
        sqlite_with_rowid=False,
    )


def downgrade() -> None:
    """Drop them."""
    op.drop_table("history_boundary_contact")
    op.drop_table("clearance_window_course")
    op.drop_index(op.f("ix_history_interval_library_id_formation_orientation_position"), table_name="history_interval")
    op.drop_table("history_interval")
    op.drop_table("history_boundary")
    op.drop_table("formation_contact")
    op.drop_table("clearance_window")
    op.drop_table("formation")
