"""The library's tables, from empty.

Revision ID: 0001
Revises: nothing
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_string, bytewise_text

revision = "0001"
down_revision = None
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "library",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("designation", bytewise_string(100), nullable=False),
        sa.Column("length_unit", bytewise_string(2), nullable=False),
        sa.Column("input_sha256", bytewise_string(64), nullable=False),
        sa.Column("pair", bytewise_text(), nullable=False),
        sa.Column("method", bytewise_string(32), nullable=False),
        sa.Column("options", bytewise_text(), nullable=False),
        sa.Column("code_version", bytewise_string(32), nullable=False),
        sa.Column("tilt_max_deg", sa.Double(), nullable=False),
        sa.Column("tilt_step_deg", sa.Double(), nullable=False),
        sa.Column("phase_step_deg", sa.Double(), nullable=False),
        sa.Column("tilt_count", sa.Integer(), nullable=False),
        sa.Column("phase_count", sa.Integer(), nullable=False),
        sa.Column("state_count", sa.Integer(), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=True),
        sa.Column("published_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("length_unit = 'in' OR length_unit = 'mm'", name=op.f("ck_library_length_unit_known")),
        sa.CheckConstraint(
            "(content_sha256 IS NULL) = (published_at IS NULL)", name=op.f("ck_library_published_with_content")
        ),
        sa.CheckConstraint(
            "state_count = tilt_count * tilt_count * phase_count", name=op.f("ck_library_state_count_of_grid")
        ),
        sa.CheckConstraint("tilt_count > 0 AND phase_count > 0", name=op.f("ck_library_grid_not_empty")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_library")),
        sa.UniqueConstraint("input_sha256", name=op.f("uq_library_input_sha256")),
    )
    op.create_index(
        op.f("ix_library_designation_published_at_id"), "library", ["designation", "published_at", "id"], unique=False
    )
    op.create_index(op.f("ix_library_published_at_id"), "library", ["published_at", "id"], unique=False)
    op.create_table(
        "chunk",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("roll_deg", sa.Double(), nullable=False),
        sa.Column("pitch_deg", sa.Double(), nullable=False),
        sa.Column("state_count", sa.Integer(), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=False),
        sa.CheckConstraint("orientation >= 0", name=op.f("ck_chunk_orientation_not_negative")),
        sa.CheckConstraint("state_count > 0", name=op.f("ck_chunk_not_empty")),
        sa.ForeignKeyConstraint(["library_id"], ["library.id"], name=op.f("fk_chunk_library"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("library_id", "orientation", name=op.f("pk_chunk")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "state",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("roll_deg", sa.Double(), nullable=False),
        sa.Column("pitch_deg", sa.Double(), nullable=False),
        sa.Column("phase_deg", sa.Double(), nullable=False),
        sa.Column("state_class", bytewise_string(32), nullable=False),
        sa.Column("lambda_deg", sa.Double(), nullable=True),
        sa.Column("mu_deg", sa.Double(), nullable=True),
        sa.Column("drop", sa.Double(), nullable=True),
        sa.Column("embedment", sa.Double(), nullable=True),
        sa.Column("pivot_offset", sa.Double(), nullable=True),
        sa.Column("drop_margin", sa.Double(), nullable=True),
        sa.Column("embedment_margin", sa.Double(), nullable=True),
        sa.Column("pivot_margin", sa.Double(), nullable=True),
        sa.CheckConstraint(
            "state_class = 'unstable_two_point' OR state_class = 'quasi_stable_two_point' OR "
            "state_class = 'stable_three_point'",
            name=op.f("ck_state_state_class_known"),
        ),
        sa.CheckConstraint("ordinal >= 0", name=op.f("ck_state_ordinal_not_negative")),
        sa.CheckConstraint("phase_deg >= 0 AND phase_deg < 360", name=op.f("ck_state_phase_in_turn")),
        sa.ForeignKeyConstraint(["library_id"], ["library.id"], name=op.f("fk_state_library"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("library_id", "ordinal", name=op.f("pk_state")),
        sa.UniqueConstraint(
            "library_id",
            "roll_deg",
            "pitch_deg",
            "phase_deg",
            name=op.f("uq_state_library_id_roll_deg_pitch_deg_phase_deg"),
        ),
        sqlite_with_rowid=False,
    )
    op.create_index(op.f("ix_state_library_id_drop_ordinal"), "state", ["library_id", "drop", "ordinal"], unique=False)
    op.create_index(
        op.f("ix_state_library_id_embedment_ordinal"), "state", ["library_id", "embedment", "ordinal"], unique=False
    )
    op.create_index(
        op.f("ix_state_library_id_lambda_deg_ordinal"), "state", ["library_id", "lambda_deg", "ordinal"], unique=False
    )
    op.create_index(
        op.f("ix_state_library_id_mu_deg_ordinal"), "state", ["library_id", "mu_deg", "ordinal"], unique=False
    )
    op.create_index(
        op.f("ix_state_library_id_phase_deg_ordinal"), "state", ["library_id", "phase_deg", "ordinal"], unique=False
    )
    op.create_index(
        op.f("ix_state_library_id_pitch_deg_ordinal"), "state", ["library_id", "pitch_deg", "ordinal"], unique=False
    )
    op.create_index(
        op.f("ix_state_library_id_pivot_offset_ordinal"),
        "state",
        ["library_id", "pivot_offset", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_state_library_id_state_class_ordinal"), "state", ["library_id", "state_class", "ordinal"], unique=False
    )
    op.create_table(
        "contact",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("stage", sa.Integer(), nullable=False),
        sa.Column("point_x", sa.Double(), nullable=False),
        sa.Column("point_y", sa.Double(), nullable=False),
        sa.Column("point_z", sa.Double(), nullable=False),
        sa.Column("point_bolt_x", sa.Double(), nullable=False),
        sa.Column("point_bolt_y", sa.Double(), nullable=False),
        sa.Column("point_bolt_z", sa.Double(), nullable=False),
        sa.Column("normal_x", sa.Double(), nullable=False),
        sa.Column("normal_y", sa.Double(), nullable=False),
        sa.Column("normal_z", sa.Double(), nullable=False),
        sa.Column("bolt_region", bytewise_string(32), nullable=False),
        sa.Column("nut_region", bytewise_string(32), nullable=False),
        sa.Column("features", bytewise_string(32), nullable=False),
        sa.Column("bolt_margin", sa.Double(), nullable=False),
        sa.Column("nut_margin", sa.Double(), nullable=False),
        sa.CheckConstraint(
            "bolt_region = 'root' OR bolt_region = 'root_fillet_pos' OR bolt_region = 'flank_pos' OR "
            "bolt_region = 'crest_fillet_pos' OR bolt_region = 'crest' OR "
            "bolt_region = 'crest_fillet_neg' OR bolt_region = 'flank_neg' OR "
            "bolt_region = 'root_fillet_neg' OR bolt_region = 'base'",
            name=op.f("ck_contact_bolt_region_known"),
        ),
        sa.CheckConstraint(
            "features = 'edge-edge' OR features = 'edge-surface' OR features = 'base-edge' OR "
            "features = 'edge-thread' OR features = 'thread-edge' OR features = 'thread-thread' OR "
            "features = 'flush'",
            name=op.f("ck_contact_features_known"),
        ),
        sa.CheckConstraint(
            "nut_region = 'crest' OR nut_region = 'crest_fillet_pos' OR nut_region = 'flank_pos' OR "
            "nut_region = 'root_fillet_pos' OR nut_region = 'root' OR nut_region = 'root_fillet_neg' OR "
            "nut_region = 'flank_neg' OR nut_region = 'crest_fillet_neg' OR nut_region = 'surface'",
            name=op.f("ck_contact_nut_region_known"),
        ),
        sa.CheckConstraint("position >= 0", name=op.f("ck_contact_position_not_negative")),
        sa.CheckConstraint("stage BETWEEN 1 AND 3", name=op.f("ck_contact_stage_known")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["state.library_id", "state.ordinal"],
            name=op.f("fk_contact_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "position", name=op.f("pk_contact")),
        sqlite_with_rowid=False,
    )
    op.create_index(
        op.f("ix_contact_library_id_bolt_region_ordinal"),
        "contact",
        ["library_id", "bolt_region", "ordinal"],
        unique=False,
    )
    op.create_index(
        op.f("ix_contact_library_id_nut_region_ordinal"),
        "contact",
        ["library_id", "nut_region", "ordinal"],
        unique=False,
    )
    op.create_table(
        "stage_pose",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("stage", sa.Integer(), nullable=False),
        sa.Column("r11", sa.Double(), nullable=False),
        sa.Column("r12", sa.Double(), nullable=False),
        sa.Column("r13", sa.Double(), nullable=False),
        sa.Column("r21", sa.Double(), nullable=False),
        sa.Column("r22", sa.Double(), nullable=False),
        sa.Column("r23", sa.Double(), nullable=False),
        sa.Column("r31", sa.Double(), nullable=False),
        sa.Column("r32", sa.Double(), nullable=False),
        sa.Column("r33", sa.Double(), nullable=False),
        sa.Column("tx", sa.Double(), nullable=False),
        sa.Column("ty", sa.Double(), nullable=False),
        sa.Column("tz", sa.Double(), nullable=False),
        sa.CheckConstraint("stage BETWEEN 1 AND 3", name=op.f("ck_stage_pose_stage_known")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["state.library_id", "state.ordinal"],
            name=op.f("fk_stage_pose_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "stage", name=op.f("pk_stage_pose")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "state_flag",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("flag", bytewise_string(32), nullable=False),
        sa.CheckConstraint(
            "flag = 'flush' OR flag = 'tie' OR flag = 'balanced' OR flag = 'grazing' OR "
            "flag = 'no_second' OR flag = 'no_third'",
            name=op.f("ck_state_flag_flag_known"),
        ),
        sa.CheckConstraint("position >= 0", name=op.f("ck_state_flag_position_not_negative")),
        sa.ForeignKeyConstraint(
            ["library_id", "ordinal"],
            ["state.library_id", "state.ordinal"],
            name=op.f("fk_state_flag_state"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "ordinal", "position", name=op.f("pk_state_flag")),
        sa.UniqueConstraint("library_id", "flag", "ordinal", name=op.f("uq_state_flag_library_id_flag_ordinal")),
        sqlite_with_rowid=False,
    )


def downgrade() -> None:
    """Drop the tables."""
    op.drop_table("state_flag")
    op.drop_table("stage_pose")
    op.drop_table("contact")
    op.drop_table("state")
    op.drop_table("chunk")
    op.drop_table("library")
