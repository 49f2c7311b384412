"""The search for changes, on lines whose changes are known."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.history.changes import Changes, Estimator, Resolution, changes_on_circles
from threadstate.history.stretches import UNDECIDED_CODE, Floats, Integers, Samples

PERIOD = 10.0
RESOLUTION = Resolution(step=1.0, width=1e-9, jump_width=1e-9, undecided_width=1e-3)


def found_in(
    edges: list[list[float]],
    codes: list[list[int]],
    resolution: Resolution = RESOLUTION,
    estimate: Estimator | None = None,
) -> Changes:
    """What is found on lines whose code is ``codes[line][i]`` from the i-th of the line's edges on, with no numbers."""

    def sample(line: Integers, place: Floats) -> Samples:
        pairs = zip(line.tolist(), place.tolist(), strict=True)
        at = [codes[n][int(np.searchsorted(edges[n], x, side="right")) - 1] for n, x in pairs]
        return Samples(np.array(at, dtype=np.int64), np.full((len(line), 1), np.nan))

    return changes_on_circles(sample, len(edges), PERIOD, resolution, estimate)


def estimates_of(edges: list[list[float]], error: float) -> Estimator:
    """Estimates of the first edge between two places, the circle's end among them, this far off; NaN: none."""

    def estimate(line: Integers, low: Floats, high: Floats, within: Floats) -> Floats:
        assert (within > 0.0).all()
        stretches = zip(line.tolist(), low.tolist(), high.tolist(), strict=True)
        inside = [next((edge for edge in [*edges[n], PERIOD] if a < edge <= b), np.nan) for n, a, b in stretches]
        return np.array(inside) + error

    return estimate


def jumps_of(height: np.ufunc | object, step: float = 1.0) -> Changes:
    """What is found on one line of one code along which a number runs as ``height`` says."""

    def sample(line: Integers, place: Floats) -> Samples:
        assert callable(height)
        return Samples(np.zeros(len(line), dtype=np.int64), np.asarray(height(place), dtype=float)[:, np.newaxis])

    return changes_on_circles(sample, 1, PERIOD, Resolution(step, 1e-6, 1e-9, 1e-3))


def test_every_change_is_bracketed_by_the_codes_beside_it() -> None:
    edges = [0.0, 1.23456789, 5.5, 5.51, 5.5100003, 9.9]
    changes = found_in([edges], [[0, 1, 2, 3, 4, 0]])
    inner = edges[1:]
    assert len(changes.line) == len(inner)
    assert (changes.low < inner).all()
    assert (changes.high >= inner).all()
    assert (changes.high - changes.low <= 1e-9).all()
    assert changes.low_code.tolist() == [0, 1, 2, 3, 4]
    assert changes.high_code.tolist() == [1, 2, 3, 4, 0]


def test_the_end_of_the_circle_joins_its_start() -> None:
    changes = found_in([[0.0, 3.5]], [[7, 8]])
    assert changes.low == pytest.approx([3.5, PERIOD], abs=2e-9)
    assert changes.high_code.tolist() == [8, 7]


def test_a_code_at_a_single_place_that_is_sampled_has_two_changes() -> None:
    changes = found_in([[0.0, 4.0, 4.0 + 1e-12]], [[0, 1, 0]])
    assert changes.low_code.tolist() == [0, 1]
    assert changes.high.tolist()[0] == changes.low.tolist()[1] == 4.0


def test_where_there_is_no_answer_is_narrowed_less() -> None:
    changes = found_in([[0.0, 2.3, 4.8]], [[5, UNDECIDED_CODE, 5]])
    widths = changes.high - changes.low
    assert len(widths) == 2
    assert (widths <= 1e-3).all()
    assert (widths > 1e-5).all()


def test_a_line_has_the_same_changes_beside_any_others() -> None:
    edges = [[0.0, 1.1, 1.7, 6.0], [0.0, 0.3, 0.30001], [0.0, 9.99]]
    codes = [[0, 1, 2, 3], [4, 5, 6], [1, 2]]
    together = found_in(edges, codes)
    for line in range(3):
        alone = found_in([edges[line]], [codes[line]])
        of_line = together.line == line
        assert together.low[of_line].tolist() == alone.low.tolist()
        assert together.high[of_line].tolist() == alone.high.tolist()
        assert together.sample_counts[line] == alone.sample_counts[0]


