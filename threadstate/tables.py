"""Every table of the database, in one collection."""

from __future__ import annotations

import threadstate.access.tables
import threadstate.jobs.tables
import threadstate.library.history_tables  # noqa: F401 - each adds its own to those of the library
from threadstate.library.tables import metadata

__all__ = ["metadata"]
