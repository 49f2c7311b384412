"""The study of chamfers on a tiny extent."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from oracle.chamfer import Samples
from studies.chamfer.page import course_picture, page, window_picture
from studies.chamfer.study import (
    ENDS,
    PAIRS,
    Course,
    Found,
    chamfered,
    course,
    done,
    gathered,
    orientations,
    tasks,
)
from threadstate.history.build import histories_of
from threadstate.history.window import windows_of
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation

pytestmark = pytest.mark.slow

UNC = pair_by_designation("1/4-20 UNC")


def made_up(name: str, end: float) -> Found:
    """A bolt whose numbers are told apart on the page."""
    heights = tuple(0.2 + 0.1 * end - (0.15 if 40 <= i < 80 else 0.0) for i in range(120))
    touching = ("cone-edge",) * 90 + ("outline-thread",) * 30
    return Found(name, end, (Course(heights, touching, 10.0 + end), Course(heights, touching, 12.0 + end)))


def test_a_flat_bolts_course_is_that_of_the_exact_method() -> None:
    found = course(chamfered(UNC, 0.0), 2.0, -4.0, step_deg=15.0, samples=Samples(edge=720, around=240, along=40))
    for i, height in enumerate(found.heights):
        exact = solve_pose(UNC, 2.0, -4.0, 15.0 * i).poses[0].translation[2]
        assert height * UNC.thread_pitch == pytest.approx(exact, abs=1e-6 * UNC.thread_pitch)
    (history,) = histories_of(UNC, [(2.0, -4.0)], SolveOptions())
    assert found.window_deg == pytest.approx(sum(one.width_deg for one in windows_of(UNC, history)), abs=0.3)


def test_a_chamfer_lowers_heights_and_names_the_cone() -> None:
    flat, cut = (course(chamfered(UNC, end), 2.0, -4.0, step_deg=30.0) for end in (0.0, 1.1))
    assert all(b <= a + 1e-6 for a, b in zip(flat.heights, cut.heights, strict=True))
    assert any(kind.startswith(("cone", "rim")) for kind in cut.touching)
    assert not any(kind.startswith(("cone", "rim")) for kind in flat.touching)


def test_the_steepest_fall_is_within_three_degrees() -> None:
    assert made_up("1/4-20 UNC", 0.0).steepest == pytest.approx(0.15)
    slope = Course(tuple(1.0 - i / 360.0 for i in range(360)), ("outline-edge",) * 360, 0.0)
    assert slope.steepest == pytest.approx(3.0 / 360.0)


def test_tasks_are_gathered_by_pair_and_end() -> None:
    to_do = tasks((-1.0, 1.0), 120.0)
    assert len(to_do) == len(PAIRS) * len(ENDS) * 4
    few = [task for task in to_do if task[1] in (0.0, 1.1) and task[2] == (1.0, 1.0)]
    found = gathered(few, [done(task) for task in few])
    assert [(one.designation, one.end) for one in found] == [(name, end) for name in PAIRS for end in (0.0, 1.1)]
    assert all(len(one.courses) == 1 and len(one.courses[0].heights) == 3 for one in found)


def test_the_level_orientation_is_left_out() -> None:
    assert orientations((0.0, 1.0)) == [(0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]


def test_every_bolt_is_on_the_page() -> None:
    found = [made_up(name, end) for name in PAIRS for end in ENDS]
    text = page(found, 3.0)
    for one in found:
        row = f"| {one.window_deg:.1f} | 15.0 | 2 of 2 | {100 * one.highest:.1f} | {100 * one.lowest:.1f} |"
        assert text.count(row) == len(PAIRS), row
    assert re.search(r"\| the cone on the nut's edge \|( 75\.0 \|){7}", text)
    assert "0.2489 in, major: flat" in text
    assert "| -4 | -4 | 15.0 | 15.0 | 10.0 | 11.1 |" in text
    assert window_picture(found) == window_picture(found)
    assert "phase (deg)" in course_picture(found)
    assert replace(found[0], courses=found[0].courses[:1]).window_deg == 10.0
