"""Libraries of settled states: where a bolt comes to rest that a device holds.

Revision ID: 0011
Revises: 0010
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_string, bytewise_text

revision = "0011"
down_revision = "0010"
branch_labels = None
depends_on = None

_TABLES = ("settled_library", "settled_chunk", "settled_state", "settled_contact", "settled_fall", "settled_flag")


def upgrade() -> None:
    """Make the tables."""
    _create_library()
    _create_state()
    _create_parts_of_states()


def downgrade() -> None:
    """Drop them."""
    for name in reversed(_TABLES):
        op.drop_table(name)


def _create_library() -> None:
    op.create_table(
        "settled_library",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("designation", bytewise_string(100), nullable=False),
        sa.Column("length_unit", bytewise_string(2), nullable=False),
        sa.Column("input_sha256", bytewise_string(64), nullable=False),
        sa.Column("pair", bytewise_text(), nullable=False),
        sa.Column("device", bytewise_text(), nullable=False),
        sa.Column("code_version", bytewise_string(32), nullable=False),
        sa.Column("tilt_max_deg", sa.Double(), nullable=False),
        sa.Column("tilt_step_deg", sa.Double(), nullable=False),
        sa.Column("phase_step_deg", sa.Double(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=True),
        sa.Column("published_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "length_unit = 'in' OR length_unit = 'mm'", name=op.f("ck_settled_library_length_unit_known")
        ),
        sa.CheckConstraint(
            "(content_sha256 IS NULL) = (published_at IS NULL)", name=op.f("ck_settled_library_published_with_content")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_settled_library")),
        sa.UniqueConstraint("input_sha256", name=op.f("uq_settled_library_input_sha256")),
    )
    op.create_index(op.f("ix_settled_library_published_at_id"), "settled_library", ["published_at", "id"], unique=False)
    op.create_table(
        "settled_chunk",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("state_count", sa.Integer(), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=False),
        sa.CheckConstraint("orientation >= 0", name=op.f("ck_settled_chunk_orientation_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id"], ["settled_library.id"], name=op.f("fk_settled_chunk_settled_library"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("library_id", "orientation", name=op.f("pk_settled_chunk")),
        sqlite_with_rowid=False,
    )


def _create_state() -> None:
    op.create_table(
        "settled_state",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("roll_deg", sa.Double(), nullable=False),
        sa.Column("pitch_deg", sa.Double(), nullable=False),
        sa.Column("phase_deg", sa.Double(), nullable=False),
        sa.Column("outcome", bytewise_string(32), nullable=False),
        sa.Column("contact_count", sa.Integer(), nullable=False),
        sa.Column("fall_count", sa.Integer(), nullable=False),
        sa.Column("r11", sa.Double(), nullable=True),
        sa.Column("r12", sa.Double(), nullable=True),
        sa.Column("r13", sa.Double(), nullable=True),
        sa.Column("r21", sa.Double(), nullable=True),
        sa.Column("r22", sa.Double(), nullable=True),
        sa.Column("r23", sa.Double(), nullable=True),
        sa.Column("r31", sa.Double(), nullable=True),
        sa.Column("r32", sa.Double(), nullable=True),
        sa.Column("r33", sa.Double(), nullable=True),
        sa.Column("tx", sa.Double(), nullable=True),
        sa.Column("ty", sa.Double(), nullable=True),
        sa.Column("tz", sa.Double(), nullable=True),
        sa.Column("shift_x", sa.Double(), nullable=True),
        sa.Column("shift_y", sa.Double(), nullable=True),
        sa.Column("shift_z", sa.Double(), nullable=True),
        sa.Column("rotation_x_deg", sa.Double(), nullable=True),
        sa.Column("rotation_y_deg", sa.Double(), nullable=True),
        sa.Column("rotation_z_deg", sa.Double(), nullable=True),
        sa.Column("elastic_energy", sa.Double(), nullable=True),
        sa.Column("force_margin", sa.Double(), nullable=True),
        sa.Column("gap_margin", sa.Double(), nullable=True),
        sa.Column("stability_margin", sa.Double(), nullable=True),
        sa.Column("residual_margin", sa.Double(), nullable=True),
        sa.Column("pressure_margin", sa.Double(), nullable=True),
        sa.CheckConstraint("ordinal >= 0", name=op.f("ck_settled_state_ordinal_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id"], ["settled_library.id"], name=op.f("fk_settled_state_settled_library"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", name=op.f("pk_settled_state")),
        sa.UniqueConstraint(
            "library_id",
            "roll_deg",
            "pitch_deg",
            "phase_deg",
            name=op.f("uq_settled_state_library_id_roll_deg_pitch_deg_phase_deg"),
        ),
        sqlite_with_rowid=False,
    )
    op.create_index(
        op.f("ix_settled_state_library_id_contact_count_ordinal"),
        "settled_state",
        ["library_id", "contact_count", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_settled_state_library_id_fall_count_ordinal"),
        "settled_state",
        ["library_id", "fall_count", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_settled_state_library_id_outcome_ordinal"),
        "settled_state",
        ["library_id", "outcome", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_settled_state_library_id_phase_deg_ordinal"),
        "settled_state",
        ["library_id", "phase_deg", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_settled_state_library_id_pitch_deg_ordinal"),
        "settled_state",
        ["library_id", "pitch_deg", "ordinal"],
        unique=False,
    )


def _create_parts_of_states() -> None:
    op.create_table(
        "settled_contact",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("point_x", sa.Double(), nullable=False),
        sa.Column("point_y", sa.Double(), nullable=False),
        sa.Column("point_z", sa.Double(), nullable=False),
        sa.Column("normal_x", sa.Double(), nullable=False),
        sa.Column("normal_y", sa.Double(), nullable=False),
        sa.Column("normal_z", sa.Double(), nullable=False),
        sa.Column("features", bytewise_string(32), nullable=False),
        sa.Column("force_x", sa.Double(), nullable=False),
        sa.Column("force_y", sa.Double(), nullable=False),
        sa.Column("force_z", sa.Double(), nullable=False),
        sa.CheckConstraint("position >= 0", name=op.f("ck_settled_contact_position_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["settled_state.library_id", "settled_state.ordinal"],
            name=op.f("fk_settled_contact_settled_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "position", name=op.f("pk_settled_contact")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "settled_fall",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("push", sa.Double(), nullable=False),
        sa.Column("drop", sa.Double(), nullable=False),
        sa.Column("way", sa.Double(), nullable=False),
        sa.Column("energy", sa.Double(), nullable=False),
        sa.CheckConstraint("position >= 0", name=op.f("ck_settled_fall_position_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["settled_state.library_id", "settled_state.ordinal"],
            name=op.f("fk_settled_fall_settled_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "position", name=op.f("pk_settled_fall")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "settled_flag",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("flag", bytewise_string(32), nullable=False),
        sa.CheckConstraint("position >= 0", name=op.f("ck_settled_flag_position_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["settled_state.library_id", "settled_state.ordinal"],
            name=op.f("fk_settled_flag_settled_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "position", name=op.f("pk_settled_flag")),
        sa.UniqueConstraint("library_id", "flag", "ordinal", name=op.f("uq_settled_flag_library_id_flag_ordinal")),
        sqlite_with_rowid=False,
    )
