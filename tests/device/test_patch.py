"""The convex hull of the patch of a flush bolt beside dense samples of both outlines, and where a bolt tips off it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.profile import LEAD, bolt_profile, nut_profile, radius
from threadstate.device import _chart_kernel as ck
from threadstate.device.command import commanded_rotation
from threadstate.device.flush import patch_hull, triangle_about
from threadstate.device.model import About, Outcome, SettledFlag
from threadstate.device.settle import settle_pose, settle_poses
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

UNC = quarter_twenty_unc()
R = UNC.nominal_diameter / 2.0
DENSE = 20_000


def radii(azimuths: Floats, profile: Floats) -> Floats:
    """The radii of an outline at azimuths."""
    return np.array([radius(-profile[LEAD] * theta / (2.0 * math.pi), profile) for theta in azimuths])


def dense_patch(phase: float, shift: Floats) -> Floats:
    """Dense samples of both outlines that lie in the patch of a level bolt turned by ``phase`` and shifted."""
    bolt, nut = bolt_profile(UNC), nut_profile(UNC)
    theta = np.linspace(-math.pi, math.pi, DENSE, endpoint=False)
    spokes = np.column_stack([np.cos(theta), np.sin(theta)])
    turned = np.column_stack([np.cos(theta + phase), np.sin(theta + phase)])
    on_bolt = radii(theta, bolt)[:, None] * turned + shift
    on_nut = radii(theta, nut)[:, None] * spokes
    outside = np.linalg.norm(on_bolt, axis=1) > radii(np.arctan2(on_bolt[:, 1], on_bolt[:, 0]), nut)
    from_bolt = on_nut - shift
    inside = np.linalg.norm(from_bolt, axis=1) < radii(np.arctan2(from_bolt[:, 1], from_bolt[:, 0]) - phase, bolt)
    return np.vstack([on_bolt[outside], on_nut[inside]])


def test_the_hulls_nearest_side_is_a_tangent_of_the_patch() -> None:
    """No sample lies beyond it, and it touches where samples end: at corners, or on an arc of the bolt's outline."""
    rng = np.random.default_rng(31)
    for phase in np.radians([20.0, 90.0, 130.0, 180.0, 271.0, 340.0]):
        shift = rng.uniform(-0.02, 0.02, 2) * R
        place = np.zeros(ck.PLACE_SIZE)
        place[:9] = commanded_rotation(0.0, 0.0, math.degrees(phase), About.NUT)
        place[9:11] = shift
        samples = dense_patch(phase, shift)
        for _ in range(4):
            x, y = rng.uniform(-0.9, 0.9, 2) * R
            _, hull, margin, side = patch_hull(UNC, place, x, y)
            first, last = hull[side], hull[(side + 1) % len(hull)]
            normal = np.array([last[1] - first[1], first[0] - last[0]]) / np.linalg.norm(last - first)
            assert margin == pytest.approx(normal @ (first - [x, y]), abs=1e-14 * R)
            beyond = normal @ (samples - first).T
            assert beyond.max() < 1e-14 * R
            assert beyond.max() > -2.0 * math.pi / DENSE * R
            for corner in (first, last):
                assert np.abs(samples - corner).sum(axis=1).min() < 4.0 * math.pi / DENSE * R


def test_bolts_that_roll_off_their_patch_as_the_push_grows_settle() -> None:
    """The centre of pressure leaves the patch between samples of its outlines, or enters it there."""
    poses = [(0.0, 1.0, 40.0), (0.0, 1.0, 170.0), (1.0, -2.0, 130.0), (1.0, -1.0, 100.0), (3.0, 1.0, 10.0)]
    states = settle_poses(UNC, poses)
    assert [state.outcome for state in states] == [Outcome.SETTLED] * len(poses)
    assert all(margin is not None for margin in (state.margins.residual for state in states))


def test_corners_that_are_as_good_as_one_make_no_side_of_a_hull() -> None:
    """At roll -0.896, pitch 2.318, phase 59.546 some are 1e-8 apart: three of them had no barycentric coordinates."""
    state = settle_pose(UNC, -0.8964154742030619, 2.3184243519860885, 59.546165956946275)
    assert (state.outcome, state.flags) == (Outcome.SETTLED, (SettledFlag.FLUSH,))
    hull = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.0, 1.0]])
    corners, shares = triangle_about(hull, 0.25, 0.25)
    assert shares @ corners == pytest.approx([0.25, 0.25])
    assert shares.min() > 0.0
