"""The study of settled states beside the paper's: what is compared, and the page of it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from studies.settled.maps import MAPS, map_rows
from studies.settled.page import page
from studies.settled.study import PAPER_KINDS, SAME_AXIS_DEG, SETTLED_KINDS, ComparedPose, angle_deg, axis, compared
from studies.stability.maps import drawn
from threadstate.device.model import Outcome, SettledFlag, default_device
from threadstate.device.settle import settle_poses
from threadstate.library.grid import Grid
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
GRID = Grid(2.0, 2.0, 45.0)


@pytest.fixture(scope="module")
def poses() -> list[ComparedPose]:
    """The poses of a small grid."""
    states = [state for index in range(GRID.orientation_count) for state in solve_poses(PAIR, GRID.poses(index))]
    commands = [pose for index in range(GRID.orientation_count) for pose in GRID.poses(index)]
    return compared(states, settle_poses(PAIR, commands))


def test_the_angle_between_axes_is_that_of_the_rotation_between_them(poses: list[ComparedPose]) -> None:
    for one in poses:
        assert one.settled.pose is not None
        last, rest = (np.array(pose.rotation) for pose in (one.state.poses[-1], one.settled.pose))
        cosine = float(last[:, 2] @ rest[:, 2])
        assert one.apart_deg == pytest.approx(math.degrees(math.acos(min(cosine, 1.0))), abs=1e-5)
        assert one.lift == one.settled.pose.translation[2] - one.state.poses[-1].translation[2]
    assert angle_deg((0.0, 0.0, 1.0), (0.0, 1e-9, 1.0)) == pytest.approx(math.degrees(1e-9))
    assert axis(((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, 9.0))) == (3.0, 6.0, 9.0)


def test_a_bolt_that_rests_in_the_last_pose_agrees_and_no_turn_leads_away(poses: list[ComparedPose]) -> None:
    one = next(one for one in poses if one.paper_kind == "stable_three_point")
    contacts = (*one.settled.contacts, *one.settled.contacts, *one.settled.contacts)[:3]
    assert contacts
    there = replace(one.settled, pose=one.state.poses[-1], contacts=contacts, flags=())
    same = ComparedPose(one.state, there)
    assert (same.agrees, same.apart_deg, same.lift) == (True, 0.0, 0.0)
    assert (same.turns_away(2), same.turns_away(3)) == (False, False)
    first = ComparedPose(one.state, replace(there, pose=one.state.poses[0]))
    assert (first.turns_away(2), first.agrees) == (True, False)
    assert not ComparedPose(one.state, replace(there, contacts=contacts[:2])).agrees
    unknown = ComparedPose(one.state, replace(there, outcome=Outcome.UNDECIDED, pose=None))
    assert (unknown.settled_kind, unknown.agrees, unknown.turns_away(2)) == ("not settled", False, None)


def test_contacts_are_the_same_by_place_and_features(poses: list[ComparedPose]) -> None:
    one = next(one for one in poses if one.settled_kind in ("two", "three or more"))
    radius = PAIR.nominal_diameter / 2.0
    placed = tuple(
        replace(paper, point=rest.point, features=rest.features)
        for paper, rest in zip(one.state.contacts, one.settled.contacts, strict=False)
    )
    assert ComparedPose(replace(one.state, contacts=placed), one.settled).shared_contacts(radius) == len(placed)
    x, y, z = placed[0].point
    moved = replace(placed[0], point=(x + 0.06 * radius, y, z))
    assert ComparedPose(replace(one.state, contacts=(moved,)), one.settled).shared_contacts(radius) == 0


def test_other_poses_are_not_compared(poses: list[ComparedPose]) -> None:
    with pytest.raises(AssertionError):
        compared([poses[0].state], [poses[1].settled])


def test_the_page_counts_every_pose_once(poses: list[ComparedPose]) -> None:
    text = page(PAIR, default_device(), poses, [(default_device(), poses[::2])])
    words = " ".join(text.split())
    assert f"{len(poses):,} poses" in words
    rows = [line.split(" | ") for line in text.splitlines() if line.startswith("| ")]
    first = [row for row in rows if row[0].strip("| ").replace(" ", "_") in PAPER_KINDS and len(row) == 8]
    assert sum(int(row[1]) for row in first) == len(poses)
    for kind, column in zip(SETTLED_KINDS, range(2, 7), strict=True):
        counted = sum(int(row[column].partition(" ")[0]) for row in first)
        assert counted == sum(one.settled_kind == kind for one in poses), kind
    agree = sum(one.apart_deg is not None and one.apart_deg < SAME_AXIS_DEG and one.agrees for one in poses)
    assert f"pose: {agree} (" in words
    assert "500 N mm a rad" in words


def test_the_maps_have_a_shade_for_every_pose(poses: list[ComparedPose]) -> None:
    undecided = replace(poses[0].settled, outcome=Outcome.UNDECIDED, flags=(SettledFlag.UNSETTLED,), pose=None)
    odd = [ComparedPose(poses[0].state, undecided), *poses[1:]]
    for chart in MAPS:
        shades = [chart.shade_of(one) for one in odd]
        assert shades[0] == len(chart.shades) - 1
        assert set(shades) <= set(range(len(chart.shades)))
        picture = drawn(chart, map_rows(odd))
        assert all(shade.meaning in picture for shade in chart.shades)
