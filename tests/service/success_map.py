"""A published success map of made-up outcomes."""

from __future__ import annotations

from tests.jobs.jobs import SUCCESS_INPUTS, made_up_orientation
from threadstate.library.engine import writing
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import OrientationMap
from threadstate.success.write import open_map, publish_map_in, write_orientation


def store_success_map(database: str, inputs: SuccessInputs = SUCCESS_INPUTS) -> list[OrientationMap]:
    """Publish a map in a migrated database.

    Returns:
        Its orientations, in order.
    """
    found = [made_up_orientation(inputs, index) for index in range(inputs.grid.orientation_count)]
    with writing(database) as engine:
        map_id = open_map(engine, inputs)
        for one in found:
            write_orientation(engine, map_id, one)
        with engine.begin() as connection:
            publish_map_in(connection, map_id, inputs.grid)
    return found
