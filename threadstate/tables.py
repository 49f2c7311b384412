"""All tables of the database."""

from __future__ import annotations

import threadstate.access.tables
import threadstate.jobs.tables
import threadstate.library.history_tables
import threadstate.library.settled_tables
import threadstate.library.success_tables  # noqa: F401 - each module adds its tables to the metadata
from threadstate.library.tables import metadata

__all__ = ["metadata"]
