"""Where the origin lies over the pivot axis: the shorter of two turns, and none that is not certain."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.contact.samples import Floats
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _solve_kernel as sk
from threadstate.contact._stage_kernel import RESOLVED, UNRESOLVED, new_work
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.profile import outline_is_convex

PAIR = quarter_twenty_unc()
BALANCED_RAD = (math.radians(-9.26), math.radians(3.52), math.radians(1.936952337))
"""Roll, pitch, phase: balanced within a tolerance of 1e-6 thread pitches."""

Sense = tuple[float, int]
SHORT, LONG, NONE, UNKNOWN = 0.1, 0.2, math.nan, math.nan


@pytest.mark.parametrize(
    ("senses", "expected"),
    [
        (((SHORT, RESOLVED), (LONG, RESOLVED)), (SHORT, RESOLVED)),
        (((LONG, RESOLVED), (SHORT, RESOLVED)), (SHORT, RESOLVED)),
        (((NONE, RESOLVED), (LONG, RESOLVED)), (LONG, RESOLVED)),
        (((LONG, RESOLVED), (NONE, RESOLVED)), (LONG, RESOLVED)),
        (((UNKNOWN, UNRESOLVED), (SHORT, RESOLVED)), (None, UNRESOLVED)),
        (((SHORT, RESOLVED), (UNKNOWN, UNRESOLVED)), (None, UNRESOLVED)),
        (((UNKNOWN, UNRESOLVED), (NONE, RESOLVED)), (None, UNRESOLVED)),
        (((SHORT, UNRESOLVED), (LONG, RESOLVED)), (SHORT, UNRESOLVED)),
        (((LONG, RESOLVED), (SHORT, UNRESOLVED)), (SHORT, UNRESOLVED)),
        (((LONG, UNRESOLVED), (SHORT, RESOLVED)), (SHORT, RESOLVED)),
        (((SHORT, RESOLVED), (LONG, UNRESOLVED)), (SHORT, RESOLVED)),
    ],
)
def test_a_sense_that_is_unresolved_is_not_dropped(
    monkeypatch: pytest.MonkeyPatch, senses: tuple[Sense, Sense], expected: tuple[float | None, int]
) -> None:
    """The stages interpreted, with a third stage that finds the turns and the statuses of ``senses``.

    An unresolved sense whose turn is known, and longer, does not matter: only its embedment is unresolved. Where the
    pose is unresolved it is solved once more, with a nearer tie.
    """
    followed: list[Floats] = []

    def third_stage(_scene: sk.Scene, course: sk.Course, row: Floats) -> None:
        row[rk.O_MU], row[rk.O_STATUS] = senses[len(followed) % 2]
        followed.append(course.axis.copy())

    monkeypatch.setattr(sk, "third_stage", third_stage)
    for stage in ("solve_stages", "first_stage", "second_stage", "next_contact"):
        monkeypatch.setattr(sk, stage, getattr(sk, stage).py_func)
    options = np.zeros(sk.OPTIONS_SIZE)
    options[[sk.S_TURN_LIMIT, sk.S_TIE]] = math.radians(45.0), 1e-6 * PAIR.thread_pitch
    options[sk.S_CONVEX] = outline_is_convex(PAIR.bolt) and outline_is_convex(PAIR.nut)
    row = np.empty(rk.RECORD_SIZE)
    sk.solve_pose.py_func(*BALANCED_RAD, options, PAIR.bolt.packed, PAIR.nut.packed, sk.new_guesses(), new_work(), row)
    assert int(row[rk.O_FLAGS]) & rk.FLAG_BALANCED
    np.testing.assert_array_equal(followed[0], -followed[1])
    assert len(followed) == (2 if expected[1] == RESOLVED else 4)
    assert row[rk.O_STATUS] == expected[1]
    if expected[0] is not None:
        assert row[rk.O_MU] == expected[0]
