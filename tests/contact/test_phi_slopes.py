"""The slopes of phi over the bolt's thread: those of Newton's method by differences, the ridges' own by those."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.compiled import compiled
from threadstate.contact import _branchless_kernel as bk
from threadstate.contact import _slope_kernel as sk
from threadstate.contact import _tangency_kernel as tk
from threadstate.contact._geometry_kernel import MOTION_SIZE, TWO_PI
from threadstate.thread import _profile_kernel as pk
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.profile import Profile

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()
TAU = 0.3
STEP = 1e-6


def sharp(profile: Profile) -> Profile:
    """The same threads with corners instead of fillets."""
    return Profile(
        thread_pitch=profile.thread_pitch,
        minor_diameter=profile.minor_diameter,
        pitch_diameter=profile.pitch_diameter,
        major_diameter=profile.major_diameter,
        flank_half_angle_deg=profile.flank_half_angle_deg,
        minor_fillet_radius=0.0,
        major_fillet_radius=0.0,
    )


PROFILES = [(PAIR.bolt, PAIR.nut), (sharp(PAIR.bolt), sharp(PAIR.nut))]


def tilted_turn() -> Floats:
    """A motion: tilted, off the nut's axis, turning about an axis in space."""
    motion = np.zeros(MOTION_SIZE)
    c, s = math.cos(0.05), math.sin(0.05)
    motion[:9] = [1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c]
    motion[9:12] = [0.002, -0.001, -0.02]
    motion[12] = 1.0
    motion[13:16] = [0.1, -0.05, -0.01]
    motion[16:19] = [0.6, 0.64, 0.48]
    return motion


def jet(theta: float, z: float, tau: float, bolt: Profile, nut: Profile) -> Floats:
    placement, out = np.empty(tk.PLACEMENT_SIZE), np.empty(tk.TANGENCY_JET_SIZE)
    tk.set_placement(tilted_turn(), tau, placement)
    tk.set_jet(theta, z, placement, bolt.packed, nut.packed, out)
    return out


@compiled
def slopes_at(theta: float, z: float, placement: Floats, bolt: Floats, nut: Floats) -> tuple[float, float, float]:
    k = bolt[pk.LEAD] / TWO_PI
    r, slope, _, _ = bk.radius_and_slope(z - k * theta, bk.profile_numbers(bolt))
    c, s = math.cos(theta), math.sin(theta)
    placement_values = sk.placement_numbers(placement)
    return sk.slopes(r * c, r * s, z, slope * c, slope * s, k, placement_values, bk.profile_numbers(nut))


def places() -> list[tuple[float, float]]:
    rng = np.random.default_rng(41)
    return list(zip(rng.uniform(0.0, TWO_PI, 300), rng.uniform(0.0, PAIR.thread_pitch, 300), strict=True))


def test_derivatives_of_phi_are_those_of_its_differences() -> None:
    """Away from where two arcs of a profile meet: there second derivatives jump."""
    bolt, nut = PAIR.bolt, PAIR.nut
    k = PAIR.thread_pitch / TWO_PI
    smooth = 0
    for theta, z in places():
        here = jet(theta, z, TAU, bolt, nut)
        along = [jet(theta + d, z + k * d, TAU, bolt, nut) for d in (STEP, -STEP)]
        axial = [jet(theta, z + d, TAU, bolt, nut) for d in (STEP * k, -STEP * k)]
        later = [jet(theta, z, TAU + d, bolt, nut) for d in (STEP, -STEP)]
        by_u, by_z, by_tau = ((a - b) / (2.0 * d) for (a, b), d in ((along, STEP), (axial, STEP * k), (later, STEP)))
        assert [by_u[tk.TJ_PHI], by_z[tk.TJ_PHI], by_tau[tk.TJ_PHI]] == pytest.approx(
            here[[tk.TJ_A, tk.TJ_B, tk.TJ_RATE]], abs=3e-5
        )
        curvatures = [jet(theta + a, z + b, TAU, bolt, nut)[tk.TJ_ZZ] for a in (-1e-4, 1e-4) for b in (-1e-5, 1e-5)]
        if max(curvatures) - min(curvatures) > 0.02 * (1.0 + max(map(abs, curvatures))):
            continue
        smooth += 1
        scale = 1e-5 * (1.0 + abs(here[tk.TJ_ZZ]))
        assert [by_u[tk.TJ_A], by_u[tk.TJ_B], by_z[tk.TJ_B]] == pytest.approx(
            here[[tk.TJ_UU, tk.TJ_UZ, tk.TJ_ZZ]], rel=1e-5, abs=scale
        )
        assert [by_tau[tk.TJ_A], by_tau[tk.TJ_B]] == pytest.approx(here[[tk.TJ_UT, tk.TJ_ZT]], rel=1e-5, abs=scale)
    assert smooth > 150


@pytest.mark.parametrize(("bolt", "nut"), PROFILES, ids=["fillets", "corners"])
def test_slopes_without_branches_are_the_same(bolt: Profile, nut: Profile) -> None:
    placement = np.empty(tk.PLACEMENT_SIZE)
    tk.set_placement(tilted_turn(), TAU, placement)
    for theta, z in places():
        exact = jet(theta, z, TAU, bolt, nut)
        assert slopes_at(theta, z, placement, bolt.packed, nut.packed) == pytest.approx(
            (exact[tk.TJ_PHI], exact[tk.TJ_A], exact[tk.TJ_B]), abs=1e-8
        )
