"""Least frictions beside the witness, and the laws that they obey (forces, section 3)."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.statics import friction as witness
from oracle.statics.wrenches import Wrench
from tests.statics.test_check_values import hold, wedge
from threadstate.state.solve import solve_pose
from threadstate.statics import _friction_kernel as fk
from threadstate.statics.hold_bounds import sharpened
from threadstate.statics.load import Load
from threadstate.statics.solve import statics_of
from threadstate.statics.touching import touching
from threadstate.statics.verdict import FrictionBounds, Verdict
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]


def scenes(count: int, contacts: int, seed: int) -> list[tuple[Floats, Floats, Floats]]:
    """Random points, normals that mostly look up, and loads that mostly push down."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(count):
        points = rng.normal(size=(contacts, 3)) * [1.0, 1.0, 0.3]
        normals = rng.normal(size=(contacts, 3)) * 0.6 + [0.0, 0.0, 1.0]
        load = rng.normal(size=6) * 0.2 + [0.0, 0.0, 0.0, 0.0, 0.0, -1.0]
        found.append((points, normals / np.linalg.norm(normals, axis=1)[:, np.newaxis], load))
    return found


def agree(ours: tuple[int, float, float], theirs: witness.FrictionBounds, tolerance: float) -> bool:
    """Whether two pairs of bounds have a value in common, within a tolerance of the angle."""
    if ours[0] == fk.NEVER or math.isinf(theirs.lower):
        return ours[0] == fk.NEVER and math.isinf(theirs.lower)
    upper = math.inf if theirs.upper is None else theirs.upper
    return bool(
        math.atan(ours[1]) <= math.atan(upper) + tolerance and math.atan(theirs.lower) <= math.atan(ours[2]) + tolerance
    )


@pytest.mark.parametrize(("contacts", "count"), [(2, 20), (3, 30), (4, 15), (6, 6)])
def test_least_frictions_are_the_witnesses(contacts: int, count: int) -> None:
    for points, normals, load in scenes(count, contacts, seed=contacts):
        push = Wrench.of(load[3:], load[:3])
        assert agree(wedge(points, normals)[:3], witness.wedge_friction(points, normals, 1.0), 1e-9)
        assert agree(hold(load, points, normals), witness.hold_friction(points, normals, push, 1.0), 1e-7)


def test_bounds_of_three_contacts_are_narrow() -> None:
    """Nearly all to round-off; limits that are only approached, with forces that grow, to some parts in a billion."""
    widths = []
    for points, normals, load in scenes(600, 3, seed=7):
        for status, lower, upper in (wedge(points, normals)[:3], hold(load, points, normals)):
            assert status == fk.FOUND
            assert 0.0 <= lower <= upper < math.inf
            widths.append((upper - lower) / upper)
    assert np.quantile(widths, 0.97) < 1e-10
    assert max(widths) < 1e-7


@pytest.mark.parametrize(("contacts", "count"), [(4, 15), (7, 6)])
def test_bounds_of_more_contacts_are_narrow_once_sharpened(contacts: int, count: int) -> None:
    widths = []
    for points, normals, load in scenes(count, contacts, seed=contacts):
        status, lower, upper = hold(load, points, normals)
        if status != fk.FOUND or upper == 0.0:
            continue
        _, least, most = wedge(points, normals)[:3]
        bounds = sharpened(FrictionBounds(lower, upper), FrictionBounds(least, most), load, points, normals)
        theirs = witness.hold_friction(points, normals, Wrench.of(load[3:], load[:3]), 1.0)
        assert bounds.lower <= bounds.upper <= upper
        assert agree((fk.FOUND, bounds.lower, bounds.upper), theirs, 1e-10)
        widths.append((bounds.upper - bounds.lower) / upper)
    assert np.median(widths) < 1e-8
    # What is only approached, by ever larger forces as the contacts begin to wedge.
    assert max(widths) < 1e-6


