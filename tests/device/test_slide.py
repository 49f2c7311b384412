"""Bolts that lie flush on the nut's surface with friction: the pressure, where they slide to, and how they leave."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.typing import NDArray

from threadstate.device import _chart_kernel as ck
from threadstate.device import _flush_kernel as fl
from threadstate.device import _leg_kernel as lk
from threadstate.device import _patch_kernel as pk
from threadstate.device import _slide_kernel as sl
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyPath, ContactMotion, Held, PathEventKind
from threadstate.device.command import command_numbers
from threadstate.device.equilibrium import BALANCED
from threadstate.device.model import Outcome, SettledFlag, default_device
from threadstate.device.settle import device_numbers, settle_pose
from threadstate.state.model import FeaturePair
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
BOLT, NUT = UNC.bolt.packed, UNC.nut.packed
R = UNC.nominal_diameter / 2.0
DEVICE = default_device().in_unit(UNC.unit)
PUSH = DEVICE.push
MU = 0.15
START = (1.0, -3.0, 100.0)


@pytest.fixture(scope="module")
def path() -> AssemblyPath:
    """A bolt that comes to lie flush as it is turned, slides there, and tips off again."""
    return assemble_pose(UNC, *START, mu=MU)


def ring(count: int) -> Floats:
    """Points of an outline that is no circle."""
    theta = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    points = np.zeros((pk.POINTS, pk.POINT_SIZE))
    points[:count, pk.H_X] = (1.0 + 0.1 * np.cos(theta)) * np.cos(theta)
    points[:count, pk.H_Y] = np.sin(theta)
    return points


@pytest.mark.parametrize(("x", "y"), [(0.0, 0.0), (0.4, -0.2), (-0.5, 0.7), (0.95, 0.0)])
def test_the_pressure_is_positive_and_has_its_centre(x: float, y: float) -> None:
    """Also near the hull's border: the weights of greatest entropy, each ``exp`` of a linear function."""
    points, weights = ring(300), np.zeros(pk.POINTS)
    assert sl.set_weights(300, points, x, y, 1.0, np.zeros(2), weights)
    assert weights[:300].min() > 0.0
    assert weights[:300].sum() == pytest.approx(1.0, abs=1e-12)
    assert weights[:300] @ points[:300, :2] == pytest.approx([x, y], abs=1e-11)
    plane = np.column_stack([points[:300, :2], np.ones(300)])
    logarithms = np.log(weights[:300])
    fitted, _, _, _ = np.linalg.lstsq(plane, logarithms)
    assert plane @ fitted == pytest.approx(logarithms, abs=1e-9)


def test_the_pressure_does_not_depend_on_the_rates_with_which_the_search_begins() -> None:
    """Those of a centre near by are set, and lead to the same weights."""
    points, weights, others = ring(300), np.zeros(pk.POINTS), np.zeros(pk.POINTS)
    rates = np.zeros(2)
    assert sl.set_weights(300, points, 0.35, -0.25, 1.0, rates, weights)
    assert np.abs(rates).min() > 0.1
    assert sl.set_weights(300, points, 0.4, -0.2, 1.0, rates, weights)
    assert sl.set_weights(300, points, 0.4, -0.2, 1.0, np.zeros(2), others)
    assert weights[:300] == pytest.approx(others[:300], rel=1e-9)


def test_a_centre_outside_the_points_has_no_pressure() -> None:
    assert not sl.set_weights(300, ring(300), 1.05, 0.6, 1.0, np.zeros(2), np.zeros(pk.POINTS))


@pytest.mark.parametrize("phase_deg", [150.0, 250.0])
def test_a_bolt_settles_flush_with_friction(phase_deg: float) -> None:
    """Balanced, inside its cone and its patch; without being turned friction holds it where it came to lie."""
    state = settle_pose(UNC, 0.5, -0.5, phase_deg, mu=MU)
    assert (state.outcome, state.flags) == (Outcome.SETTLED, (SettledFlag.FLUSH,))
    (contact,) = state.contacts
    assert contact.features is FeaturePair.FLUSH
    assert contact.normal == (0.0, 0.0, 1.0)
    assert math.hypot(*contact.force[:2]) <= MU * contact.force[2] * (1.0 + 1e-9)
    assert state.margins.residual is not None
    assert state.margins.pressure is not None
    assert state.margins.residual <= BALANCED
    assert state.margins.pressure > 0.0


