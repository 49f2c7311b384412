"""Brackets of a change that round-off hides, on a line whose codes are random over a known stretch."""

from __future__ import annotations

import numpy as np

from threadstate.history.brackets import Bracket
from threadstate.history.flicker import widened
from threadstate.history.stretches import Floats, Integers, Samples

START, END = 40.0, 40.004
SHARP = 120.0
LAST = 359.9


def _sample(_line: Integers, place: Floats) -> Samples:
    """Code 0 up to START, 0 or 1 at random up to END, 1 up to SHARP, then 2 up to LAST, then 0."""
    random = np.frombuffer((place * 1e7).astype(np.int64).tobytes(), dtype=np.uint16).reshape(len(place), -1)
    either = (random.astype(np.int64) * (7919, 104729, 1299709, 15485863)).sum(axis=1) // 64 % 2
    codes = np.select([place < START, place < END, place < SHARP, place < LAST], [0, either, 1, 2], 0)
    return Samples(codes.astype(np.int64), np.full((len(place), 1), np.nan))


def _bracket(low: float, high: float) -> Bracket:
    codes = _sample(np.zeros(2, dtype=np.int64), np.array([low, high])).codes.tolist()
    return Bracket(low, high, *codes)


BOUNDED = (_bracket(SHARP - 1e-7, SHARP + 1e-7), _bracket(LAST - 1e-7, LAST + 1e-7))


def _found_in_the_stretch() -> Bracket:
    places = np.arange(START + 0.0015, END, 3e-7)
    codes = _sample(np.zeros(len(places), dtype=np.int64), places).codes
    number = int(np.flatnonzero((codes[:-1] == 0) & (codes[1:] == 1))[0])
    return Bracket(float(places[number]), float(places[number + 1]), 0, 1)


def test_a_bracket_grows_over_all_that_flickers() -> None:
    inner = _found_in_the_stretch()
    wide, *others = widened(_sample, [inner, *BOUNDED], 0, {inner})
    assert wide.low < START + 2e-5
    assert wide.high > END - 2e-5
    assert wide.high - wide.low < 5.0 * (END - START)
    assert (wide.low_code, wide.high_code) == (0, 1)
    assert others == list(BOUNDED)


def test_what_is_not_doubtful_stays_as_it_is() -> None:
    inner = _found_in_the_stretch()
    assert widened(_sample, [inner, *BOUNDED], 0, set()) == [inner, *BOUNDED]


def test_a_doubtful_change_that_is_steady_stays_as_narrow() -> None:
    brackets = [Bracket(END, END + 1e-7, 0, 1), *BOUNDED]
    assert widened(_sample, brackets, 0, {BOUNDED[0]}) == brackets


def test_brackets_within_one_stretch_are_one_and_what_is_between_them_belongs_to_it() -> None:
    first = _found_in_the_stretch()
    later = Bracket(first.high + 2e-4, first.high + 2.001e-4, 1, 1)
    wide, *others = widened(_sample, [first, later, *BOUNDED], 0, {first, later})
    assert wide.low < START + 2e-5
    assert wide.high > END - 2e-5
    assert first.high < wide.through[0] < later.low
    assert others == list(BOUNDED)
