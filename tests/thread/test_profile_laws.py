"""Laws of a profile, over threads of many shapes: method, sections 1 and 3."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.thread.shapes import PROFILES
from threadstate.errors import InvalidValueError
from threadstate.thread.profile import Profile

POSITIONS = st.floats(-3.0, 3.0)
"""In thread pitches."""
RELATIVE = 1e-12
"""Of a length relative to the thread pitch or the major diameter: round-off."""


def round_off(profile: Profile) -> float:
    return RELATIVE * max(profile.thread_pitch, profile.major_diameter)


@given(profile=PROFILES, at=POSITIONS)
def test_radius_has_the_period_of_the_thread_and_stays_between_the_diameters(profile: Profile, at: float) -> None:
    s = at * profile.thread_pitch
    assert profile.radius(s + profile.thread_pitch) == pytest.approx(profile.radius(s), abs=1e4 * round_off(profile))
    assert profile.minor_diameter / 2 - round_off(profile) <= profile.radius(s)
    assert profile.radius(s) <= profile.major_diameter / 2 + round_off(profile)


@given(profile=PROFILES, at=POSITIONS)
def test_the_mirror_image_has_the_other_flank_s_angles(profile: Profile, at: float) -> None:
    """About ridge and groove, which are its own mirror images where both flanks have one angle."""
    p, negative = profile.thread_pitch, profile.flank_half_angle_neg_deg
    mirrored = profile
    if negative is not None:
        mirrored = replace(
            profile, flank_half_angle_deg=negative, flank_half_angle_neg_deg=profile.flank_half_angle_deg
        )
    s = at * p
    assert mirrored.radius(p / 2 - s) == pytest.approx(profile.radius(s), abs=1e4 * round_off(profile))


@given(profile=PROFILES)
def test_the_datum_is_where_the_pitch_radius_is_met(profile: Profile) -> None:
    """Half a thread pitch apart; ridge and groove are at the quarters where both flanks have one angle."""
    p = profile.thread_pitch
    for s in (0.0, p / 2):
        assert profile.radius(s) == pytest.approx(profile.pitch_diameter / 2, abs=1e3 * round_off(profile))
    root, crest = profile.ends
    assert profile.radius(crest) == profile.major_diameter / 2
    assert profile.radius(root + p) == profile.minor_diameter / 2
    if profile.flank_half_angle_neg_deg is None:
        assert (root, crest) == (-p / 4, p / 4)
    halves = profile.boundaries, profile.falling_boundaries
    assert crest - halves[0][3] == pytest.approx((p / 2 - halves[1][3]) - crest, abs=round_off(profile))


@given(profile=PROFILES, share=st.floats(0.0, 1.0))
def test_inverse_undoes_radius_on_both_halves(profile: Profile, share: float) -> None:
    low, high = profile.minor_diameter / 2, profile.major_diameter / 2
    p, (root, crest) = profile.thread_pitch, profile.ends
    r = min(max(low + share * (high - low), low), high)
    s, u = profile.inverse(r), profile.falling_inverse(r)
    assert root - 1e-9 * p <= s <= crest + 1e-9 * p
    assert crest - 1e-9 * p <= p / 2 - u <= root + (1 + 1e-9) * p
    assert profile.radius(s) == pytest.approx(r, abs=10 * round_off(profile))
    assert profile.radius(p / 2 - u) == pytest.approx(r, abs=1e4 * round_off(profile))


@given(profile=PROFILES, shares=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)))
def test_inverse_grows_with_the_radius(profile: Profile, shares: tuple[float, float]) -> None:
    low, high = profile.minor_diameter / 2, profile.major_diameter / 2
    first, second = (min(low + share * (high - low), high) for share in sorted(shares))
    assert profile.inverse(first) <= profile.inverse(second) + round_off(profile)


@given(profile=PROFILES, at=st.floats(-0.5, 0.5))
def test_derivatives_are_those_of_the_radius(profile: Profile, at: float) -> None:
    p = profile.thread_pitch
    s, step = at * p, 1e-6 * p
    marks = [*profile.boundaries, *(p / 2 - u for u in profile.falling_boundaries)]
    if any(abs(math.remainder(s - mark, p)) < 1e-3 * p for mark in marks):
        return
    r, d1, d2 = profile.derivatives(s)
    assert r == profile.radius(s)
    difference = (profile.radius(s + step) - profile.radius(s - step)) / (2 * step)
    assert d1 == pytest.approx(difference, rel=1e-4, abs=1e-6)
    slopes = (profile.derivatives(s + step)[1] - profile.derivatives(s - step)[1]) / (2 * step)
    assert d2 * p == pytest.approx(slopes * p, rel=1e-3, abs=1e-6)


@given(profile=PROFILES, at=POSITIONS)
def test_the_slope_never_passes_that_of_the_flank(profile: Profile, at: float) -> None:
    steepest = 1.0 / math.tan(min(profile.half_angles))
    assert abs(profile.derivatives(at * profile.thread_pitch)[1]) <= steepest * (1.0 + 1e-6)


@given(profile=PROFILES)
def test_fillets_are_tangent_to_flat_and_flank(profile: Profile) -> None:
    p = profile.thread_pitch
    for falling, boundaries in enumerate((profile.boundaries, profile.falling_boundaries)):
        steepest = 1.0 / math.tan(profile.half_angles[falling])
        for u, slope in zip(boundaries, (0.0, steepest, steepest, 0.0), strict=True):
            for side in (-1e-9, 1e-9):
                s = u + side * p
                found = -profile.derivatives(p / 2 - s)[1] if falling else profile.derivatives(s)[1]
                assert found == pytest.approx(slope, abs=2e-3 * steepest)


@given(profile=PROFILES, at=POSITIONS)
def test_regions_follow_each_other_with_the_slope_s_sign(profile: Profile, at: float) -> None:
    index, margin = profile.region_index(at * profile.thread_pitch)
    _, d1, d2 = profile.derivatives(at * profile.thread_pitch)
    assert 0 <= index <= 7
    assert margin >= -round_off(profile)
    if margin > 1e-6 * profile.thread_pitch:
        assert (index in (0, 4)) == (d1 == 0.0)
        assert (index in (1, 2, 3)) == (d1 > 0.0)
        assert (index in (5, 6, 7)) == (d1 < 0.0)
        assert (index in (1, 7)) == (d2 > 0.0)
        assert (index in (3, 5)) == (d2 < 0.0)


@given(profile=PROFILES, at=st.floats(-0.5, 0.5))
def test_a_margin_is_the_arc_length_to_the_nearest_boundary(profile: Profile, at: float) -> None:
    p = profile.thread_pitch
    s = at * p
    _, margin = profile.region_index(s)
    marks = [
        mark + turn * p
        for mark in (*profile.boundaries, *(p / 2 - u for u in profile.falling_boundaries))
        for turn in (-1, 0, 1)
    ]
    nearest = min(arc_length(profile, *sorted((s, mark))) for mark in marks)
    assert margin == pytest.approx(nearest, abs=1e-5 * p)


def arc_length(profile: Profile, low: float, high: float) -> float:
    """By 2000 chords."""
    count = 2000
    step = (high - low) / count
    radii = [profile.radius(low + i * step) for i in range(count + 1)]
    return sum(math.hypot(step, b - a) for a, b in pairwise(radii))


@given(profile=PROFILES, beyond=st.floats(1e-9, 1.0))
def test_a_radius_outside_the_profile_has_no_inverse(profile: Profile, beyond: float) -> None:
    low, high = profile.minor_diameter / 2, profile.major_diameter / 2
    for r in (low * (1 - beyond), high * (1 + beyond), math.nan):
        with pytest.raises(InvalidValueError, match="radius") as error:
            profile.inverse(r)
        assert repr(r) in str(error.value)
        assert repr(low) in error.value.valid
        assert repr(high) in error.value.valid


@pytest.mark.parametrize("s", [math.nan, math.inf, -math.inf])
def test_positions_must_be_finite(s: float) -> None:
    profile = Profile(0.05, 0.19, 0.2164, 0.2489, 30.0, 0.0, 0.0)
    for function in (profile.radius, profile.derivatives, profile.region_index):
        with pytest.raises(InvalidValueError, match="finite"):
            function(s)
