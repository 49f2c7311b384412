"""Thread on thread along its ridges, against branch and bound over rectangles of the whole thread."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.state_turns import begins_at, turns_of
from tests.contact.samples import Floats, random_poses
from threadstate.contact import _record_kernel as record
from threadstate.contact._solve_kernel import (
    NONE_BESIDE,
    OPTIONS_SIZE,
    S_CONVEX,
    S_PROVE,
    S_TIE,
    S_TURN_LIMIT,
    solve_rows,
)
from threadstate.contact._stage_kernel import THREAD_EDGE, THREAD_THREAD
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
LENGTHS = [record.O_POSE + 11, record.O_LAMBDA, record.O_MU]
FIRST_PAIR = record.O_CONTACT + record.P_PAIR
SECOND_PAIR = FIRST_PAIR + record.POINT_SIZE
THIRD_PAIR = FIRST_PAIR + 2 * record.POINT_SIZE


def rows(poses: Floats, *, rectangles: bool, turn_limit_deg: float = 4.0) -> Floats:
    options = np.zeros(OPTIONS_SIZE)
    options[S_TURN_LIMIT] = math.radians(turn_limit_deg)
    options[S_TIE] = 2e-11 * PAIR.thread_pitch
    options[S_CONVEX] = 1.0
    options[S_PROVE] = float(rectangles)
    found = np.empty((len(poses), record.RECORD_SIZE))
    solve_rows(np.radians(poses), options, PAIR.bolt.packed, PAIR.nut.packed, NONE_BESIDE, found)
    return found


@pytest.mark.parametrize(
    "poses",
    [
        pytest.param(random_poses(71, 20, tilt_deg=4.0), id="library tilts"),
        pytest.param(random_poses(72, 30, tilt_deg=4.0, phase_deg=25.0), id="near phase 0"),
    ],
)
def test_branch_and_bound_finds_no_other_contact(poses: Floats) -> None:
    """Heights of first contact and both turns, up to 4 deg of turn."""
    by_ridges, by_rectangles = rows(poses, rectangles=False), rows(poses, rectangles=True)
    assert (by_rectangles[:, record.O_STATUS] == 0.0).all()
    assert by_ridges[:, LENGTHS] == pytest.approx(by_rectangles[:, LENGTHS], abs=1e-10, nan_ok=True)


def test_where_threads_meet_first_rectangles_agree() -> None:
    grid = np.array([(r, p, f) for r in (2, 3, 4) for p in (1, 2, 3) for f in range(337, 360)], dtype=np.float64)
    by_ridges = rows(grid, rectangles=False)
    threads = grid[by_ridges[:, FIRST_PAIR] == THREAD_THREAD]
    assert len(threads) > 20
    by_rectangles = rows(threads, rectangles=True)
    assert (by_rectangles[:, FIRST_PAIR] == THREAD_THREAD).all()
    heights = by_ridges[by_ridges[:, FIRST_PAIR] == THREAD_THREAD][:, LENGTHS]
    assert heights == pytest.approx(by_rectangles[:, LENGTHS], abs=1e-10, nan_ok=True)


@pytest.mark.parametrize(("roll", "pitch", "first", "last"), [(3.0, 0.0, 358.05, 360.45), (4.0, 1.0, 358.8, 360.5)])
def test_a_maximum_beside_a_higher_one_is_not_missed(roll: float, pitch: float, first: float, last: float) -> None:
    """After turns of some 42 deg a narrow maximum of phi touches first; a higher one is 0.07 pitches from it."""
    phases = np.arange(first, last, 0.02)
    found = rows(
        np.column_stack([np.full((len(phases), 2), (roll, pitch)), phases]), rectangles=False, turn_limit_deg=45.0
    )
    assert (found[:, THIRD_PAIR] == THREAD_THREAD).all()
    assert np.abs(np.diff(np.degrees(found[:, record.O_MU]), 2)).max() < 1e-3


@pytest.mark.parametrize(
    ("roll", "pitch", "first", "last"), [(4.0, -1.0, 1.9, 5.4), (3.743486227662474, -0.9258258124254919, 1.0, 4.4)]
)
def test_a_maximum_between_two_columns_is_not_missed(roll: float, pitch: float, first: float, last: float) -> None:
    """After turns of more than 40 deg a maximum of phi that is narrower than 0.2 rad touches first."""
    phases = np.arange(first, last, 0.05)
    found = rows(
        np.column_stack([np.full((len(phases), 2), (roll, pitch)), phases]), rectangles=False, turn_limit_deg=45.0
    )
    assert (found[:, THIRD_PAIR] == THREAD_THREAD).all()
    rises = np.diff(np.degrees(found[:, record.O_MU]))
    assert 0.02 < rises.min() < rises.max() < 0.08


def test_a_slope_that_is_zero_to_the_last_bit_loses_no_ridge() -> None:
    """It becomes the end of an interval of regula falsi, and the next slope is divided by it."""
    phases = np.concatenate([np.linspace(358.72, 358.73, 21), 358.725 + 1e-5 * np.arange(-9, 10)])
    phases.sort()
    found = rows(
        np.column_stack([np.full((len(phases), 2), (4.0, 1.0)), phases]), rectangles=False, turn_limit_deg=45.0
    )
    assert (found[:, THIRD_PAIR] == THREAD_THREAD).all()
    line = np.polynomial.Polynomial.fit(phases, np.degrees(found[:, record.O_MU]), 3)
    assert np.abs(np.degrees(found[:, record.O_MU]) - line(phases)).max() < 1e-4


@pytest.mark.parametrize(
    ("roll", "pitch", "phase"),
    [
        (2.3765554300164116, -0.2565203772502024, 355.6896841092687),
        (1.7366872342489938, 1.0369774627216508, 351.5573062807184),
        (0.1523313873954289, -0.07175096633291825, -2.2865809436061966),
        (0.1522945109811422, -0.07177827029429122, -2.2866524262213623),
    ],
)
def test_a_contact_that_leaves_the_edge_of_the_nut_goes_on_below_it(roll: float, pitch: float, phase: float) -> None:
    """The second contact passes from the nut's edge to its thread there: the turn up to it stays continuous."""
    offsets = np.array([-1e-3, -1e-5, -1e-9, 0.0, 1e-9, 1e-5, 1e-3])
    poses = np.column_stack([np.full(len(offsets), roll), pitch + offsets, np.full(len(offsets), phase)])
    found = rows(poses, rectangles=False, turn_limit_deg=45.0)
    assert {THREAD_THREAD} <= set(found[:, SECOND_PAIR]) <= {THREAD_THREAD, THREAD_EDGE}
    turns = np.degrees(found[:, record.O_LAMBDA])
    assert np.abs(np.diff(turns)).max() < 3e-3
    assert rows(poses, rectangles=True, turn_limit_deg=3.0)[:, record.O_LAMBDA] == pytest.approx(
        found[:, record.O_LAMBDA], abs=1e-10
    )