def test_forces_balance_and_lie_in_their_cones() -> None:
    for points, normals, load in scenes(100, 3, seed=9):
        _, _, upper = hold(load, points, normals)
        forces = np.zeros(9)
        needed = fk.least_forces(load, 1.2 * upper, points, normals, forces)
        found = forces.reshape(3, 3)
        assert needed <= 1.2 * upper * (1.0 + 1e-7)
        assert np.abs(found.sum(axis=0) + load[3:]).max() < 1e-9 * max(1.0, np.abs(found).max())
        assert np.abs(np.cross(points, found).sum(axis=0) + load[:3]).max() < 1e-9 * max(1.0, np.abs(found).max())


def test_neither_order_nor_point_nor_size_of_the_load_matters() -> None:
    rng = np.random.default_rng(3)
    for points, normals, load in scenes(60, 3, seed=11):
        given = hold(load, points, normals)[2]
        order = rng.permutation(3)
        shift = rng.normal(size=3)
        moved = np.array([*(load[:3] - np.cross(shift, load[3:])), *load[3:]])
        for again in (
            hold(load, points[order], normals[order]),
            hold(1e3 * load, points, normals),
            hold(moved, points - shift, normals),
        ):
            assert math.atan(again[2]) == pytest.approx(math.atan(given), abs=1e-6)


def test_mirrored_contacts_need_the_mirrored_loads_friction() -> None:
    mirror = np.array([1.0, -1.0, 1.0])
    for points, normals, load in scenes(60, 3, seed=13):
        other = load * np.array([-1.0, 1.0, -1.0, 1.0, -1.0, 1.0])
        assert hold(other, points * mirror, normals * mirror)[2] == pytest.approx(
            hold(load, points, normals)[2], rel=1e-6
        )
        assert wedge(points * mirror, normals * mirror)[2] == pytest.approx(wedge(points, normals)[2], rel=1e-9)


@pytest.mark.parametrize("across", [0.02, 0.103, 0.3])
def test_a_patch_holds_a_load_near_its_rim_by_the_friction_that_its_slope_asks_for(across: float) -> None:
    """The push acts within the hull, but outside of that of the few points that are tried first."""
    pair = quarter_twenty_unc()
    radius = pair.nominal_diameter / 2.0
    load = Load(force=(across, 0.0, -1.0), moment=(0.0, -0.8024 * radius, 0.0))
    hold = statics_of(pair, solve_pose(pair, 4.0, 0.0, 185.0), load).hold
    assert hold.lower <= across * (1.0 + 1e-12)
    assert hold.upper >= across * (1.0 - 1e-12)
    assert hold.upper - hold.lower < 1e-7


@pytest.mark.parametrize(("pose", "above"), [((-2.0, 0.0, 151.0), 1e-9), ((2.0, 2.0, 359.0), 1e-6)])
def test_forces_are_found_close_above_the_least_friction(pose: tuple[float, float, float], above: float) -> None:
    """Cones leave next to no room there; those of the second pose need forces without limit."""
    pair = quarter_twenty_unc()
    state = solve_pose(pair, *pose)
    mu = statics_of(pair, state).hold.upper * (1.0 + above)
    statics = statics_of(pair, state, mu=mu)
    contacts = touching(pair, state)
    forces = np.array([force.tangential for force in statics.forces])
    normal = np.array([force.normal for force in statics.forces])
    at = [force.contact - 1 for force in statics.forces]
    whole = forces + normal[:, np.newaxis] * np.array(contacts.normals)[at]
    arms = np.array(contacts.points)[at] - np.array(contacts.origin)
    assert normal.min() > 0.0
    assert (np.linalg.norm(forces, axis=1) <= mu * normal).all()
    assert np.abs(whole.sum(axis=0) - [0.0, 0.0, 1.0]).max() < 1e-11 * normal.sum()
    assert np.abs(np.cross(arms, whole).sum(axis=0)).max() < 1e-11 * normal.sum()


@pytest.mark.parametrize("pose", [(-2.0, 0.0, 151.0), (2.0, 2.0, 359.0)])
def test_forces_that_were_not_found_are_none(pose: tuple[float, float, float]) -> None:
    """At the least friction itself the load is held, but what holds it is known to no more digits than a double's."""
    pair = quarter_twenty_unc()
    state = solve_pose(pair, *pose)
    statics = statics_of(pair, state, mu=statics_of(pair, state).hold.upper)
    assert statics.verdict in (Verdict.CAN_STAY, Verdict.CAN_WEDGE)
    assert statics.forces == ()
