"""The bolt's thread on the nut's surface away from both edges: flanks flatter than the tilt."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import ndimage

from oracle.first_height import first_height
from oracle.lift import least_lift
from oracle.profile import bolt_profile, nut_profile, radius
from oracle.state_turns import Turn, turns_of
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import solve_poses_by_mesh
from threadstate.state.model import Contact, ContactState, FeaturePair
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair

pytestmark = pytest.mark.slow

LOOSE = pair_by_designation("1/4-16 ACME-2G at minimum material")
FLAT = replace(LOOSE, form=replace(LOOSE.form, flank_half_angle_deg=7.0))
Floats = NDArray[np.float64]


def tilted(count: int, seed: int) -> Floats:
    """Poses of every tilt for which states are defined, half of them near in phase."""
    choose = np.random.default_rng(seed)
    phases = choose.uniform(-180.0, 180.0, count)
    phases[::2] /= 9.0
    return np.column_stack([choose.uniform(-10.0, 10.0, (count, 2)), phases])


@pytest.fixture(scope="module")
def states() -> list[ContactState]:
    return solve_poses(FLAT, tilted(100, 7))


def on_surface(state: ContactState) -> list[Contact]:
    return [contact for contact in state.contacts if contact.features is FeaturePair.THREAD_SURFACE]


def test_flat_flanks_come_down_on_the_surface_where_the_brute_force_says(states: list[ContactState]) -> None:
    assert {1, 3} <= {contact.stage for state in states for contact in on_surface(state)}
    for state in states[:40]:
        found = first_height(FLAT, state.roll_deg, state.pitch_deg, state.phase_deg)
        assert state.poses[0].translation[2] == pytest.approx(found.height, abs=1e-9 * FLAT.thread_pitch)


def test_a_first_contact_on_the_surface_is_the_lowest_point_of_the_thread(states: list[ContactState]) -> None:
    for state in states:
        for contact in on_surface(state):
            assert contact.normal == (0.0, 0.0, 1.0)
            assert contact.point[2] == 0.0
            assert contact.nut_region.value == "surface"
            assert contact.bolt_region.value == "crest_fillet_pos"
            x, y, z = contact.point_bolt
            s = z - FLAT.lead * math.atan2(y, x) / math.tau
            assert math.hypot(x, y) == pytest.approx(radius(s, bolt_profile(FLAT)), abs=1e-12)
            if contact.stage == 1:
                found = first_height(FLAT, state.roll_deg, state.pitch_deg, state.phase_deg)
                assert found.features == "thread-surface"
                assert found.point == pytest.approx(contact.point, abs=1e-6)


def test_embedments_beyond_the_flanks_are_the_least_lift(states: list[ContactState]) -> None:
    embedded = [state for state in states if state.embedment]
    beyond = [state for state in embedded if state.poses[2].rotation[2][2] < math.cos(math.radians(7.0))]
    assert len(beyond) > 30
    for state in beyond:
        pose = state.poses[2]
        lift = least_lift(FLAT, np.array(pose.rotation), np.array(pose.translation))
        assert state.embedment == pytest.approx(lift, abs=1e-8 * FLAT.thread_pitch)


class Below:
    """Samples of the rising half of the bolt's thread, and which of them are under the nut's surface."""

    around, across = 1080, 300

    def __init__(self, pair: Pair) -> None:
        bolt, nut = bolt_profile(pair), nut_profile(pair)
        self._azimuths = np.linspace(-math.pi, math.pi, 20_000)
        self._rim = [radius(-pair.lead * azimuth / math.tau, nut) for azimuth in self._azimuths]
        s = pair.thread_pitch * np.linspace(-0.25, 0.25, self.across)
        z = pair.thread_pitch * np.linspace(0.0, 1.0, self.around)[:, None]
        theta = (z - s) * math.tau / pair.lead
        r = np.array([radius(one, bolt) for one in s])
        self._points = np.stack(np.broadcast_arrays(r * np.cos(theta), r * np.sin(theta), z), axis=-1)

    def parts(self, turn: Turn, turn_deg: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
        """The samples below the surface, and those of them over the nut."""
        rotation, translation = turn.pose_after(turn_deg)
        x, y, height = np.moveaxis(self._points @ rotation.T + translation, -1, 0)
        below = height < 0.0
        over = below & (np.hypot(x, y) > np.interp(np.arctan2(y, x), self._azimuths, self._rim))
        return below, over

    def _apart(self, turn: Turn, turn_deg: float, piece: NDArray[np.bool_]) -> bool:
        rotation, translation = turn.pose_after(turn_deg)
        there = self._points[piece] @ rotation.T + translation
        return bool(np.linalg.norm(there[:, None] - turn.known, axis=-1).min() > 0.1 * FLAT.thread_pitch)

    def comes_down(self, turn: Turn, instants_deg: Floats) -> bool:
        """Whether a piece of thread comes down on the surface: neither over a rim nor out of one that was below.

        Nearer than a tenth of the thread pitch to an earlier contact is not looked at: what grows there is thin.
        """
        below, _ = self.parts(turn, instants_deg[0])
        for after_deg in instants_deg[1:]:
            later, over = self.parts(turn, after_deg)
            around = ndimage.binary_dilation(below, iterations=3)
            pieces, count = ndimage.label(later)
            for piece in range(1, count + 1):
                mine = pieces == piece
                at_end = mine[0].any() or mine[-1].any() or mine[:, 0].any() or mine[:, -1].any()
                if not at_end and over[mine].all() and not (mine & around).any() and self._apart(turn, after_deg, mine):
                    return True
            below = later
        return False


def test_no_turn_passes_a_thread_that_comes_down(states: list[ContactState]) -> None:
    samples, ends = Below(FLAT), 0
    ending = [state for state in states if any(contact.stage > 1 for contact in on_surface(state))]
    for state in ending[:3] + states[:3]:
        for turn in turns_of(FLAT, state):
            if turn.turn_deg is None or any(found.features is FeaturePair.FLUSH for found in turn.found):
                continue
            size = abs(turn.turn_deg)
            looked_at = np.linspace(0.0, size, 3 + int(size / 0.5))
            assert not samples.comes_down(turn, looked_at[:-1]), turn
            if any(found.features is FeaturePair.THREAD_SURFACE for found in turn.found):
                assert samples.comes_down(turn, np.array([size - 1e-3, size + 0.05]))
                ends += 1
    assert ends > 0


def test_meshes_name_the_same_features(states: list[ContactState]) -> None:
    state = next(state for state in states if state.contacts[0].features is FeaturePair.THREAD_SURFACE)
    pose = (state.roll_deg, state.pitch_deg, state.phase_deg)
    options = MeshOptions(Preset.FINE.tessellation, checked=False)
    (found,) = solve_poses_by_mesh(FLAT, [pose], options)
    assert found.contacts[0].features is FeaturePair.THREAD_SURFACE
    assert found.poses[0].translation[2] == pytest.approx(state.poses[0].translation[2], abs=1e-3 * FLAT.thread_pitch)


def test_acme_at_its_loosest_is_embedded_as_deep_as_it_is() -> None:
    """Beyond 14.5 deg the thread is below the surface: without it the embedment was 0.03905 in."""
    state = solve_pose(LOOSE, -0.027678803992579937, 3.1377866721046246, -15.436045375684992)
    pose = state.poses[2]
    assert state.embedment == pytest.approx(
        least_lift(LOOSE, np.array(pose.rotation), np.array(pose.translation)), abs=1e-10
    )
    assert state.embedment == pytest.approx(0.0394179014, abs=1e-9)
