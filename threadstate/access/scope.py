"""What a key is good for."""

from __future__ import annotations

from enum import StrEnum


class Scope(StrEnum):
    """What a key is good for."""

    READ = "read"
    """Reading, where that is closed."""
    WRITE = "write"
    """Reading, and asking for jobs."""
