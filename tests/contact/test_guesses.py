"""Contacts of the poses next to one, by which its own are looked for first: they say how long that takes, no more."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.contact import _guess_kernel as near
from threadstate.contact import _record_kernel as rk
from threadstate.contact import _refine_kernel as refine
from threadstate.contact import _solve_kernel as solve
from threadstate.contact import _stage_kernel as stage
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE
from threadstate.state.options import SolveOptions
from threadstate.state.records import packed_options, solve_records
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()
OPTIONS = SolveOptions()

LIMIT, TIE = math.pi / 4, 1e-12
EDGE_CONTACT, LATER = 0.01, 0.02
NEARLY_LATE = (1.0 + solve.GUESS_MARGIN) * (EDGE_CONTACT + TIE)


def in_order(roll_deg: float, pitch_deg: float, step_deg: float = 3.0) -> Floats:
    """Poses around a turn, in the order of their phases."""
    phases = np.arange(0.0, 360.0, step_deg / 2.0)
    return np.column_stack([np.full((len(phases), 2), (roll_deg, pitch_deg)), phases])


def boxes_and_records(pair: Pair, poses_deg: Floats, beside: Floats = solve.NONE_BESIDE) -> tuple[int, Floats]:
    records = np.empty((len(poses_deg), rk.RECORD_SIZE))
    packed = packed_options(pair, OPTIONS)
    boxes = solve.solve_rows(np.radians(poses_deg), packed, pair.bolt.packed, pair.nut.packed, beside, records)
    return boxes, records


def alone(pair: Pair, poses_deg: Floats) -> tuple[int, Floats]:
    """The same of poses in an order in which none has a guess."""
    order = np.argsort(np.arange(len(poses_deg)) * 37 % len(poses_deg), kind="stable")
    boxes, records = boxes_and_records(pair, poses_deg[order])
    return boxes, records[np.argsort(order)]


@pytest.mark.parametrize("tilt_deg", [(-3.0, 4.0), (1.0, 0.0), (2.0, -2.0), (1e-3, 2e-3)])
def test_the_pose_before_spares_boxes_and_changes_no_bit(tilt_deg: tuple[float, float]) -> None:
    poses = in_order(*tilt_deg)
    boxes, records = boxes_and_records(PAIR, poses)
    boxes_alone, records_alone = alone(PAIR, poses)
    np.testing.assert_array_equal(records, records_alone)
    assert boxes < 0.95 * boxes_alone


def test_nor_does_it_of_a_metric_pair() -> None:
    pair, poses = pair_by_designation("M6x1"), in_order(-2.0, 1.0)
    boxes, records = boxes_and_records(pair, poses)
    boxes_alone, records_alone = alone(pair, poses)
    np.testing.assert_array_equal(records, records_alone)
    assert boxes < 0.95 * boxes_alone


def test_records_of_any_other_poses_change_no_bit() -> None:
    poses = in_order(-3.0, 4.0, 8.0)
    near, far = (solve_records(PAIR, OPTIONS, poses + shift) for shift in ((0.0, 0.0, 0.3), (0.5, -1.0, 40.0)))
    boxes_alone, records_alone = alone(PAIR, poses)
    boxes_near, records = boxes_and_records(PAIR, poses, np.stack([near, far], axis=1))
    np.testing.assert_array_equal(records, records_alone)
    _, records = boxes_and_records(PAIR, poses, np.stack([far, far], axis=1))
    np.testing.assert_array_equal(records, records_alone)
    assert boxes_near < boxes_alone


def test_level_poses_between_others_leave_each_its_own_guesses() -> None:
    poses = in_order(-3.0, 4.0, 30.0)
    poses[::3, :2] = 0.0
    tilted = poses[:, 0] != 0.0
    near = solve_records(PAIR, OPTIONS, poses + np.array([0.0, 0.0, 0.2]))
    both = np.stack([near, near], axis=1)
    found = solve_records(PAIR, OPTIONS, poses, beside=both)
    np.testing.assert_array_equal(found[tilted], alone(PAIR, poses[tilted])[1])


def course_with(guess: float, pair: int, monkeypatch: pytest.MonkeyPatch) -> solve.Course:
    """A course on which a contact is guessed; NaN: none is."""

    def guessed(*arguments: Any) -> bool:
        contact = arguments[-1]
        contact[stage.K_TIME], contact[stage.K_PAIR] = guess, pair
        return not math.isnan(guess)

    monkeypatch.setattr(near, "earliest_guess", guessed)
    monkeypatch.setattr(solve, "limit_by_guess", solve.limit_by_guess.py_func)
    course = solve.Course(
        pose=np.zeros((12, 2)),
        second=np.zeros((12, 2)),
        point=np.zeros((3, 2)),
        axis=np.zeros((3, 2)),
        motion=np.empty((WIDE_MOTION_SIZE, 2)),
        first=np.empty((refine.REFINED_SIZE, 2)),
        latest=np.empty((refine.REFINED_SIZE, 2)),
        known=np.empty((2, stage.CONTACT_SIZE)),
        found=np.empty((stage.MAX_CONTACTS, stage.CONTACT_SIZE)),
        guesses=solve.new_guesses(),
        work=stage.new_work(),
    )
    course.axis[2, 0] = 1.0
    return course


EDGE, THREAD, SURFACE = stage.EDGE_EDGE, stage.THREAD_THREAD, stage.THREAD_SURFACE


@pytest.mark.parametrize(
    ("guess", "guessed_pair", "found", "settles", "searches"),
    [
        (math.nan, EDGE, [(1, EDGE, EDGE_CONTACT)], True, ["far"]),
        (EDGE_CONTACT, EDGE, [(1, EDGE, EDGE_CONTACT)], True, ["near"]),
        (LATER, EDGE, [(1, EDGE, EDGE_CONTACT)], True, ["near"]),
        (0.5 * EDGE_CONTACT, EDGE, [(0, EDGE, 0.0), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (EDGE_CONTACT, EDGE, [(-1, EDGE, 0.0), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (LATER, EDGE, [(1, THREAD, EDGE_CONTACT), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (LATER, EDGE, [(1, SURFACE, EDGE_CONTACT), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (LATER, EDGE, [(2, EDGE, EDGE_CONTACT), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (EDGE_CONTACT, EDGE, [(1, EDGE, NEARLY_LATE), (1, EDGE, EDGE_CONTACT)], True, ["near", "far"]),
        (EDGE_CONTACT, EDGE, [(1, EDGE, EDGE_CONTACT), (1, EDGE, EDGE_CONTACT)], False, ["near", "far"]),
        (EDGE_CONTACT, THREAD, [(1, EDGE, EDGE_CONTACT)], True, ["far"]),
    ],
    ids=[
        "no guess",
        "the contact",
        "a later one",
        "none there",
        "not certain",
        "thread on thread found",
        "thread on the surface found",
        "two at once",
        "as late as the limit",
        "no solution from fewer digits",
        "thread on thread guessed",
    ],
)
def test_where_a_guess_might_decide_the_search_is_made_without(
    monkeypatch: pytest.MonkeyPatch,
    guess: float,
    guessed_pair: int,
    found: list[tuple[int, int, float]],
    settles: bool,
    searches: list[str],
) -> None:
    course = course_with(guess, guessed_pair, monkeypatch)
    asked: list[str] = []

    def search(*arguments: Any) -> tuple[int, int, float]:
        limit, contacts = arguments[1].limit, arguments[6]
        asked.append("far" if limit == LIMIT else "near")
        count, pair, time = found[len(asked) - 1]
        contacts[:2, stage.K_TIME], contacts[:2, stage.K_PAIR] = time, pair
        contacts[:2, stage.K_X], contacts[:2, stage.K_Y] = (1.0, -1.0), 0.5
        return max(count, 0), stage.RESOLVED if count >= 0 else stage.UNRESOLVED, time

    monkeypatch.setattr(solve, "earliest", search)

    def refined(*arguments: Any) -> tuple[float, bool]:
        time, as_found = arguments[7], arguments[9]
        return time, as_found or settles

    monkeypatch.setattr(refine, "refine_contact", refined)
    options = packed_options(PAIR, OPTIONS)
    scene = solve.Scene(options, PAIR.bolt.packed, PAIR.nut.packed, TIE)
    pose, exact = np.zeros(12), np.zeros((12, 2))
    stage.rotation(0.05, 0.02, 1.0, pose)
    exact[:, 0] = pose
    moved, latest = np.empty((12, 2)), np.empty((refine.REFINED_SIZE, 2))
    count, time = solve.next_contact.py_func(True, pose, exact, 1, LIMIT, TIE, scene, course, moved, latest)
    assert (count, time, asked) == (1, EDGE_CONTACT, searches)
