from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.coulomb import contact_step
from oracle.follow import Follower, Hand
from oracle.outcomes import followed_to_end
from threadstate.device.model import default_device
from threadstate.thread.catalogue import quarter_twenty_unc

PAIR = quarter_twenty_unc()
DEVICE = default_device().in_unit(PAIR.unit)
HAND = Hand(np.array(DEVICE.stiffness), DEVICE.centre, DEVICE.push)
LEAD = PAIR.thread_pitch / (PAIR.nominal_diameter / 2.0)


@pytest.mark.parametrize(("mu", "slip"), [(0.5, 0.0), (0.1, -0.7)])
def test_a_body_on_a_plane_sticks_or_slides(mu: float, slip: float) -> None:
    # One spring of stiffness 1 in each direction; pressed by 1, drawn along the plane by 0.3.
    rows = np.array([[[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]])
    forces = np.zeros((1, 3))
    step, solved = contact_step(
        rows, np.zeros(1), np.zeros((1, 2)), np.array([0.3, 0.0, -1.0]), np.eye(3), mu, forces, 1e-12
    )
    assert solved
    assert step == pytest.approx([0.0 if slip == 0.0 else 0.3 - mu, 0.0, 0.0], abs=1e-10)
    assert forces[0] == pytest.approx([1.0, -min(mu, 0.3), 0.0], abs=1e-10)


def test_without_friction_the_torque_is_the_change_of_potential() -> None:
    follower = Follower(PAIR, HAND, (0.0, -4.0, 0.0), 0.0)
    for k in range(1, 9):
        point = follower.step(0.0, k / 8)
    before, work = follower.potential, 0.0
    for k in range(1, 21):
        torque = point.torque
        point = follower.step(math.radians(0.5 * k), 1.0)
        work += 0.5 * (torque + point.torque) * math.radians(0.5)
    assert follower.potential - before == pytest.approx(work, abs=1e-5)


@pytest.mark.slow
def test_a_bolt_that_snaps_follows_the_lead() -> None:
    end, points = followed_to_end(PAIR, HAND, (0.0, -4.0, 330.0), 0.1, counter_deg=360.0)
    assert end.outcome == "engaged"
    assert end.snap_deg == pytest.approx(358.0, abs=1.5)
    assert points[-181].origin[2] - points[-1].origin[2] == pytest.approx(LEAD / 4.0, rel=0.01)


@pytest.mark.slow
def test_a_bolt_that_leans_away_finds_no_thread() -> None:
    end, _ = followed_to_end(PAIR, HAND, (0.0, 4.0, 0.0), 0.0, counter_deg=360.0)
    assert end.outcome == "no_snap"


def test_a_path_of_too_many_linear_steps_is_undecided() -> None:
    """It is followed until then: the push grows in 32 steps, of at least one linear step each."""
    end, points = followed_to_end(PAIR, HAND, (0.0, 4.0, 0.0), 0.0, counter_deg=360.0, most_linear_steps=50)
    assert end.outcome == "undecided"
    assert sum(point.linear_steps for point in points[:-1]) <= 50 < sum(point.linear_steps for point in points)
