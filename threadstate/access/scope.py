"""Scopes of API keys."""

from __future__ import annotations

from enum import StrEnum


class Scope(StrEnum):
    """What an API key permits."""

    READ = "read"
    """Reads, where they need a key."""
    WRITE = "write"
    """Reads, and submitting jobs."""
