"""The statics of states under the default load, as columns with indexes.

States that are there have none until they are computed of their contacts.

Revision ID: 0009
Revises: 0008
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0009"
down_revision = "0008"
branch_labels = None
depends_on = None

_COLUMNS = ("support_margin", "mu_hold", "mu_wedge")


def upgrade() -> None:
    """Add the columns and their indexes."""
    for name in _COLUMNS:
        op.add_column("state", sa.Column(name, sa.Double(), nullable=True))
        op.create_index(op.f(f"ix_state_library_id_{name}_ordinal"), "state", ["library_id", name, "ordinal"])


def downgrade() -> None:
    """Drop them."""
    for name in reversed(_COLUMNS):
        op.drop_index(op.f(f"ix_state_library_id_{name}_ordinal"), table_name="state")
        op.drop_column("state", name)
