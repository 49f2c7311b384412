"""Where the bolt goes down: descents, their jumps and the steepest fall of every orientation.

The jump at which a window was entered was a part of the window; it is one of a descent now. Orientations that have a
history from before have no descents until these are computed.

Revision ID: 0006
Revises: 0005
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0006"
down_revision = "0005"
branch_labels = None
depends_on = None

_SNAP = ("snap_deg", "snap_width_deg", "snap_height_before", "snap_height_after", "snap_height_error")


def upgrade() -> None:
    """Add the tables, drop the windows' columns."""
    op.create_table(
        "descent",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("start_deg", sa.Double(), nullable=False),
        sa.Column("end_deg", sa.Double(), nullable=False),
        sa.Column("start_height", sa.Double(), nullable=False),
        sa.Column("end_height", sa.Double(), nullable=False),
        sa.Column("fall_error", sa.Double(), nullable=False),
        sa.Column("undecided_deg", sa.Double(), nullable=False),
        sa.CheckConstraint(
            "start_deg >= 0 AND start_deg < 360 AND end_deg >= start_deg", name=op.f("ck_descent_phases_in_order")
        ),
        sa.CheckConstraint("start_height > end_height", name=op.f("ck_descent_falls")),
        _of_chunk("descent"),
        sa.PrimaryKeyConstraint("library_id", "orientation", "position", name=op.f("pk_descent")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "descent_jump",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("position", sa.Integer(), nullable=False),
        sa.Column("place", sa.Integer(), nullable=False),
        sa.Column("phase_deg", sa.Double(), nullable=False),
        sa.Column("width_deg", sa.Double(), nullable=False),
        sa.Column("height_before", sa.Double(), nullable=False),
        sa.Column("height_after", sa.Double(), nullable=False),
        sa.Column("height_error", sa.Double(), nullable=False),
        sa.ForeignKeyConstraint(
            ["library_id", "orientation", "position"],
            ["descent.library_id", "descent.orientation", "descent.position"],
            name=op.f("fk_descent_jump_descent"),
            ondelete="CASCADE",
        ),
        sa.PrimaryKeyConstraint("library_id", "orientation", "position", "place", name=op.f("pk_descent_jump")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "steepest_fall",
        sa.Column("library_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("fall", sa.Double(), nullable=False),
        sa.Column("start_deg", sa.Double(), nullable=True),
        sa.Column("descent", sa.Integer(), nullable=True),
        _of_chunk("steepest_fall"),
        sa.PrimaryKeyConstraint("library_id", "orientation", name=op.f("pk_steepest_fall")),
        sqlite_with_rowid=False,
    )
    for column in _SNAP:
        op.drop_column("clearance_window", column)


def downgrade() -> None:
    """Drop the tables; of the windows that are there the jumps are not known."""
    for column in _SNAP:
        op.add_column("clearance_window", sa.Column(column, sa.Double(), nullable=True))
    op.drop_table("steepest_fall")
    op.drop_table("descent_jump")
    op.drop_table("descent")


def _of_chunk(table: str) -> sa.ForeignKeyConstraint:
    return sa.ForeignKeyConstraint(
        ["library_id", "orientation"],
        ["chunk.library_id", "chunk.orientation"],
        name=op.f(f"fk_{table}_chunk"),
        ondelete="CASCADE",
    )
