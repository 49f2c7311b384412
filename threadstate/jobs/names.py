"""What a job computes, the states of a job and the kinds of its events."""

from __future__ import annotations

from enum import StrEnum


class JobKind(StrEnum):
    """What a job computes."""

    LIBRARY = "library"
    """A library of contact states."""
    SETTLED = "settled"
    """A library of settled states."""
    SUCCESS = "success"
    """A success map."""

    @property
    def words(self) -> str:
        """What is computed, in words."""
        return _WORDS[self]


class JobState(StrEnum):
    """The state of a job."""

    QUEUED = "queued"
    RUNNING = "running"
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def ended(self) -> bool:
        """Whether the job has ended; it changes again only if it is requested again."""
        return self not in (JobState.QUEUED, JobState.RUNNING)


class EventKind(StrEnum):
    """The kind of an event."""

    QUEUED = "queued"
    STARTED = "started"
    PROGRESS = "progress"
    PUBLISHED = "published"
    FAILED = "failed"
    CANCELLED = "cancelled"


_WORDS = {
    JobKind.LIBRARY: "library of contact states",
    JobKind.SETTLED: "library of settled states",
    JobKind.SUCCESS: "success map",
}
