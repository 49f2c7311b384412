"""The search for a device: on made-up maps, whose best device is known."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.document import device_document, device_from_document
from threadstate.device.model import Limits, default_device
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.success.design import (
    Candidate,
    Parameter,
    best_first,
    candidate_of,
    device_with,
    front,
    searched,
    tolerances,
)
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.search import mapped_cells

GRID = Grid(1.0, 1.0, 180.0)
FRICTIONS = (0.0, 0.1, 0.2)
PARAMETERS = (Parameter("k_tilt", 20.0, 5000.0), Parameter("centre", -10.0, 10.0))
BEST = (300.0, 2.0)
ANY = Limits()


def made_up(values: tuple[float, ...], frictions: tuple[float, ...] = FRICTIONS, limits: Limits = ANY) -> Candidate:
    """A device that brings the more orientations home, to the higher frictions, the nearer it is to the best one."""
    k_tilt, centre = values
    far = abs(math.log(k_tilt / BEST[0])) + 0.2 * abs(centre - BEST[1])
    orientations = []
    for index in range(GRID.orientation_count):
        orientation = GRID.orientation(index)

        def cell(phase_deg: float, mu: float, index: int = index) -> Cell:
            engages = far < 0.5 * index - 5.0 * mu + 0.3
            outcome = AssemblyOutcome.ENGAGED if engages else AssemblyOutcome.NO_SNAP
            return Cell(phase_deg, mu, outcome, (), False, 1.0 + mu, 2.0 + 0.1 * index, 0.01 * far, 0.0)

        cells = mapped_cells(cell, lambda _: True, GRID.phases_deg, frictions, 360.0, 1.0)
        orientations.append(OrientationMap(index, orientation.roll_deg, orientation.pitch_deg, *cells))
    return candidate_of(values, default_device(), orientations, GRID, frictions, limits)


def test_the_search_comes_near_the_best_device_and_is_the_same_again() -> None:
    tried = searched(made_up, PARAMETERS, 60)
    assert [one.values for one in searched(made_up, PARAMETERS, 60)] == [one.values for one in tried]
    assert 36 < len(tried) == len({one.values for one in tried}) <= 60
    assert tried[0].values == (316.0, 0.0)
    assert {type(value) for one in tried for value in one.values} == {float}
    best = best_first(tried)[0]
    assert best.engaged == made_up(BEST).engaged
    assert math.log(best.values[0] / BEST[0]) == pytest.approx(0.0, abs=0.1)
    assert best.values[1] == pytest.approx(BEST[1], abs=0.5)


def test_the_device_that_is_given_is_tried_first_and_what_is_near_it_if_it_is_the_best() -> None:
    tried = searched(made_up, PARAMETERS, 20, BEST)
    assert tried[0].values == BEST
    assert best_first(tried)[0].engaged == made_up(BEST).engaged
    beside = [one.values for one in tried if sum(a != b for a, b in zip(one.values, BEST, strict=True)) == 1]
    assert len(beside) >= 4
    outside = searched(made_up, PARAMETERS, 20, (10.0, 40.0))
    assert outside[0].values == (10.0, 40.0)
    assert len(outside) == 20


def test_no_more_devices_are_tried_than_may_be_nor_one_twice() -> None:
    asked: list[tuple[float, ...]] = []

    def evaluate(values: tuple[float, ...]) -> Candidate:
        asked.append(values)
        return made_up(values)

    assert len(searched(evaluate, PARAMETERS, 7)) == len(asked) == len(set(asked)) == 7
    coarse = [Parameter("centre", 0.0, 1e-9)]
    assert len(searched(lambda values: made_up((300.0, *values)), coarse, 5)) <= 5


def test_what_a_map_says_within_limits() -> None:
    free = made_up((300.0, 2.0))
    assert free.engaged == (9, 8, 7)
    assert (free.worst_critical, free.undecided) == (0.0, (0, 0, 0))
    assert free.mean_critical == pytest.approx((0.0 + 0.1 + 7 * 0.2) / 9.0)
    assert free.torque == 1.0
    assert free.tilt_deg == pytest.approx(2.8)
    narrow = made_up((300.0, 2.0), limits=Limits(tilt_deg=2.35))
    assert (narrow.engaged, narrow.worst_critical) == ((4, 3, 2), None)
    assert narrow.tilt_deg <= 2.35
    assert made_up((330.0, 2.0), limits=Limits(shift=1e-9)).engaged == (0, 0, 0)
    # The torque grows with the friction, from 1.
    assert made_up((300.0, 2.0), limits=Limits(torque=1.1)).engaged == (9, 8, 0)


def test_what_might_engage_is_counted_and_does_not_count_as_success() -> None:
    def cell(phase_deg: float, mu: float) -> Cell:
        outcome = AssemblyOutcome.UNDECIDED if phase_deg > 0.0 else AssemblyOutcome.ENGAGED
        return Cell(phase_deg, mu, outcome, (), False, 1.0, 1.0, 0.0, 0.0)

    grid = Grid(0.0, 1.0, 180.0)
    orientations = [
        OrientationMap(0, 0.0, 0.0, *mapped_cells(cell, lambda _: True, grid.phases_deg, (0.0,), 360.0, 1.0))
    ]
    found = candidate_of((1.0,), default_device(), orientations, grid, (0.0,), Limits())
    assert (found.engaged, found.undecided, found.worst_critical, found.mean_critical) == ((0,), (1,), None, 0.0)


def test_the_front_has_what_no_other_one_beats() -> None:
    tried = searched(made_up, PARAMETERS, 40)
    found = front(tried)
    assert found
    for one in found:
        assert not any(other.dominates(one) for other in tried)
    for one in tried:
        assert one in found or sum(one.engaged) == 0 or any(other.dominates(one) for other in found)
    assert front([made_up((5000.0, -10.0))]) == [made_up((5000.0, -10.0))]


def test_numbers_may_err_until_fewer_engage() -> None:
    best = made_up(BEST)
    by_name = {one.name: one for one in tolerances(lambda values: made_up(values, (0.0,)), best, PARAMETERS)}
    k_tilt, centre = by_name["k_tilt"], by_name["centre"]
    assert k_tilt.low <= BEST[0] <= k_tilt.high
    assert k_tilt.fails_above is not None
    assert k_tilt.fails_below is not None
    for name, one in by_name.items():
        for value, fails in ((one.low, False), (one.high, False), (one.fails_below, True), (one.fails_above, True)):
            values = (value, BEST[1]) if name == "k_tilt" else (BEST[0], value)
            assert (
                value is None or (made_up((values[0] or 0.0, values[1] or 0.0)).engaged[0] < best.engaged[0]) == fails
            )
    assert centre.low == pytest.approx(1.0)
    assert centre.high == pytest.approx(3.0)


@given(st.floats(0.0, 1.0), st.sampled_from([(20.0, 5000.0), (-10.0, 10.0), (1.0, 2.0), (-0.3, 0.1)]))
def test_values_lie_in_their_range_and_can_be_written_down(fraction: float, ends: tuple[float, float]) -> None:
    parameter = Parameter("centre", *ends)
    value = parameter.at(fraction)
    assert ends[0] - 0.005 * abs(ends[0]) <= value <= ends[1] + 0.005 * abs(ends[1])
    assert float(f"{value:.6g}") == value
    for step in (0.5, 2.0):
        assert ends[0] <= parameter.moved(min(max(value, ends[0]), ends[1]), step) <= ends[1]


@pytest.mark.parametrize(
    ("name", "low", "high", "named"),
    [
        ("mass", 0.0, 1.0, "mass"),
        ("push", 2.0, 1.0, "2:1"),
        ("push", 1.0, math.inf, "finite"),
        ("push", 1.0, 1.0, "1:1"),
    ],
)
def test_a_range_that_is_none_is_named(name: str, low: float, high: float, named: str) -> None:
    with pytest.raises(InvalidValueError, match=named):
        Parameter(name, low, high)


def test_a_device_with_other_numbers_keeps_the_rest() -> None:
    found = device_with(default_device(), {"k_tilt": 80.0, "centre": -4.0})
    assert device_document(found) == {**device_document(default_device()), "k_tilt": 80.0, "centre": -4.0}
    matrix = [[0.0] * 6 for _ in range(6)]
    for k in range(6):
        matrix[k][k] = 1.0
    matrix[0][1] = matrix[1][0] = 0.5
    whole = device_from_document({"unit": "mm", "stiffness": matrix})
    assert device_with(whole, {"push": 3.0}).push == 3.0
    with pytest.raises(InvalidValueError, match="four stiffnesses"):
        device_with(whole, {"k_tilt": 3.0})
