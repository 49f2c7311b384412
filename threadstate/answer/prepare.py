"""Makes beforehand what questions on a library would else have to wait for."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

from sqlalchemy import Connection

from threadstate.answer.heights import stored_heights
from threadstate.answer.library_network import LibraryNetwork

TILTS_A_STEP = 50


def preparation(connection: Connection, network: LibraryNetwork) -> Iterator[Callable[[], object]]:
    """Steps of some seconds at most, to be called one by one, after which a network holds all that it can keep.

    What is asked for first comes first; who wants to stop calls no more.
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
