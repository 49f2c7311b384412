"""Wilson intervals against published ones; bounds with undecided paths."""

from __future__ import annotations

import pytest

from tests.chances.made_up import record, records
from threadstate.chances.proportion import Chance, Interval, Proportion, chance_of, wilson
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.errors import InvalidValueError


@pytest.mark.parametrize(
    ("count", "of", "low", "high"),
    [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)],
)
def test_intervals_are_those_of_newcombe_1998(count: int, of: int, low: float, high: float) -> None:
    """Newcombe, Statistics in Medicine 17 (1998), table I, method 3."""
    found = wilson(count, of)
    assert (found.low, found.high) == pytest.approx((low, high), abs=6e-5)
    mirrored = wilson(of - count, of)
    assert (1.0 - mirrored.high, 1.0 - mirrored.low) == pytest.approx((low, high), abs=6e-5)


def test_nothing_is_known_of_no_samples() -> None:
    assert wilson(0, 0) == Interval(0.0, 1.0)
    assert Proportion(0, 0).share == 0.0
    nothing = chance_of([])
    assert (nothing.share, nothing.bounds, nothing.interval) == (None, Interval(0.0, 1.0), Interval(0.0, 1.0))


@pytest.mark.parametrize("count", [-1, 6])
def test_more_than_all_are_refused(count: int) -> None:
    with pytest.raises(InvalidValueError, match="valid: 0 to 5"):
        wilson(count, 5)


def test_undecided_paths_are_counted_apart() -> None:
    chance = chance_of(records())
    assert chance == Chance(2, 2, 5)
    assert chance.share == pytest.approx(2 / 3)
    assert chance.bounds == Interval(0.4, 0.8)
    assert chance.interval == Interval(wilson(2, 5).low, wilson(4, 5).high)


def test_where_all_are_undecided_nothing_is_said_of_the_chance() -> None:
    chance = chance_of([record(index, AssemblyOutcome.UNDECIDED) for index in range(3)])
    assert (chance.share, chance.bounds) == (None, Interval(0.0, 1.0))


def test_where_all_are_decided_both_bounds_are_the_share() -> None:
    chance = Chance(3, 0, 4)
    assert chance.bounds == Interval(0.75, 0.75)
    assert chance.share == 0.75
    assert chance.interval == wilson(3, 4)