def test_a_maximum_is_found_from_where_the_hessian_of_phi_is_indefinite() -> None:
    """Between two columns the ridge is curved: half way between its crossings is beside it, in the next flank."""
    beside = np.array(
        [
            (0.08860132664636602, 0.07254390603572067, 357.7137523329682),
            (0.08860131601863616, 0.07254389730259372, 357.7137523329544),
            (0.08860131430048063, 0.07254389717142203, 357.7137523329532),
        ]
    )
    found = rows(beside, rectangles=False, turn_limit_deg=45.0)
    assert (found[:, THIRD_PAIR] == THREAD_THREAD).all()
    assert np.degrees(found[:, record.O_MU]) == pytest.approx(16.69011, abs=1e-5)


@pytest.mark.parametrize(
    ("pose", "turn_deg"),
    [
        ((3.369019774851382, -1.1001146689814343, 2.0433122980857465), 39.078001676),
        ((3.3310918540478927, -0.8799982349090225, 1.9838556789131268), 38.846350272),
        ((3.7663217077731117, -0.04269541193205573, 2.1019398798287803), 36.559178740),
    ],
)
def test_a_crest_comes_into_a_root_late_in_a_turn(pose: tuple[float, float, float], turn_deg: float) -> None:
    """That lasts for a few tenths of a degree: ridges, even at instants 0.2 deg apart, stepped over it."""
    pair = pair_by_designation("M6")
    state = solve_pose(pair, *pose)
    assert state.mu_deg == pytest.approx(turn_deg, abs=1e-8)
    last = turns_of(pair, state)[-1]
    (contact,) = last.found
    assert (contact.bolt_region, contact.nut_region) == ("crest_fillet_pos", "root")
    assert begins_at(pair, last, np.array(contact.point), 1e-4, 1e-3)
