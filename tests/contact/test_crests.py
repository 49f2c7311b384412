"""Corners of crests and crossings of helices, found in loops without branches, beside one point at a time."""

from __future__ import annotations

import math

import numpy as np
import pytest

from threadstate.contact import _corner_kernel as corner
from threadstate.contact import _crest_crossing_kernel as crossing
from threadstate.contact._branchless_kernel import profile_numbers
from threadstate.contact._geometry_kernel import TWO_PI
from threadstate.contact._slope_kernel import placement_numbers
from threadstate.contact._stage_kernel import rotation
from threadstate.contact._tangency_kernel import (
    PLACEMENT_SIZE,
    TANGENCY_JET_SIZE,
    TJ_PHI,
    TJ_RATE,
    set_jet,
)
from threadstate.thread import _profile_kernel as pk
from threadstate.thread.catalogue import pair_by_designation

NAMES = ("1/4-20 UNC", "M6 LH", "Tr8x1.5")


def placed(tilt_deg: float, rng: np.random.Generator, pitch: float) -> np.ndarray:
    """The placement of a bolt that is tilted by up to so much and has its origin up to a pitch below the surface."""
    placement = np.zeros(PLACEMENT_SIZE)
    roll, lean = np.radians(rng.uniform(-tilt_deg, tilt_deg, 2))
    rotation(float(roll), float(lean), float(rng.uniform(0.0, TWO_PI)), placement)
    placement[9:12] = [*rng.uniform(-0.1 * pitch, 0.1 * pitch, 2).tolist(), -float(rng.uniform(0.0, pitch))]
    return placement


@pytest.mark.parametrize("name", NAMES)
def test_depths_of_all_samples_of_a_corner_are_those_of_one_at_a_time(name: str) -> None:
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    p, k = float(bolt[pk.P]), float(bolt[pk.LEAD]) / TWO_PI
    rng = np.random.default_rng(71)
    depths = np.empty(corner.CORNER_SAMPLES)
    for _ in range(10):
        placement = placed(20.0, rng, p)
        for of_nut, own, other in ((False, bolt, nut), (True, nut, bolt)):
            s = float(rng.uniform(0.0, p))
            numbers = placement_numbers(placement), profile_numbers(other)
            corner.set_depths(s, of_nut, pk.radius(s, own), p, k, *numbers, depths)
            for i in range(corner.CORNER_SAMPLES):
                single, _, _ = corner.depth_at_corner(corner.CORNER_STEP * i, s, of_nut, placement, bolt, nut)
                assert depths[i] == pytest.approx(single, abs=1e-13 * p)


@pytest.mark.parametrize("name", NAMES)
def test_the_deepest_place_of_a_corner_is_that_of_many_samples(name: str) -> None:
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    p, k = float(bolt[pk.P]), float(bolt[pk.LEAD]) / TWO_PI
    rng = np.random.default_rng(72)
    angles, step = np.linspace(0.0, TWO_PI, 4000, retstep=True)
    end = 1.01 * k * corner.CORNER_STEP
    seen = 0
    for _ in range(5):
        placement = placed(5.0, rng, p)
        depth, _, z = corner.deepest_corner_point(placement, bolt, nut)
        anywhere, within = -math.inf, -math.inf
        for of_nut, s in helices_of_crests(bolt, nut):
            for angle in angles:
                at = corner.depth_at_corner(angle, s, of_nut, placement, bolt, nut)[0]
                anywhere = max(anywhere, at)
                # Where a helix ends, at the base and a thread pitch above it, only samples are looked at.
                if end < (s + k * angle) % p < p - end:
                    within = max(within, at)
        if anywhere > 0.0:
            assert within <= depth <= anywhere + step * bolt[pk.R_MAJOR]
            assert 0.0 <= z <= p
            seen += 1
    assert seen > 0


def helices_of_crests(bolt: np.ndarray, nut: np.ndarray) -> list[tuple[bool, float]]:
    """Whether it is the nut's, and the axial position, of the middle of each crest's two fillets."""
    found = []
    for half in (0, pk.FALLING):
        inner = 0.5 * float(nut[pk.U_FLAT + half] + nut[pk.U_FLANK + half])
        outer = 0.5 * float(bolt[pk.U_CREST + half] + bolt[pk.U_TOP + half])
        for of_nut, u in ((True, inner), (False, outer)):
            found.append((of_nut, u if half == 0 else 0.5 * float(bolt[pk.P]) - u))
    return found


