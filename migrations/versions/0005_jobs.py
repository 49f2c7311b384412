"""Jobs with what is left of them to do, workers, events, and keys.

Revision ID: 0005
Revises: 0004
"""

from __future__ import annotations

import sqlalchemy as sa
from alembic import op

from migrations.text import bytewise_string, bytewise_text

revision = "0005"
down_revision = "0004"
branch_labels = None
depends_on = None


def upgrade() -> None:
    """Make the tables."""
    op.create_table(
        "api_key",
        sa.Column("id", bytewise_string(12), nullable=False),
        sa.Column("name", bytewise_string(100), nullable=False),
        sa.Column("scope", bytewise_string(32), nullable=False),
        sa.Column("sha256", bytewise_string(64), nullable=False),
        sa.Column("created_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("revoked_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint("scope = 'read' OR scope = 'write'", name=op.f("ck_api_key_scope_known")),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_api_key")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "job",
        sa.Column("id", sa.Integer(), nullable=False),
        sa.Column("input_sha256", bytewise_string(64), nullable=False),
        sa.Column("inputs", bytewise_text(), nullable=False),
        sa.Column("code_version", bytewise_string(32), nullable=False),
        sa.Column("state", bytewise_string(32), nullable=False),
        sa.Column("reason", bytewise_text(), nullable=True),
        sa.Column("chunk_count", sa.Integer(), nullable=False),
        sa.Column("done_count", sa.Integer(), nullable=False),
        sa.Column("setback_count", sa.Integer(), nullable=False),
        sa.Column("event_count", sa.Integer(), nullable=False),
        sa.Column("asked_at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("ended_at", sa.DateTime(timezone=True), nullable=True),
        sa.CheckConstraint(
            "state = 'queued' OR state = 'running' OR state = 'done' OR state = 'failed' OR state = 'cancelled'",
            name=op.f("ck_job_state_known"),
        ),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_job")),
        sa.UniqueConstraint("input_sha256", name=op.f("uq_job_input_sha256")),
    )
    op.create_index(op.f("ix_job_state_id"), "job", ["state", "id"], unique=False)
    op.create_table(
        "job_worker",
        sa.Column("id", bytewise_string(32), nullable=False),
        sa.Column("name", bytewise_string(200), nullable=False),
        sa.Column("beat", sa.Integer(), nullable=False),
        sa.PrimaryKeyConstraint("id", name=op.f("pk_job_worker")),
        sqlite_with_rowid=False,
    )
    op.create_table(
        "job_chunk",
        sa.Column("job_id", sa.Integer(), nullable=False),
        sa.Column("orientation", sa.Integer(), nullable=False),
        sa.Column("worker_id", bytewise_string(32), nullable=True),
        sa.CheckConstraint("orientation >= 0", name=op.f("ck_job_chunk_orientation_not_negative")),
        sa.ForeignKeyConstraint(["job_id"], ["job.id"], name=op.f("fk_job_chunk_job"), ondelete="CASCADE"),
        sa.ForeignKeyConstraint(
            ["worker_id"], ["job_worker.id"], name=op.f("fk_job_chunk_job_worker"), ondelete="SET NULL"
        ),
        sa.PrimaryKeyConstraint("job_id", "orientation", name=op.f("pk_job_chunk")),
        sqlite_with_rowid=False,
    )
    op.create_index(op.f("ix_job_chunk_worker_id"), "job_chunk", ["worker_id"], unique=False)
    op.create_table(
        "job_event",
        sa.Column("job_id", sa.Integer(), nullable=False),
        sa.Column("number", sa.Integer(), nullable=False),
        sa.Column("kind", bytewise_string(32), nullable=False),
        sa.Column("at", sa.DateTime(timezone=True), nullable=False),
        sa.Column("done_count", sa.Integer(), nullable=False),
        sa.Column("reason", bytewise_text(), nullable=True),
        sa.CheckConstraint(
            "kind = 'queued' OR kind = 'started' OR kind = 'progress' OR kind = 'published' OR "
            "kind = 'failed' OR kind = 'cancelled'",
            name=op.f("ck_job_event_kind_known"),
        ),
        sa.ForeignKeyConstraint(["job_id"], ["job.id"], name=op.f("fk_job_event_job"), ondelete="CASCADE"),
        sa.PrimaryKeyConstraint("job_id", "number", name=op.f("pk_job_event")),
        sqlite_with_rowid=False,
    )


def downgrade() -> None:
    """Drop them; the libraries that were asked for stay."""
    op.drop_table("job_event")
    op.drop_table("job_chunk")
    op.drop_table("job_worker")
    op.drop_table("job")
    op.drop_table("api_key")
