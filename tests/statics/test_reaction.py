"""The least wrench that a hand must supply (forces, section 3)."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from threadstate.state.model import Flag
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.statics._cone_kernel import boundary_step
from threadstate.statics.load import Load
from threadstate.statics.reaction import reaction_of
from threadstate.statics.solve import statics_of
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
RADIUS = PAIR.nominal_diameter / 2.0
POSES = np.random.default_rng(3).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (40, 3))
ACROSS = Load(force=(0.3, -0.1, -2.0), moment=(0.01, 0.0, 0.005))


@pytest.mark.parametrize("load", [None, ACROSS])
@pytest.mark.parametrize("mu", [0.0, 0.15, 0.5])
def test_no_smaller_wrench_will_do_and_none_is_needed_where_the_contacts_hold_it(load: Load | None, mu: float) -> None:
    seen = set()
    for state in solve_poses(PAIR, POSES):
        found = reaction_of(PAIR, state, load, mu)
        held = mu >= statics_of(PAIR, state, load, mu).hold.upper
        assert (found.size == 0.0) == held
        assert found.size - found.least_size <= 1e-9 * max(1.0, found.size)
        norm = math.hypot(*found.force, *(number / RADIUS for number in found.moment))
        assert norm == pytest.approx(found.size, rel=1e-12)
        seen.add((held, Flag.FLUSH in state.flags))
    assert len(seen) > 1


def test_with_it_the_contacts_hold_the_load() -> None:
    """With a little more of it, since it ends on the boundary of what they hold."""
    for state in solve_poses(PAIR, POSES[:12]):
        found = reaction_of(PAIR, state, ACROSS, 0.3)
        if found.size == 0.0:
            continue
        origin = state.poses[-1].translation
        about = ACROSS.about(origin)
        more = 1.0 + 1e-5
        moment = about[:3] + more * np.array(found.moment)
        force = about[3:] + more * np.array(found.force)
        load = Load(force=(force[0], force[1], force[2]), moment=(moment[0], moment[1], moment[2]))
        left = reaction_of(PAIR, state, load, 0.3)
        assert left.size < 2e-5 * found.size


def test_it_is_as_large_as_the_load_and_the_same_about_any_point() -> None:
    state = solve_pose(PAIR, 1.0, -2.0, 10.0)
    found = reaction_of(PAIR, state, ACROSS, 0.1)
    tenfold = replace(ACROSS, force=(3.0, -1.0, -20.0), moment=(0.1, 0.0, 0.05))
    assert reaction_of(PAIR, state, tenfold, 0.1).size == pytest.approx(10.0 * found.size, rel=1e-9)
    origin = np.array(state.poses[-1].translation)
    point = np.array([0.3, -0.2, 0.1])
    moment = np.array(ACROSS.moment) + np.cross(origin - point, ACROSS.force)
    moved = replace(ACROSS, moment=(moment[0], moment[1], moment[2]), point=(0.3, -0.2, 0.1))
    assert reaction_of(PAIR, state, moved, 0.1).size == pytest.approx(found.size, rel=1e-9)


def test_a_step_along_the_axis_of_a_cone_ends_at_its_apex() -> None:
    """Both roots of the boundary are one there, and round-off may leave none."""
    for depth in np.random.default_rng(1).uniform(0.1, 3.0, 200):
        point, direction = np.array([depth, 0.1 * depth, 0.2 * depth]), np.array([-1.0, -0.1, -0.2])
        assert boundary_step(point, direction, 0, 3) == pytest.approx(depth, rel=1e-7)