@pytest.mark.parametrize("name", NAMES)
def test_helices_cross_where_crossings_are_found(name: str) -> None:
    """A seed lies on a helix of the bolt and, up to the sag between two samples, on one of the nut."""
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    p, k = float(bolt[pk.P]), float(bolt[pk.LEAD]) / TWO_PI
    rng = np.random.default_rng(73)
    crests = np.zeros(crossing.CRESTS_ARRAY_SIZE)
    crossing.set_crests(bolt, crests)
    seeds = np.empty((crossing.MAX_SEEDS, 2))
    seen = 0
    for _ in range(10):
        placement = placed(40.0, rng, p)
        for theta, z in seeds[: crossing.crest_crossings(placement, p, 0.0, bolt, nut, crests, seeds)]:
            at_bolt = distances(z - k * theta, bolt, p, of_bolt=True)
            r = pk.radius(z - k * theta, bolt)
            x, y, height = placement[:9].reshape(3, 3) @ (r * math.cos(theta), r * math.sin(theta), z) + placement[9:12]
            at_nut = distances(height - k * math.atan2(y, x), nut, p, of_bolt=False)
            assert min(at_bolt) < 1e-9 * p
            assert min(at_nut) < 5e-3 * p
            assert min(at_bolt[:2] + at_nut[:2]) < 5e-3 * p
            seen += 1
    assert seen > 20


@pytest.mark.parametrize("name", NAMES)
def test_no_crossing_is_where_none_is_marked(name: str) -> None:
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    p, lead = float(bolt[pk.P]), float(nut[pk.LEAD])
    rng = np.random.default_rng(74)
    room = np.full(crossing.CRESTS_ARRAY_SIZE + 1, math.pi)
    crests, helices = room[:-1], np.empty((crossing.HELICES, 2))
    crossing.set_crests(bolt, crests)
    crossing.helices_of_nut(nut, helices)
    marked = unmarked = 0
    for _ in range(10):
        placement = placed(40.0, rng, p)
        crossing.set_heights(placement, crests)
        crossing.place_crests(0, crossing.CRESTS_SIZE, placement, nut, crests)
        crossing.mark_crossings(0, crossing.CRESTS_SIZE, p, helices, crests)
        height, z = (crests[start : start + crossing.CRESTS_SIZE] for start in (crossing.W_HEIGHT, crossing.W_Z))
        inside = (height > -1.1 * p) & (height < 0.1 * p)
        for first in range(0, crossing.CRESTS_SIZE, crossing.BLOCK):
            assert crossing.is_beyond(first, p, crests) == (not inside[first : first + crossing.BLOCK].any())
        for i in range(1, crossing.CRESTS_SIZE):
            if not (inside[i - 1] and inside[i]) or abs(z[i] - z[i - 1]) > 0.5 * p:
                assert crests[crossing.W_MAY_CROSS + i] == 0.0
                continue
            crosses = max(crossing.share_of_way(i, s, p, lead, crests) for s in helices[:, 0].tolist()) >= 0.0
            marked += crosses
            unmarked += crests[crossing.W_MAY_CROSS + i] == 0.0
            assert not crosses or crests[crossing.W_MAY_CROSS + i] != 0.0
    assert marked > 20
    assert unmarked > 20
    assert room[-1] == math.pi  # nothing is written beyond


@pytest.mark.parametrize("name", NAMES)
def test_crossings_that_are_left_out_are_far(name: str) -> None:
    pair = pair_by_designation(name)
    bolt, nut = pair.bolt.packed, pair.nut.packed
    p = float(bolt[pk.P])
    near, soon = 0.05 * p, 0.03
    rng = np.random.default_rng(75)
    crests, jet = np.zeros(crossing.CRESTS_ARRAY_SIZE), np.empty(TANGENCY_JET_SIZE)
    crossing.set_crests(bolt, crests)
    every, some = np.empty((2, crossing.MAX_SEEDS, 2))
    left_out = 0
    for _ in range(40):
        placement = placed(40.0, rng, p)
        axis = rng.normal(size=3)
        placement[12:15] = axis / np.linalg.norm(axis)
        placement[15:18] = -np.cross(placement[12:15], rng.uniform(-1.0, 1.0, 3) * 3.0 * p)
        count = crossing.crest_crossings(placement, math.inf, 0.0, bolt, nut, crests, every)
        kept = some[: crossing.crest_crossings(placement, near, soon, bolt, nut, crests, some)].tolist()
        assert all(seed in every[:count].tolist() for seed in kept)
        for seed in every[:count].tolist():
            if seed not in kept:
                set_jet(*seed, placement, bolt, nut, jet)
                assert abs(jet[TJ_PHI]) >= near + soon * abs(jet[TJ_RATE])
                left_out += 1
    assert left_out > 20


def distances(s: float, profile: np.ndarray, p: float, *, of_bolt: bool) -> list[float]:
    """How far an axial position is from each helix of a profile."""
    offsets = [s - crossing.helix(which, of_bolt, profile) for which in range(crossing.HELICES)]
    return [abs(offset - p * round(offset / p)) for offset in offsets]
