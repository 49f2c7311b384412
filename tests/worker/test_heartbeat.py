from __future__ import annotations

import time

import pytest

from worker.jobs.heartbeat import SilenceDetector


class Clock:
    """A steady clock that a test moves."""

    def __init__(self) -> None:
        self.now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def _silent(watch: SilenceDetector, clock: Clock, *counts: tuple[float, dict[str, int]]) -> list[list[tuple[str, int]]]:
    found = []
    for step_s, beats in counts:
        clock.now_s += step_s
        found.append(watch.silent(beats))
    return found


def test_a_count_that_stands_still_longer_than_the_lease_is_silent() -> None:
    clock = Clock()
    found = _silent(
        SilenceDetector(10.0, clock),
        clock,
        (0.0, {"one": 3, "other": 1}),
        *((4.0, {"one": 3, "other": count}) for count in range(2, 5)),
    )
    assert found == [[], [], [], [("one", 3)]]


def test_a_count_that_moves_begins_a_new_lease_even_backwards() -> None:
    clock = Clock()
    beats = [{"one": count} for count in (5, 5, 5, 4, 4, 4, 4)]
    found = _silent(SilenceDetector(10.0, clock), clock, *((4.0, one) for one in beats))
    assert found == [[], [], [], [], [], [], [("one", 4)]]


def test_one_that_has_not_looked_for_long_takes_nobody_for_dead() -> None:
    clock = Clock()
    found = _silent(SilenceDetector(10.0, clock), clock, (1.0, {"one": 1}), (1000.0, {"one": 1}), (4.0, {"one": 1}))
    assert found == [[], [], []]


def test_one_that_comes_back_is_new() -> None:
    clock = Clock()
    steps = [(4.0, {"one": 1}), (4.0, {}), (4.0, {"one": 1}), (4.0, {"one": 1})]
    assert _silent(SilenceDetector(10.0, clock), clock, *steps) == [[], [], [], []]


def test_setting_the_clock_back_or_forth_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    watch = SilenceDetector(3600.0)
    for wall_s in (0.0, 1e10, -1e10):
        monkeypatch.setattr(time, "time", lambda wall_s=wall_s: wall_s)
        assert watch.silent({"one": 1}) == []
