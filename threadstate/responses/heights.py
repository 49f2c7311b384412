"""Curves of height against phase, of a library's orientations or of any."""

from __future__ import annotations

import math

from sqlalchemy import Connection

from threadstate.history.build import history_of
from threadstate.history.heights import Floats, Heights, heights_of
from threadstate.library.read import heights_between
from threadstate.responses.documents import HeightsDocument
from threadstate.responses.library_network import LibraryNetwork
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair

TOLERANCE = 2e-4
"""How far a line between two heights may be off, in thread pitches: a third of a pixel on a screen's height."""

_UNDECIDED = (math.nan, math.nan)


def stored_heights(connection: Connection, network: LibraryNetwork, roll_deg: float, pitch_deg: float) -> Heights:
    """The curve of an orientation of a library: heights that its tables lack are solved, once.

    Raises:
        NotFoundError: the library's grid does not have the orientation.
    """
    number = network.orientation(roll_deg, pitch_deg)
    found = network.curves.get(number)
    if found is None:
        found = network.curves[number] = _curve(connection, network, number)
    return found


def computed_heights(pair: Pair, roll_deg: float, pitch_deg: float, options: SolveOptions | None = None) -> Heights:
    """The curve of any orientation.

    Raises:
        InvalidValueError: a value not finite, roll or pitch beyond 10 deg.
    """
    boundaries = history_of(pair, roll_deg, pitch_deg, options).boundaries
    sides = [phase for one in boundaries for phase in (one.low_deg, one.high_deg)]
    return heights_of(pair, roll_deg, pitch_deg, sides, TOLERANCE * pair.thread_pitch, options=options)


def heights_document(
    heights: Heights, roll_deg: float, pitch_deg: float, thread_pitch: float, factor: float
) -> HeightsDocument:
    """The document of a curve, lengths multiplied by ``factor``; ``thread_pitch`` in the unit before that."""
    return HeightsDocument(
        roll=roll_deg + 0.0,
        pitch=pitch_deg + 0.0,
        tolerance=TOLERANCE * thread_pitch * factor,
        phases=heights.phases_deg.tolist(),
        first_heights=_scaled(heights.first, factor),
        rest_heights=_scaled(heights.rest, factor),
    )


def _curve(connection: Connection, network: LibraryNetwork, number: int) -> Heights:
    roll_deg, pitch_deg = network.histories.tilt_deg(number)
    grid = network.library.grid
    first = grid.first_ordinal(number)
    on_grid = heights_between(connection, network.library.id, first, first + grid.phase_count - 1)
    known = {phase: on_grid.get(first + i, _UNDECIDED) for i, phase in enumerate(grid.phases_deg)}
    boundaries = network.histories.orientations[number].boundaries
    return heights_of(
        network.pair,
        roll_deg,
        pitch_deg,
        [phase for one in boundaries for phase in (one.low_deg, one.high_deg)],
        TOLERANCE * network.pair.thread_pitch,
        known,
        network.options,
    )


def _scaled(heights: Floats, factor: float) -> list[float | None]:
    return [None if math.isnan(height) else height * factor for height in heights.tolist()]
