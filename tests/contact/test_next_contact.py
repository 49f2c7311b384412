"""The step of each stage: a search, and what it finds refined; where that is no contact it is searched for again."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from threadstate.contact import _refine_kernel as refine
from threadstate.contact import _solve_kernel as solve
from threadstate.contact import _stage_kernel as stage
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()


@pytest.mark.parametrize(
    ("found", "settles", "expected", "searches"),
    [
        ([1], [True], 1, [False]),
        ([1, 1], [False, True], 1, [False, True]),
        ([1, 0], [False], 0, [False, True]),
        ([1, 1], [False, False], solve.UNDECIDED_CONTACT, [False, True]),
        ([-1], [], solve.UNDECIDED_CONTACT, [False]),
    ],
    ids=["found", "found again", "found to be none", "never certain", "a search without an end"],
)
def test_what_does_not_settle_is_searched_for_again_with_refined_edges(
    monkeypatch: pytest.MonkeyPatch, found: list[int], settles: list[bool], expected: int, searches: list[bool]
) -> None:
    asked: list[bool] = []
    answers = iter(settles)

    def search(*arguments: Any) -> tuple[int, int, float]:
        asked.append(arguments[2])
        count, contacts = found[len(asked) - 1], arguments[6]
        contacts[0, stage.K_TIME] = 0.01
        return max(count, 0), stage.RESOLVED if count >= 0 else stage.UNRESOLVED, 0.01

    def refined(*arguments: Any) -> tuple[float, bool]:
        return arguments[7], next(answers)

    monkeypatch.setattr(solve, "earliest", search)
    monkeypatch.setattr(refine, "refine_contact", refined)
    course = solve.new_course(stage.new_work())
    course.axis[2, 0] = 1.0
    scene = solve.Scene(packed_options(PAIR, SolveOptions()), PAIR.bolt.packed, PAIR.nut.packed)
    pose, exact = np.zeros(12), np.zeros((12, 2))
    stage.rotation(0.05, 0.02, 1.0, pose)
    exact[:, 0] = pose
    moved, latest = np.empty((12, 2)), np.empty((refine.REFINED_SIZE, 2))
    count, time = solve.next_contact.py_func(True, pose, exact, 1, math.pi / 4, 1e-12, scene, course, moved, latest)
    assert (count, asked) == (expected, searches)
    assert time == (0.01 if expected > 0 else math.pi / 4)
