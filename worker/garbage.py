"""The frequency of Python's garbage collections."""

from __future__ import annotations

import gc

NEW_OBJECTS_BETWEEN_COLLECTIONS = 100_000


def collect_rarely() -> None:
    """Run the cyclic garbage collector rarely: commands allocate many objects and hardly any cycles.

    With Python's default it takes a sixth of the start-up time, and nearly half of the time in which records become
    states.
    """
    gc.set_threshold(NEW_OBJECTS_BETWEEN_COLLECTIONS)
