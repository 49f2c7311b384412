"""Poses that a library's method could not decide.

Revision ID: 0002
Revises: 0001
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_text

revision = "0002"
down_revision = "0001"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the table; the libraries that are there have no such poses."""
    op.add_column("library", sa.Column("undecided_count", sa.Integer(), server_default="0", nullable=False))
    op.create_table(
        "undecided",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("ordinal", sa.Integer(), nullable=False),
        sa.Column("roll_deg", sa.Double(), nullable=False),
        sa.Column("pitch_deg", sa.Double(), nullable=False),
        sa.Column("phase_deg", sa.Double(), nullable=False),
        sa.Column("reason", bytewise_text(), nullable=False),
        sa.CheckConstraint("ordinal >= 0", name=op.f("ck_undecided_ordinal_not_negative")),
        sa.ForeignKeyConstraint(["library_id"], ["library.id"], name=op.f("fk_undecided_library"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("library_id", "ordinal", name=op.f("pk_undecided")),
        sa.UniqueConstraint(
            "library_id",
            "roll_deg",
            "pitch_deg",
            "phase_deg",
            name=op.f("uq_undecided_library_id_roll_deg_pitch_deg_phase_deg"),
        ),
        sqlite_with_rowid=False,
    )


def downgrade() -> None:
    """Drop them; libraries with undecided poses go with them, as nothing would say that they are not whole."""
    op.execute("DELETE FROM library WHERE id IN (SELECT library_id FROM undecided)")
    op.drop_table("undecided")
    op.drop_column("library", "undecided_count")
