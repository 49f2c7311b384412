"""The library that ``latest`` means may be pinned.

Revision ID: 0007
Revises: 0006
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0007"
down_revision = "0006"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Add the column; none of the libraries that are there is pinned."""
    op.add_column("library", sa.Column("pinned_at", sa.DateTime(timezone=True), nullable=True))
    op.create_index(op.f("ix_library_pinned_at"), "library", ["pinned_at"], unique=False)


def downgrade() -> None:
    """Drop it; the library published last is the latest again."""
    op.drop_index(op.f("ix_library_pinned_at"), table_name="library")
    op.drop_column("library", "pinned_at")
