"""Laws of a profile, over threads of many shapes: method, sections 1 and 3."""

from __future__ import annotations

import math
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


@given(profile=PROFILES, at=st.floats(0.0, 0.5))
def test_radius_is_symmetric_about_ridge_and_groove(profile: Profile, at: float) -> None:
    p = profile.thread_pitch
    for centre in (p / 4, 3 * p / 4):
        assert profile.radius(centre + at * p) == pytest.approx(
            profile.radius(centre - at * p), abs=1e4 * round_off(profile)
        )


@given(profile=PROFILES)
def test_the_datum_is_at_the_quarters(profile: Profile) -> None:
    p = profile.thread_pitch
    assert profile.radius(p / 4) == profile.major_diameter / 2
    assert profile.radius(3 * p / 4) == profile.minor_diameter / 2


@given(profile=PROFILES, share=st.floats(0.0, 1.0))
def test_inverse_undoes_radius_on_the_rising_half(profile: Profile, share: float) -> None:
    low, high = profile.minor_diameter / 2, profile.major_diameter / 2
    r = min(max(low + share * (high - low), low), high)
    s = profile.inverse(r)
    assert -profile.thread_pitch / 4 * (1 + 1e-9) <= s <= profile.thread_pitch / 4 * (1 + 1e-9)
    assert profile.radius(s) == pytest.approx(r, abs=10 * round_off(profile))
    assert profile.radius(profile.thread_pitch / 2 - s) == pytest.approx(r, abs=1e4 * round_off(profile))


@given(profile=PROFILES, shares=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)))
def test_inverse_grows_with_the_radius(profile: Profile, shares: tuple[float, float]) -> None:
    low, high = profile.minor_diameter / 2, profile.major_diameter / 2
    first, second = (min(low + share * (high - low), high) for share in sorted(shares))
    assert profile.inverse(first) <= profile.inverse(second) + round_off(profile)


@given(profile=PROFILES, at=st.floats(-0.249, 0.249))
def test_derivatives_are_those_of_the_radius(profile: Profile, at: float) -> None:
    p = profile.thread_pitch
    s, step = at * p, 1e-6 * p
    if any(abs(s - mark) < 1e-3 * p for mark in profile.boundaries):
        return
    r, d1, d2 = profile.derivatives(s)
    assert r == profile.radius(s)
    difference = (profile.radius(s + step) - profile.radius(s - step)) / (2 * step)
    assert d1 == pytest.approx(difference, rel=1e-4, abs=1e-6)
    slopes = (profile.derivatives(s + step)[1] - profile.derivatives(s - step)[1]) / (2 * step)
    assert d2 * p == pytest.approx(slopes * p, rel=1e-3, abs=1e-6)


@given(profile=PROFILES, at=POSITIONS)
def test_the_slope_never_passes_that_of_the_flank(profile: Profile, at: float) -> None:
    steepest = 1.0 / math.tan(math.radians(profile.flank_half_angle_deg))
    assert abs(profile.derivatives(at * profile.thread_pitch)[1]) <= steepest * (1.0 + 1e-6)


@given(profile=PROFILES)
def test_fillets_are_tangent_to_flat_and_flank(profile: Profile) -> None:
    steepest = 1.0 / math.tan(math.radians(profile.flank_half_angle_deg))
    flat, flank, crest, top = profile.boundaries
    for s, slope in ((flat, 0.0), (flank, steepest), (crest, steepest), (top, 0.0)):
        for side in (-1e-9, 1e-9):
            found = profile.derivatives(s + side * profile.thread_pitch)[1]
            assert found == pytest.approx(slope, abs=1e-3 * steepest)


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


@given(profile=PROFILES, at=st.floats(-0.25, 0.25))
def test_a_margin_is_the_arc_length_to_the_nearest_boundary(profile: Profile, at: float) -> None:
    p = profile.thread_pitch
    s = at * p
    _, margin = profile.region_index(s)
    marks = (-p / 2 - profile.boundaries[0], *profile.boundaries, p / 2 - profile.boundaries[3])
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
