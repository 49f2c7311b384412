"""How certain the heights of a snap are.

Revision ID: 0004
Revises: 0003
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0004"
down_revision = "0003"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Add the column; of the windows that are there it is not known."""
    op.add_column("clearance_window", sa.Column("snap_height_error", sa.Double(), nullable=True))


def downgrade() -> None:
    """Drop it."""
    op.drop_column("clearance_window", "snap_height_error")
