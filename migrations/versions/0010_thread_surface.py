"""Contacts of the bolt's thread with the nut's surface: one more pair of features.

On SQLite the text of the constraint is changed in the schema itself, as its documentation describes for constraints
(https://sqlite.org/lang_altertable.html): nothing is copied, however large the tables are.

Revision ID: 0010
Revises: 0009
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

revision = "0010"
down_revision = "0009"
branch_labels = None
depends_on = None

_TABLES = ("contact", "formation_contact", "clearance_window_course")
_BEFORE = ("edge-edge", "edge-surface", "base-edge", "edge-thread", "thread-edge", "thread-thread", "flush")
_AFTER = (*_BEFORE[:-1], "thread-surface", "flush")


def upgrade() -> None:
    """Let the features be these, too."""
    for table in _TABLES:
        _replace(table, _BEFORE, _AFTER)


def downgrade() -> None:
    """Let them be no more; libraries that have such contacts go."""
    library = sa.table("library", sa.column("id"))
    for name in _TABLES:
        such = sa.table(name, sa.column("library_id"), sa.column("features"))
        with_such = sa.select(such.c.library_id).where(such.c.features == "thread-surface")
        op.execute(sa.delete(library).where(library.c.id.in_(with_such)))
    for table in _TABLES:
        _replace(table, _AFTER, _BEFORE)


def _replace(table: str, before: tuple[str, ...], after: tuple[str, ...]) -> None:
    name = op.f(f"ck_{table}_features_known")
    if op.get_bind().dialect.name != "sqlite":
        op.drop_constraint(name, table, type_="check")
        op.create_check_constraint(name, table, _one_of(after))
        return
    connection = op.get_bind()
    version = connection.execute(sa.text("PRAGMA schema_version")).scalar_one()
    connection.execute(sa.text("PRAGMA writable_schema = ON"))
    connection.execute(
        sa.text("UPDATE sqlite_master SET sql = replace(sql, :before, :after) WHERE type = 'table' AND name = :name"),
        {"before": _one_of(before), "after": _one_of(after), "name": table},
    )
    connection.execute(sa.text(f"PRAGMA schema_version = {version + 1}"))
    connection.execute(sa.text("PRAGMA writable_schema = OFF"))


def _one_of(features: tuple[str, ...]) -> str:
    return " OR ".join(f"features = '{name}'" for name in features)
