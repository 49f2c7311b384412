"""Contacts on ridges that are nearly level, and places so near to each other that they count as one elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from threadstate.device import _gap_kernel as gk
from threadstate.device import _modes_kernel as mk
from threadstate.device import _step_modes_kernel as sm
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.model import default_device
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0


def rolled(slope: float, moves: int) -> list[float]:
    """The azimuths of a contact whose deepest point, with the contact at theta, is 6.2 + slope (theta - 6.2)."""
    contact, gap, bracket = np.zeros(mk.CONTACT_SIZE), np.zeros(gk.GAP_SIZE), np.zeros(6)
    contact[mk.K_THETA] = 6.25
    azimuths = []
    for i in range(moves):
        gap[gk.G_THETA] = (6.2 + slope * (contact[mk.K_THETA] - 6.2)) % (2.0 * math.pi)
        sm.move_on_ridge(gap, i > 0, i, bracket, contact)
        azimuths.append(float(contact[mk.K_THETA]))
    return azimuths


def test_a_contact_that_rolls_to_and_fro_ever_farther_is_led_to_where_it_stays() -> None:
    """The deepest point is on the other side of the azimuth 0 at first."""
    first, second, *_ = rolled(-3.0, 2)
    assert first == pytest.approx(6.05, abs=1e-12)
    assert second == pytest.approx(6.2, abs=1e-12)


def test_one_that_rolls_on_in_one_sense_goes_where_it_is_deepest() -> None:
    assert rolled(0.5, 3) == pytest.approx([6.225, 6.2125, 6.20625], abs=1e-12)


def falls(path: AssemblyPath) -> int:
    """The points of a path's turns at which the bolt has fallen."""
    return sum(1 for point in path.points if point.solutions == 0)


def test_a_bolt_rolls_along_the_root_of_the_nut_and_engages() -> None:
    """Its crest lies along the nut's root on four places: Newton's method followed none of them, and it fell and fell.

    So it crept until it had no more points; the brute force engages, too (decision 44).
    """
    path = assemble_pose(UNC, -3.0, -1.0, 0.0, mu=0.2)
    assert (path.outcome, path.flags) == (AssemblyOutcome.ENGAGED, ())
    assert sum(1 for event in path.events if event.kind is PathEventKind.FALL) == 2
    assert falls(path) < 20
    assert path.energy is not None
    assert abs(path.energy.balance) < 1e-3 * default_device().in_unit(UNC.unit).push * R


def test_two_places_of_an_edge_beside_each_other_carry_the_bolt_at_once() -> None:
    """They are 0.028 nominal radii apart, and the bolt fell from one to the other and back."""
    path = assemble_pose(UNC, -1.0, -1.0, 270.0, mu=0.2)
    assert path.outcome is AssemblyOutcome.ENGAGED
    close = [
        point
        for point in path.points
        if any(
            math.dist(one.point, other.point) < sm.SAME_CONTACT * R
            for i, one in enumerate(point.contacts)
            for other in point.contacts[:i]
        )
    ]
    assert close
    assert falls(path) < 20


def test_another_solution_that_only_a_jump_leads_to_shortens_no_step() -> None:
    """Of two sets of contacts on a ridge one is 2e-4 nominal radii off, with other forces, in each step of 0.1 deg."""
    path = assemble_pose(UNC, -2.0, -1.0, 0.0, mu=0.2)
    assert path.outcome is AssemblyOutcome.ENGAGED
    back = [point for point in path.points if 184.0 < point.phase_deg < 222.0]
    assert len(back) < 200