@pytest.mark.parametrize("turn_deg", [0.2, -1.0])
def test_friction_balances_the_hand_where_the_bolt_slides_to(turn_deg: float) -> None:
    """The sum over the patch's points, each against its own slip, computed again from poses alone."""
    numbers = device_numbers(UNC, DEVICE)
    command = command_numbers(DEVICE, 0.5, -0.5, 0.0)
    before, place = np.zeros(ck.PLACE_SIZE), np.zeros(ck.PLACE_SIZE)
    level, lying = np.zeros(ck.COORDINATES), np.zeros(sl.LYING_SIZE)
    lk.set_phase(math.radians(250.0), command, numbers)
    assert fl.set_flush(numbers, level)
    ck.set_place(level, numbers, before)
    lk.set_phase(math.radians(250.0 + turn_deg), command, numbers)
    stays, _ = sl.lie_flush(PUSH, MU, True, before, numbers, BOLT, NUT, level, lying)
    assert stays
    ck.set_place(level, numbers, place)
    points, weights = np.zeros((pk.POINTS, pk.POINT_SIZE)), np.zeros(pk.POINTS)
    count = pk.patch_points(before_at(before, place), BOLT, NUT, points)
    assert sl.set_weights(count, points, lying[sl.L_X], lying[sl.L_Y], R, np.zeros(2), weights)
    now = np.column_stack([points[:count, :2], np.zeros(count)])
    turned = before[:9].reshape(3, 3) @ place[:9].reshape(3, 3).T
    slips = now - (before[12:15] + (now - place[12:15]) @ turned.T)
    forces = -MU * lying[sl.L_FORCE] * weights[:count, None] * slips / np.linalg.norm(slips, axis=1)[:, None]
    by_q = np.zeros(ck.COORDINATES)
    ck.elastic_energy(level, numbers, by_q)
    assert forces.sum(axis=0)[:2] == pytest.approx(by_q[3:5], abs=1e-8 * PUSH)
    assert lying[sl.L_FRICTION : sl.L_FRICTION + 2] == pytest.approx(by_q[3:5], abs=1e-10 * PUSH)
    centre = np.array([lying[sl.L_X], lying[sl.L_Y], 0.0])
    moment = np.cross(now - centre, forces).sum(axis=0)[2]
    assert lying[sl.L_MOMENT] == pytest.approx(moment, abs=1e-8 * PUSH * R)
    assert moment * turn_deg < 0.0
    assert lying[sl.L_LOSS] == pytest.approx(-(forces * slips).sum(), rel=1e-7)


def before_at(before: Floats, place: Floats) -> Floats:
    """The place at which a step's patch is taken: turned as after it, with the centre where it was."""
    at = place.copy()
    at[9:12] += before[12:15] - place[12:15]
    at[12:15] = before[12:15]
    return at


def test_a_flush_bolt_is_turned_and_leaves_the_surface(path: AssemblyPath) -> None:
    """Its contact is the resultant inside the cone, the torque is against the turn, and energy is balanced."""
    kinds = [event.kind for event in path.events]
    assert kinds.index(PathEventKind.ON_SURFACE) < kinds.index(PathEventKind.OFF_SURFACE)
    flush = [point for point in path.points if point.held is Held.SURFACE]
    assert len(flush) > 20
    for point in flush[1:]:
        (contact,) = point.contacts
        assert contact.features is FeaturePair.FLUSH
        assert point.motions == (ContactMotion.SLIDES,)
        assert math.hypot(*contact.force[:2]) <= MU * contact.force[2]
        assert 0.0 < point.torque < MU * PUSH * 2.0 * R
    assert path.energy is not None
    assert abs(path.energy.balance) < 1e-3 * path.energy.friction
    assert all(after.phase_deg > before.phase_deg for before, after in pairwise(flush))


def test_a_compliant_twist_is_refused_on_the_surface() -> None:
    """Its angle would be a third unknown: said by name, where the rigid twist of the default device settles."""
    stiffness = np.array(default_device().stiffness)
    stiffness[2, 2] = 1000.0
    device = replace(default_device(), stiffness=tuple(map(tuple, stiffness)), twist_is_rigid=False)
    state = settle_pose(UNC, 0.5, -0.5, 250.0, device, mu=MU)
    assert (state.outcome, state.flags) == (Outcome.UNDECIDED, (SettledFlag.FLUSH,))


def test_little_friction_leaves_the_frictionless_path() -> None:
    """With mu = 1e-6 a bolt flush on the surface lies where it does without friction."""
    with_friction = settle_pose(UNC, 0.5, -0.5, 250.0, mu=1e-6)
    without = settle_pose(UNC, 0.5, -0.5, 250.0)
    assert with_friction.pose is not None
    assert without.pose is not None
    assert with_friction.pose.translation == pytest.approx(without.pose.translation, abs=1e-5 * R)
