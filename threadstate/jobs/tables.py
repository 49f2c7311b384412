"""The tables of jobs. No column is a deadline: workers detect the dead ones by their heartbeats (decision 10)."""

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

from threadstate.jobs.names import EventKind, JobKind, JobState
from threadstate.library.column_types import UtcDateTime, bytewise_string, bytewise_text
from threadstate.library.tables import NAME_LENGTH, SHA256_LENGTH, metadata, one_of

WORKER_ID_LENGTH = 32
WORKER_NAME_LENGTH = 200

job = Table(
    "job",
    metadata,
    Column("id", Integer, nullable=False),
    # What is computed: its inputs as JSON, and their hash by the code that accepted the job.
    Column("input_sha256", bytewise_string(SHA256_LENGTH), nullable=False),
    Column("inputs", bytewise_text(), nullable=False),
    Column("code_version", bytewise_string(NAME_LENGTH), nullable=False),
    Column("state", bytewise_string(NAME_LENGTH), nullable=False),
    Column("reason", bytewise_text()),
    Column("chunk_count", Integer, nullable=False),
    Column("done_count", Integer, nullable=False),
    # Failures since the job was requested.
    Column("setback_count", Integer, nullable=False),
    Column("event_count", Integer, nullable=False),
    Column("asked_at", UtcDateTime, nullable=False),
    Column("ended_at", UtcDateTime),
    # What is computed, which says what the inputs are.
    Column("kind", bytewise_string(NAME_LENGTH), server_default=JobKind.LIBRARY.value, nullable=False),
    PrimaryKeyConstraint("id"),
    # Serves: the same job requested twice.
    UniqueConstraint("input_sha256"),
    one_of("state", JobState),
    # Serves: the jobs that workers may take.
    Index(None, "state", "id"),
)
"""A requested library or map."""

job_worker = Table(
    "job_worker",
    metadata,
    # Random and never reused: a fencing token.
    Column("id", bytewise_string(WORKER_ID_LENGTH), nullable=False),
    Column("name", bytewise_string(WORKER_NAME_LENGTH), nullable=False),
    # Heartbeat counter, incremented by the worker; a worker whose counter stops is considered dead and its row removed.
    Column("beat", Integer, nullable=False),
    PrimaryKeyConstraint("id"),
    sqlite_with_rowid=False,
)
"""A live worker; leases refer to its row and end with it."""

job_chunk = Table(
    "job_chunk",
    metadata,
    Column("job_id", Integer, nullable=False),
    Column("orientation", Integer, nullable=False),
    # The worker that has leased it; null: it is free.
    Column("worker_id", bytewise_string(WORKER_ID_LENGTH)),
    # Serves: the first free chunks of a job.
    PrimaryKeyConstraint("job_id", "orientation"),
    ForeignKeyConstraint(["job_id"], ["job.id"], ondelete="CASCADE"),
    ForeignKeyConstraint(["worker_id"], ["job_worker.id"], ondelete="SET NULL"),
    CheckConstraint("orientation >= 0", name="orientation_not_negative"),
    # Serves: the chunks of a dead worker, and the number of workers of a job.
    Index(None, "worker_id"),
    sqlite_with_rowid=False,
)
"""An orientation of a running job that is not committed yet; its row is deleted when it is committed."""

job_event = Table(
    "job_event",
    metadata,
    Column("job_id", Integer, nullable=False),
    Column("number", Integer, nullable=False),
    Column("kind", bytewise_string(NAME_LENGTH), nullable=False),
    Column("at", UtcDateTime, nullable=False),
    Column("done_count", Integer, nullable=False),
    Column("reason", bytewise_text()),
    # Serves: the events of a job after a given one.
    PrimaryKeyConstraint("job_id", "number"),
    ForeignKeyConstraint(["job_id"], ["job.id"], ondelete="CASCADE"),
    one_of("kind", EventKind),
    sqlite_with_rowid=False,
)
"""An event of a job."""
