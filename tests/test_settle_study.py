"""The study of settled states, on a small scale."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from studies.settle import study
from studies.settle.page import page
from studies.settle.study import (
    CAME_BACK,
    CHANGES,
    DEVICES,
    ITEMS_A_TASK,
    PAIRS,
    Amount,
    Found,
    Part,
    Task,
    device_of,
    done,
    item,
    pair_of,
    tasks,
)
from threadstate.device.model import default_device
from threadstate.units import LengthUnit

pytestmark = pytest.mark.slow


def test_tasks_are_all_of_the_work_once() -> None:
    amount = Amount(random=250, beside=7, followed=2, centres=30)
    counts = dict.fromkeys(Part, 0)
    for task in tasks(amount):
        assert task.first == counts[task.part]
        assert 0 < task.count <= ITEMS_A_TASK[task.part]
        counts[task.part] += task.count
    assert counts == {Part.RANDOM: 250, Part.BESIDE: 7, Part.FOLLOWED: 2, Part.CHANGED: 30}


def test_every_pair_and_device_is_one_that_settles_and_the_first_are_the_default_ones() -> None:
    assert device_of(0) == default_device()
    assert pair_of(0).unit is LengthUnit.INCH
    assert {item(Part.RANDOM, number)[0].device for number in range(400)} == {*map(device_of, range(len(DEVICES)))}
    assert {item(Part.RANDOM, number)[0].pair for number in range(400)} == {*map(pair_of, range(len(PAIRS)))}


def test_a_small_study_contradicts_nothing_and_finds_minima_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(study, "FOLLOW_PARTS", 1)
    monkeypatch.setattr(study, "BOX", 2e-2)
    found = {part: Found() for part in Part}
    for task in (
        Task(Part.RANDOM, 0, 6),
        Task(Part.BESIDE, 0, 1),
        Task(Part.FOLLOWED, 19, 1),
        Task(Part.CHANGED, 2, 1),
    ):
        found[task.part].add(done(task))
    assert [one.states for one in found.values()] == [6, 1, 1, CHANGES]
    assert all(one.faults == [] for one in found.values())
    assert max(map(abs, found[Part.BESIDE].gains + found[Part.FOLLOWED].gains)) < CAME_BACK
    text = page(found)
    assert f"In all {8 + CHANGES} states: 0 without an answer" in text
    assert "## Contradicted" not in text


def test_what_is_without_an_answer_or_contradicted_is_listed() -> None:
    state = item(Part.RANDOM, 1)[0].settled(Found())
    found = {part: Found() for part in Part}
    undecided = Found(undecided=["a command: overlap"], outcomes=type(Found().outcomes)({"undecided, overlap": 1}))
    undecided.states, undecided.milliseconds = 1, [1.0]
    found[Part.RANDOM].add(undecided)
    found[Part.CHANGED].add(replace(undecided, faults=["another: a force of -1.00e-03 F"], undecided=[]))
    text = page(found)
    assert state.path
    assert "- a command: overlap" in text
    assert "- another: a force of -1.00e-03 F" in text
    assert np.isneginf(found[Part.BESIDE].overlap)
