"""The tables of jobs. No column is a deadline: who is silent is found by those who watch (decision 10)."""

from __future__ import annotations

from sqlalchemy import (
    CheckConstraint,
    Column,
    ForeignKeyConstraint,
    Index,
    Integer,
    PrimaryKeyConstraint,
    Table,
    UniqueConstraint,
)

from threadstate.jobs.names import EventKind, JobState
from threadstate.library.tables import NAME_LENGTH, SHA256_LENGTH, metadata, one_of
from threadstate.library.text import bytewise_string, bytewise_text
from threadstate.library.utc import UtcDateTime

WORKER_ID_LENGTH = 32
WORKER_NAME_LENGTH = 200

job = Table(
    "job",
    metadata,
    Column("id", Integer, nullable=False),
    # The library that is to be there: its inputs as JSON, and the hash that is theirs by the code that was asked.
    Column("input_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("inputs", bytewise_text(), nullable=False),
    Column("code_version", bytewise_string(NAME_LENGTH), nullable=False),
    Column("state", bytewise_string(NAME_LENGTH), nullable=False),
    Column("reason", bytewise_text()),
    Column("chunk_count", Integer, nullable=False),
    Column("done_count", Integer, nullable=False),
    # How often working on it went wrong since it was asked for.
    Column("setback_count", Integer, nullable=False),
    Column("event_count", Integer, nullable=False),
    Column("asked_at", UtcDateTime, nullable=False),
    Column("ended_at", UtcDateTime),
    PrimaryKeyConstraint("id"),
    # Serves: the same job asked for twice.
    UniqueConstraint("input_sha256"),
    one_of("state", JobState),
    # Serves: the jobs that there may be work on.
    Index(None, "state", "id"),
)
"""A library that was asked for."""

job_worker = Table(
    "job_worker",
    metadata,
    # Drawn at random and never twice: it is what fences.
    Column("id", bytewise_string(WORKER_ID_LENGTH), nullable=False),
    Column("name", bytewise_string(WORKER_NAME_LENGTH), nullable=False),
    # Counted up by the worker; one whose count stands still is taken for dead, and its row is removed.
    Column("beat", Integer, nullable=False),
    PrimaryKeyConstraint("id"),
    sqlite_with_rowid=False,
)
"""A living worker; leases are references to it, so that they end with its row."""

job_chunk = Table(
    "job_chunk",
    metadata,
    Column("job_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    # The worker that is at it; null: it is free.
    Column("worker_id", bytewise_string(WORKER_ID_LENGTH)),
    # Serves: the first free chunks of a job.
    PrimaryKeyConstraint("job_id", "orientation"),
    ForeignKeyConstraint(["job_id"], ["job.id"], ondelete="CASCADE"),
    ForeignKeyConstraint(["worker_id"], ["job_worker.id"], ondelete="SET NULL"),
    CheckConstraint("orientation >= 0", name="orientation_not_negative"),
    # Serves: the chunks that a worker leaves behind, and how many workers are at a job.
    Index(None, "worker_id"),
    sqlite_with_rowid=False,
)
"""An orientation of a running job that is not committed yet; when it is, its row goes."""

job_event = Table(
    "job_event",
    metadata,
    Column("job_id", Integer, nullable=False),
    Column("number", Integer, nullable=False),
    Column("kind", bytewise_string(NAME_LENGTH), nullable=False),
    Column("at", UtcDateTime, nullable=False),
    Column("done_count", Integer, nullable=False),
    Column("reason", bytewise_text()),
    # Serves: what happened to a job after a certain event.
    PrimaryKeyConstraint("job_id", "number"),
    ForeignKeyConstraint(["job_id"], ["job.id"], ondelete="CASCADE"),
    one_of("kind", EventKind),
    sqlite_with_rowid=False,
)
"""What happened to a job."""
