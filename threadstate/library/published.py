"""What is published beside libraries of contact states, by the name under which it is asked for."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from sqlalchemy import ColumnElement, Connection, RowMapping, Select, Table, select

from threadstate.errors import NotFoundError
from threadstate.library.read import LARGEST_ID

LATEST = "latest"
NAMED_IN_ERRORS = 20
_NUMBER = re.compile(r"[0-9]{1,18}")


def published_rows(connection: Connection, table: Table, *which: ColumnElement[bool]) -> Sequence[RowMapping]:
    """The published rows of a table for which conditions hold, the latest first."""
    return connection.execute(_published(table, *which)).mappings().all()


def named_row(connection: Connection, table: Table, name: str, missing: str, remedy: str) -> RowMapping:
    """The published row of a name: ``latest``, the one published last, or a number.

    Raises:
        NotFoundError: it does not exist; the message is ``missing``, which ones there are, and the ``remedy``.
    """
    row = None
    if name == LATEST:
        row = connection.execute(_published(table).limit(1)).mappings().first()
    elif _NUMBER.fullmatch(name) and int(name) <= LARGEST_ID:
        row = connection.execute(_published(table, table.c.id == int(name))).mappings().first()
    if row is not None:
        return row
    numbers = ", ".join(str(one["id"]) for one in published_rows(connection, table)[:NAMED_IN_ERRORS])
    raise NotFoundError(f"{missing}; published are: {numbers or 'none yet'}; {remedy}")


def _published(table: Table, *which: ColumnElement[bool]) -> Select[Any]:
    return (
        select(table)
        .where(table.c.published_at.is_not(None), *which)
        .order_by(table.c.published_at.desc(), table.c.id.desc())
    )