def test_a_jump_is_found_where_the_code_is_the_same() -> None:
    changes = jumps_of(lambda x: np.sin(2.0 * np.pi * x / PERIOD) + np.where((x > 3.21) & (x < 7.0), 1.5, 0.0))
    assert changes.low == pytest.approx([3.21, 7.0], abs=2e-9)
    assert changes.low_code.tolist() == changes.high_code.tolist() == [0, 0]


def test_a_steep_rise_is_no_jump() -> None:
    changes = jumps_of(lambda x: 50.0 * np.tanh((x - 5.0) / 1e-4) + 50.0 * np.tanh((1.0 - x) / 1e-4))
    assert len(changes.line) == 0


def test_a_root_is_no_jump_however_steep_and_a_step_upon_it_is_one() -> None:
    def sample(line: Integers, place: Floats) -> Samples:
        within = place < 8.0
        root = 20_000.0 * np.sqrt(np.clip(place - 3.3, 0.0, 1e-3))
        numbers = np.column_stack([np.zeros_like(place), within * (root + np.where(place > 3.4, 2.0, 0.0))])
        return Samples(np.zeros(len(line), dtype=np.int64), numbers)

    changes = changes_on_circles(sample, 1, PERIOD, Resolution(1.0, 1e-6, 1e-11, 1e-3))
    assert changes.low == pytest.approx([3.4, 8.0], abs=1e-6)


def test_a_denser_start_finds_what_comes_and_goes_within_a_step() -> None:
    edges, codes = [[0.0, 4.43, 4.56]], [[0, 1, 0]]
    assert len(found_in(edges, codes).line) == 0
    assert len(found_in(edges, codes, Resolution(0.1, 1e-9, 1e-9, 1e-3)).line) == 2


EDGES = [[0.0, 1.23456789, 5.5, 5.51, 5.5100003, 9.9], [0.0, 3.3, 7.75]]
CODES = [[0, 1, 2, 3, 4, 0], [5, 6, 7]]


def test_estimates_spare_samples_and_find_the_same() -> None:
    edges = [[0.0, 1.23456789, 3.5, 5.51, 7.4, 9.9], EDGES[1]]
    usual = found_in(edges, CODES)
    aimed = found_in(edges, CODES, estimate=estimates_of(edges, 0.0))
    assert aimed.low_code.tolist() == usual.low_code.tolist()
    assert aimed.high_code.tolist() == usual.high_code.tolist()
    assert (aimed.high - aimed.low <= RESOLUTION.width).all()
    assert (aimed.low <= usual.high).all()
    assert (usual.low <= aimed.high).all()
    # The start, two samples a change, and one in each middle.
    assert aimed.sample_counts.tolist() == [10 + 2 * 5 + 4, 10 + 2 * 2 + 1 + 2]
    assert (aimed.sample_counts < 0.3 * usual.sample_counts).all()


@pytest.mark.parametrize("error", [3e-9, -3e-9, 1e-4, -0.2, 40.0, np.nan])
def test_wrong_estimates_cost_samples_alone(error: float) -> None:
    usual = found_in(EDGES, CODES)
    misled = found_in(EDGES, CODES, estimate=estimates_of(EDGES, error))
    assert misled.low_code.tolist() == usual.low_code.tolist()
    assert misled.high_code.tolist() == usual.high_code.tolist()
    assert (misled.high - misled.low <= RESOLUTION.width).all()
    assert (misled.low <= usual.high).all()
    assert (usual.low <= misled.high).all()
    assert (misled.sample_counts <= usual.sample_counts + 60).all()


