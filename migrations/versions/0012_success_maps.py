"""Success maps, and jobs of several kinds.

Revision ID: 0012
Revises: 0011
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_string, bytewise_text

revision = "0012"
down_revision = "0011"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the tables; the jobs that are there are of libraries of contact states."""
    op.add_column("job", sa.Column("kind", bytewise_string(32), server_default="library", nullable=False))
    op.create_table(
        "success_map",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("designation", bytewise_string(100), nullable=False),
        sa.Column("length_unit", bytewise_string(2), nullable=False),
        sa.Column("input_sha256", bytewise_string(64), nullable=False),
        sa.Column("inputs", bytewise_text(), nullable=False),
        sa.Column("code_version", bytewise_string(32), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=True),
        sa.Column("published_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("length_unit = 'in' OR length_unit = 'mm'", name=op.f("ck_success_map_length_unit_known")),
        sa.CheckConstraint(
            "(content_sha256 IS NULL) = (published_at IS NULL)", name=op.f("ck_success_map_published_with_content")
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_success_map")),
        sa.UniqueConstraint("input_sha256", name=op.f("uq_success_map_input_sha256")),
    )
    op.create_index(op.f("ix_success_map_published_at_id"), "success_map", ["published_at", "id"], unique=False)
    op.create_table(
        "success_orientation",
        sa.Column("map_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("roll_deg", sa.Double(), nullable=False),
        sa.Column("pitch_deg", sa.Double(), nullable=False),
        sa.Column("content_sha256", bytewise_string(64), nullable=False),
        sa.Column("document", bytewise_text(), nullable=False),
        sa.CheckConstraint("orientation >= 0", name=op.f("ck_success_orientation_orientation_not_negative")),
        sa.ForeignKeyConstraint(
            ["map_id"], ["success_map.id"], name=op.f("fk_success_orientation_success_map"), ondelete="CASCADE"
        ),
        sa.PrimaryKeyConstraint("map_id", "orientation", name=op.f("pk_success_orientation")),
        sa.UniqueConstraint(
            "map_id", "roll_deg", "pitch_deg", name=op.f("uq_success_orientation_map_id_roll_deg_pitch_deg")
        ),
        sqlite_with_rowid=False,
    )


def downgrade() -> None:
    """Drop them, and the jobs that the code before does not know."""
    op.execute("DELETE FROM job WHERE kind <> 'library'")
    op.drop_column("job", "kind")
    op.drop_table("success_orientation")
    op.drop_table("success_map")
