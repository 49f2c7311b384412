"""The search for changes, on lines whose changes are known."""

from __future__ import annotations

import numpy as np
import pytest

from threadstate.history.changes import (
    UNDECIDED_CODE,
    Changes,
    Floats,
    Integers,
    Resolution,
    Samples,
    changes_on_circles,
)

PERIOD = 10.0
RESOLUTION = Resolution(step=1.0, width=1e-9, jump_width=1e-9, undecided_width=1e-3)


def found_in(edges: list[list[float]], codes: list[list[int]], resolution: Resolution = RESOLUTION) -> Changes:
    """What is found on lines whose code is ``codes[line][i]`` from the i-th of the line's edges on, with no numbers."""

    def sample(line: Integers, place: Floats) -> Samples:
        pairs = zip(line.tolist(), place.tolist(), strict=True)
        at = [codes[n][int(np.searchsorted(edges[n], x, side="right")) - 1] for n, x in pairs]
        return Samples(np.array(at, dtype=np.int64), np.full((len(line), 1), np.nan))

    return changes_on_circles(sample, len(edges), PERIOD, resolution)


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