def test_an_edge_beside_a_sample_is_bracketed_by_it() -> None:
    edges = [[0.0, 4.0 + 2e-10, 7.0 - 1e-10]]
    changes = found_in(edges, [[0, 1, 0]], estimate=estimates_of(edges, 0.0))
    assert changes.low[0] == 4.0
    assert changes.high[1] == 7.0
    assert (changes.high - changes.low <= RESOLUTION.width).all()
    assert changes.sample_counts.tolist() == [10 + 2 + 1]


def test_undecided_places_beside_an_estimate_are_narrowed_by_bisection() -> None:
    edges, codes = [[0.0, 2.3, 2.3 + 1e-8]], [[5, UNDECIDED_CODE, 6]]
    usual = found_in(edges, codes)
    aimed = found_in(edges, codes, estimate=estimates_of([[2.3 + 5e-9]], 0.0))
    assert aimed.low.tolist()[:2] == usual.low.tolist()[:2]
    assert aimed.high.tolist()[:2] == usual.high.tolist()[:2]


def test_a_jump_is_narrowed_to_its_own_width_by_estimates() -> None:
    place = 3.2143771

    def sample(line: Integers, places: Floats) -> Samples:
        return Samples(np.zeros(len(line), dtype=np.int64), np.where(places < place, 5.0, 0.0)[:, np.newaxis])

    resolution = Resolution(1.0, 1e-6, 1e-11, 1e-3)
    usual = changes_on_circles(sample, 1, PERIOD, resolution)
    aimed = changes_on_circles(sample, 1, PERIOD, resolution, estimates_of([[place]], 0.0))
    assert len(aimed.low) == len(usual.low) == 2  # the other one is where the circle joins
    assert aimed.low[0] < place <= aimed.high[0]
    assert aimed.high[0] - aimed.low[0] <= 1e-11
    assert aimed.sample_counts[0] < 0.5 * usual.sample_counts[0]


def test_a_rise_that_is_said_to_be_none_of_a_jump_is_sampled_once() -> None:
    sampled: list[float] = []

    def sample(line: Integers, places: Floats) -> Samples:
        sampled.extend(places.tolist())
        numbers = 50.0 * np.tanh((places - 5.3) * 9.0) - 50.0 * np.tanh((places - 8.3) * 9.0)
        return Samples(np.zeros(len(line), dtype=np.int64), numbers[:, np.newaxis])

    def without_a_jump(line: Integers, _low: Floats, _high: Floats, _within: Floats) -> Floats:
        return np.full(len(line), np.inf)

    resolution = Resolution(1.0, 1e-6, 1e-9, 1e-3)
    usual = changes_on_circles(sample, 1, PERIOD, resolution)
    count = len(sampled)
    told = changes_on_circles(sample, 1, PERIOD, resolution, without_a_jump)
    assert len(told.line) == len(usual.line) == 0
    assert count > 10 + 2
    assert len(sampled) - count == 10 + 2


def test_a_detour_shows_that_a_rise_is_that_of_jumps() -> None:
    def sample(line: Integers, places: Floats) -> Samples:
        numbers = np.select([places < 5.2, places < 5.7, places < 8.3], [0.0, 9.0, 3.0], 0.0)
        return Samples(np.zeros(len(line), dtype=np.int64), numbers[:, np.newaxis])

    def at_first_without_a_jump(_line: Integers, low: Floats, high: Floats, _within: Floats) -> Floats:
        return np.where((high - low > 0.9) & (low < 6.0), np.inf, np.nan)

    changes = changes_on_circles(sample, 1, PERIOD, Resolution(1.0, 1e-6, 1e-9, 1e-3), at_first_without_a_jump)
    assert changes.low == pytest.approx([5.2, 5.7, 8.3], abs=1e-6)


def test_what_comes_and_goes_beside_a_cluster_is_found() -> None:
    edges, codes = [[0.0, 4.3, 4.3001, 4.30015, 4.32, 9.0]], [[0, 1, 2, 3, 2, 0]]
    changes = found_in(edges, codes, estimate=estimates_of(edges, 0.0))
    assert changes.low_code.tolist() == [0, 1, 2, 3, 2]
    assert changes.low == pytest.approx(edges[0][1:], abs=2e-9)
