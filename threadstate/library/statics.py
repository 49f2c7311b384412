"""The statics stored with the states of a library."""

from __future__ import annotations

from collections.abc import Sequence

from sqlalchemy import ColumnElement, Connection, select

from threadstate.library.read import states_between
from threadstate.library.tables import state
from threadstate.state.model import ContactState
from threadstate.statics.stored import NAMES, StoredStatics, from_cells

Statics = dict[int, StoredStatics | None]
"""By ordinal; None where a contact has no certain normal."""

_COLUMNS = [state.c[name] for name in NAMES]


def statics_between(connection: Connection, library_id: int, first: int, last: int) -> Statics:
    """The statics of the states with ordinals ``first`` to ``last``, both included."""
    return _statics(connection, library_id, state.c.ordinal.between(first, last))


def statics_at(connection: Connection, library_id: int, ordinals: Sequence[int]) -> Statics:
    """The statics of the states with these ordinals; at most some hundreds."""
    return _statics(connection, library_id, state.c.ordinal.in_(ordinals))


def _statics(connection: Connection, library_id: int, which: ColumnElement[bool]) -> Statics:
    query = select(state.c.ordinal, *_COLUMNS).where(state.c.library_id == library_id, which)
    return {ordinal: from_cells(*values) for ordinal, *values in connection.execute(query)}


def library_states_between(
    connection: Connection, library_id: int, first: int, last: int
) -> list[tuple[ContactState, StoredStatics | None]]:
    """The states with ordinals ``first`` to ``last``, both included, in order, with their statics."""
    statics = statics_between(connection, library_id, first, last)
    states = states_between(connection, library_id, first, last)
    return list(zip(states, [statics[ordinal] for ordinal in sorted(statics)], strict=True))
