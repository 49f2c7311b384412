"""The names of what a job can be and of what can happen to it."""

from __future__ import annotations

from enum import StrEnum


class JobState(StrEnum):
    """How far a job is."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def ended(self) -> bool:
        """Whether nothing happens any more unless it is asked for again."""
        return self not in (JobState.QUEUED, JobState.RUNNING)


class EventKind(StrEnum):
    """What can happen to a job."""

    QUEUED = "queued"
    STARTED = "started"
    PROGRESS = "progress"
    PUBLISHED = "published"
    FAILED = "failed"
    CANCELLED = "cancelled"
