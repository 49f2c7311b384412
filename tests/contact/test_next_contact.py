"""The step of each stage: a search, and what it finds refined; where that is no contact it is searched for again."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from threadstate.contact import _record_kernel as rk
from threadstate.contact import _refine_kernel as refine
from threadstate.contact import _solve_kernel as solve
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE
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
    poses, vectors, contacts = np.zeros((2, 12, 2)), np.zeros((2, 3, 2)), np.empty((2, refine.REFINED_SIZE, 2))
    course = solve.Course(
        pose=poses[0],
        second=poses[1],
        point=vectors[0],
        axis=vectors[1],
        motion=np.empty((WIDE_MOTION_SIZE, 2)),
        first=contacts[0],
        latest=contacts[1],
        known=np.empty((2, stage.CONTACT_SIZE)),
        found=np.empty((stage.MAX_CONTACTS, stage.CONTACT_SIZE)),
        guesses=solve.new_guesses(),
        work=stage.new_work(),
    )
    course.axis[2, 0] = 1.0
    options = packed_options(PAIR, SolveOptions())
    scene = solve.Scene(options, PAIR.bolt.packed, PAIR.nut.packed, options[solve.S_TIE])
    pose, exact = np.zeros(12), np.zeros((12, 2))
    stage.rotation(0.05, 0.02, 1.0, pose)
    exact[:, 0] = pose
    moved, latest = np.empty((12, 2)), np.empty((refine.REFINED_SIZE, 2))
    count, time = solve.next_contact.py_func(True, pose, exact, 1, math.pi / 4, 1e-12, scene, course, moved, latest)
    assert (count, asked) == (expected, searches)
    assert time == (0.01 if expected > 0 else math.pi / 4)


@pytest.mark.parametrize(
    ("pose_deg", "turns"),
    [((1.0, -2.0, 10.0), 1), ((1.05e-6, 6.77e-7, -1.7614), 2)],
    ids=["tilted", "nearly level: again, with the tie of its tilt"],
)
def test_a_pose_whose_second_turn_is_undecided_has_its_first_pose_alone(
    monkeypatch: pytest.MonkeyPatch, pose_deg: tuple[float, float, float], turns: int
) -> None:
    """The stages interpreted, with turns about one contact that no search decides."""
    next_contact = solve.next_contact
    ties: list[float] = []

    def contact(*arguments: Any) -> tuple[int, float]:
        is_turn, limit, tie = arguments[0], arguments[4], arguments[5]
        if not is_turn:
            result: tuple[int, float] = next_contact(*arguments)
            return result
        ties.append(tie)
        return solve.UNDECIDED_CONTACT, limit

    monkeypatch.setattr(solve, "next_contact", contact)
    for name in ("solve_stages", "first_stage", "second_stage"):
        monkeypatch.setattr(solve, name, getattr(solve, name).py_func)
    row = np.empty(rk.RECORD_SIZE)
    solve.solve_pose.py_func(
        *map(math.radians, pose_deg),
        packed_options(PAIR, SolveOptions()),
        PAIR.bolt.packed,
        PAIR.nut.packed,
        solve.new_guesses(),
        stage.new_work(),
        row,
    )
    assert (row[rk.O_STATUS], row[rk.O_POSES]) == (stage.UNRESOLVED, 1)
    assert len(ties) == turns
    assert ties == sorted(ties, reverse=True)
