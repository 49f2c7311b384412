from __future__ import annotations

from unittest import mock

import pytest
from sqlalchemy import Connection

import threadstate.responses.heights
import threadstate.responses.transitions
from service.warming import precompute_steps
from threadstate.responses.heights import heights_document, stored_heights
from threadstate.responses.library_network import LibraryNetwork
from threadstate.responses.transitions import transition_documents

pytestmark = pytest.mark.slow


def test_afterwards_nothing_is_solved_for_a_question(connection: Connection, network: LibraryNetwork) -> None:
    for step in precompute_steps(connection, network):
        step()
    solving = AssertionError("a question solves")
    with (
        mock.patch.object(threadstate.responses.heights, "heights_of", side_effect=solving),
        mock.patch.object(threadstate.responses.transitions, "solve_poses", side_effect=solving),
    ):
        for number in range(network.cell_map.orientation_count):
            roll, pitch = network.histories.tilt_deg(number)
            assert heights_document(stored_heights(connection, network, roll, pitch), roll, pitch, 0.05, 1.0).phases
        found = transition_documents(network.transitions, network.histories, network.tilts, 1.0)
    assert len(found) == len(network.transitions)


def test_a_curve_is_made_once(connection: Connection, network: LibraryNetwork) -> None:
    one = stored_heights(connection, network, 3.0, -3.0)
    assert stored_heights(connection, network, 3.0, -3.0) is one
    assert stored_heights(connection, network, -3.0, -3.0) is not one


def test_no_step_is_taken_before_it_is_called(connection: Connection, network: LibraryNetwork) -> None:
    next(precompute_steps(connection, network))
    assert "transitions" not in vars(network)
    with pytest.raises(StopIteration):
        next(iter(network.curves))
