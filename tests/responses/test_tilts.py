from __future__ import annotations

import pytest

from threadstate.network.moves import Move
from threadstate.network.transitions import Transition
from threadstate.responses.library_network import LibraryNetwork
from threadstate.responses.transitions import NOT_SOLVED, SOLVED_DEG, TiltChanges
from threadstate.state.solve import solve_poses

pytestmark = pytest.mark.slow


@pytest.fixture
def tilts(network: LibraryNetwork) -> list[Transition]:
    """All its tilts."""
    return [one for one in network.transitions if not one.move.turns]


def test_heights_are_those_half_way(network: LibraryNetwork, tilts: list[Transition]) -> None:
    wide = [one for one in tilts if one.end_deg - one.start_deg >= SOLVED_DEG][::40]
    assert {one.move for one in wide} == {Move.ROLL_UP, Move.ROLL_DOWN, Move.PITCH_UP, Move.PITCH_DOWN}
    for one, change in zip(wide, network.tilts.of(wide), strict=True):
        phase = 0.5 * (one.start_deg + one.end_deg) % 360.0
        poses = [(*network.histories.tilt_deg(cell.orientation), phase) for cell in (one.source, one.target)]
        before, after = solve_poses(network.pair, poses)
        assert change.first_height == (before.poses[0].translation[2], after.poses[0].translation[2])
        assert change.last_height == (before.poses[-1].translation[2], after.poses[-1].translation[2])


def test_what_is_kept_is_what_is_solved_alone(network: LibraryNetwork, tilts: list[Transition]) -> None:
    kept = network.tilts.of(tilts)
    assert network.tilts.of(tilts) == kept
    for place in range(0, len(tilts), 97):
        assert TiltChanges(network.histories, network.pair, network.options).of([tilts[place]]) == [kept[place]]


def test_the_tilt_back_changes_the_same_the_other_way_round(network: LibraryNetwork, tilts: list[Transition]) -> None:
    kept = dict(zip(tilts, network.tilts.of(tilts), strict=True))
    pairs = [
        (one, back)
        for one in tilts
        for back in tilts
        if one.move is Move.ROLL_UP and back.move is Move.ROLL_DOWN
        if (one.source, one.target, one.start_deg) == (back.target, back.source, back.start_deg)
    ]
    assert len(pairs) > 100
    for one, back in pairs:
        assert kept[back] == kept[one].reverse
        assert kept[back].reverse == kept[one]


def test_a_stretch_between_two_events_is_not_solved(network: LibraryNetwork, tilts: list[Transition]) -> None:
    narrow = [one for one in tilts if one.end_deg - one.start_deg < SOLVED_DEG]
    assert narrow
    assert set(network.tilts.of(narrow)) == {NOT_SOLVED}
