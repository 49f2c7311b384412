"""How often Python looks for garbage."""

from __future__ import annotations

import gc

NEW_OBJECTS_BETWEEN_COLLECTIONS = 100_000


def collect_rarely() -> None:
    """Look for cycles of garbage rarely: commands import much and make many values, and next to no cycles.

    Looking through all of it as often as Python does by itself takes a sixth of the time to start, and nearly half of
    the time in which records become states.
    """
    gc.set_threshold(NEW_OBJECTS_BETWEEN_COLLECTIONS)
