"""Precomputes what requests about a library's network need."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from sqlalchemy import Connection

from threadstate.responses.heights import stored_heights
from threadstate.responses.library_network import LibraryNetwork

TILTS_A_STEP = 50


def precompute_steps(connection: Connection, network: LibraryNetwork) -> Iterator[Callable[[], object]]:
    """Steps of a few seconds at most, after which a network has cached all that it can.

    The steps come in the order in which the explorer needs their results; call them one by one, and stop at any time.
    """
    yield lambda: network.transitions
    yield lambda: network.summary
    yield lambda: network.formations
    yield lambda: network.node_link
    for number in range(network.cell_map.orientation_count):
        yield partial(stored_heights, connection, network, *network.histories.tilt_deg(number))
    yield lambda: network.dot
    yield lambda: network.graphml
    tilts = [one for one in network.transitions if not one.move.turns]
    for start in range(0, len(tilts), TILTS_A_STEP):
        yield partial(network.tilts.of, tilts[start : start + TILTS_A_STEP])
