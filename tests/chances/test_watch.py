"""What remains after an observation, of made-up paths; what is no observation."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.chances.made_up import EDGES, THREAD, records, visit
from threadstate.chances.model import Leaving, Reading
from threadstate.chances.proportion import Chance
from threadstate.chances.watch import Observation, located, parse_observation, weighted
from threadstate.errors import InvalidValueError


def test_a_text_says_what_was_measured() -> None:
    assert parse_observation("force=0.5,-1,10+-0.5 torque=-0.2+-0.05 phase=120+-10") == Observation(
        ((0.5, -1.0, 10.0), 0.5), None, (-0.2, 0.05), (120.0, 10.0)
    )
    assert parse_observation("force=10+-1") == Observation(axial=(10.0, 1.0))


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "watch is 'nothing'; valid: force=X,Y,Z+-N"),
        ("force=1,2+-1", "watch is 'force=1,2+-1'"),
        ("torque=1,2,3+-1", "watch is 'torque=1,2,3+-1'"),
        ("force=10", "watch is 'force=10'"),
        ("speed=1+-1", "watch is 'speed=1+-1'"),
        ("torque=x+-1", "watch is 'torque=x+-1'"),
        ("torque=1+-1 torque=2+-1", "watch is 'torque=2+-1'"),
        ("torque=1+--1", "watch: tolerance of torque is -1.0; valid: a number >= 0"),
    ],
)
def test_what_is_no_observation_is_named(text: str, words: str) -> None:
    with pytest.raises(InvalidValueError) as caught:
        parse_observation(text)
    assert words in str(caught.value)


def test_two_forces_are_refused() -> None:
    with pytest.raises(InvalidValueError, match="three components or the axial one"):
        Observation(force=((0.0, 0.0, 1.0), 1.0), axial=(1.0, 1.0))


def test_each_quantity_has_to_be_within_its_tolerance() -> None:
    reading = Reading(-100.0, 0.2, (3.0, 4.0, 10.0))
    assert parse_observation("force=0,0,10+-5").holds(reading)
    assert not parse_observation("force=0,0,10+-4.9").holds(reading)
    assert parse_observation("force=11+-1").holds(reading)
    assert not parse_observation("force=11.5+-1").holds(reading)
    assert parse_observation("torque=0.25+-0.06").holds(reading)
    assert not parse_observation("torque=0.3+-0.06").holds(reading)
    assert not parse_observation("force=11+-1 torque=0.3+-0.06").holds(reading)


def test_a_phase_is_that_of_any_turn() -> None:
    reading = Reading(-100.0, 0.2, (0.0, 0.0, 10.0))
    assert parse_observation("phase=260+-0").holds(reading)
    assert parse_observation("phase=625+-5").holds(reading)
    assert not parse_observation("phase=250+-9").holds(reading)


def test_formations_remain_with_their_share_and_the_chance_of_their_paths() -> None:
    found = located(records(), parse_observation("force=10+-0.1 torque=0.1+-0.01"))
    assert (found.points, found.matching) == (16, 12)
    assert found.chance == Chance(2, 1, 4)
    edges = next(one for one in found.remaining if one.formation == EDGES)
    thread = next(one for one in found.remaining if one.formation == THREAD)
    assert (edges.points, edges.chance) == (8, Chance(2, 0, 3))
    assert (thread.points, thread.chance) == (2, Chance(1, 0, 1))
    assert edges.share == pytest.approx(420.0 / 620.0)
    assert sum(one.share for one in found.remaining) == pytest.approx(1.0)
    assert found.remaining[0] == edges


def test_where_nothing_matches_nothing_remains() -> None:
    found = located(records(), parse_observation("torque=9+-1"))
    assert (found.matching, found.remaining, found.chance) == (0, (), Chance(0, 0, 0))
    assert located([], parse_observation("torque=9+-1")).points == 0


def test_points_without_turning_share_by_their_number() -> None:
    instant = visit(EDGES, 5.0, 5.0, Leaving.SNAP)
    (only,) = located([replace(records()[2], visits=(instant,))], parse_observation("force=10+-1")).remaining
    assert (only.points, only.share) == (2, 1.0)


def test_the_turning_of_a_visit_is_shared_among_its_readings() -> None:
    weights = [turned for _, turned in weighted(visit(EDGES, 0.0, -40.0, Leaving.END))]
    assert weights == [10.0, 30.0]
