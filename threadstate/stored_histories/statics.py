"""Adding statics to states that an older threadstate stored without them."""

from __future__ import annotations

from collections.abc import Iterator

from sqlalchemy import Engine, and_, bindparam, select, update

from threadstate.library.grid import Grid
from threadstate.library.identity import pair_of
from threadstate.library.read import states_between
from threadstate.library.statics import statics_between
from threadstate.library.tables import chunk, library, state
from threadstate.statics.stored import NAMES, cells


def orientations_without_statics(engine: Engine) -> list[tuple[int, int]]:
    """The numbers of libraries and orientations, in order, that an older threadstate stored without statics."""
    first = chunk.c.orientation * library.c.phase_count
    of_chunk = and_(
        state.c.library_id == chunk.c.library_id,
        state.c.ordinal >= first,
        state.c.ordinal < first + library.c.phase_count,
    )
    with_states = select(state.c.ordinal).where(of_chunk)
    query = (
        select(chunk.c.library_id, chunk.c.orientation)
        .join(library, library.c.id == chunk.c.library_id)
        .where(with_states.exists(), ~with_states.where(state.c.support_margin.is_not(None)).exists())
        .order_by(chunk.c.library_id, chunk.c.orientation)
    )
    with engine.connect() as connection:
        return [(row.library_id, row.orientation) for row in connection.execute(query)]


def fill_statics(engine: Engine, orientations: list[tuple[int, int]]) -> Iterator[tuple[int, int]]:
    """Store the statics of orientations that have none, each in its own transaction; yields each after it is stored."""
    # Imported late: the kernels take a second to load, and listing orientations needs none.
    from threadstate.statics.rows import stored_statics

    for library_id, orientation in orientations:
        with engine.begin() as connection:
            head = connection.execute(select(library).where(library.c.id == library_id)).one()
            grid = Grid(head.tilt_max_deg, head.tilt_step_deg, head.phase_step_deg)
            first = grid.first_ordinal(orientation)
            last = first + grid.phase_count - 1
            states = states_between(connection, library_id, first, last)
            ordinals = sorted(statics_between(connection, library_id, first, last))
            values = [
                dict(zip(("_ordinal", *NAMES), (ordinal, *cells(found)), strict=True))
                for ordinal, found in zip(ordinals, stored_statics(pair_of(head.pair), states), strict=True)
            ]
            statement = update(state).where(state.c.library_id == library_id, state.c.ordinal == bindparam("_ordinal"))
            connection.execute(statement.values({name: bindparam(name) for name in NAMES}), values)
        yield library_id, orientation
