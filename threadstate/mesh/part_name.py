"""The two parts of a pair."""

from __future__ import annotations

from enum import StrEnum


class Part(StrEnum):
    """Which of the pair."""

    BOLT = "bolt"
    NUT = "nut"
