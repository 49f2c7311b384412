"""The default pair, and pairs with flanks of two angles, by their numbers: method, sections 1, 3 and 7."""

from __future__ import annotations

import math

import pytest

from oracle.profile import bolt_profile, nut_profile, radius
from oracle.region_rule import region_at
from tests.thread.shapes import BUTTRESS, TURNED_BUTTRESS
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_limits, axial_play
from threadstate.thread.regions import BOLT_REGIONS, NUT_REGIONS, Region

PRINTED_INCH = 0.6e-15
ROUND_OFF_INCH = 1e-15

PAIR = quarter_twenty_unc()
PAIRS = [*(quarter_twenty_unc(root_form) for root_form in RootForm), BUTTRESS, TURNED_BUTTRESS]


@pytest.mark.parametrize(
    ("part", "s", "expected"),
    [("bolt", 0.005, 0.116860254037844), ("bolt", 0.03, 0.099539745962156), ("nut", 0.03, 0.100165616729453)],
)
def test_radius_has_the_method_s_values(part: str, s: float, expected: float) -> None:
    profile = PAIR.bolt if part == "bolt" else PAIR.nut
    assert profile.radius(s) == pytest.approx(expected, abs=PRINTED_INCH)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_radius_is_that_of_the_construction(pair: Pair) -> None:
    for profile, oracle in ((pair.bolt, bolt_profile(pair)), (pair.nut, nut_profile(pair))):
        for i in range(2001):
            s = (i / 1000.0 - 1.0) * pair.thread_pitch
            assert profile.radius(s) == pytest.approx(radius(s, oracle), abs=10 * ROUND_OFF_INCH)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
@pytest.mark.parametrize("of_nut", [False, True])
def test_regions_and_margins_are_those_of_the_rule(pair: Pair, of_nut: bool) -> None:
    profile, names = (pair.nut, NUT_REGIONS) if of_nut else (pair.bolt, BOLT_REGIONS)
    for i in range(2000):
        s = (i + 0.5) / 1000.0 * pair.thread_pitch - pair.thread_pitch
        index, margin = profile.region_index(s)
        rule = region_at(pair, s, of_nut=of_nut)
        assert names[index] is rule.region
        assert margin == pytest.approx(rule.margin, abs=1e-12)


def test_the_ninth_region_is_the_flat_face() -> None:
    assert (BOLT_REGIONS[8], NUT_REGIONS[8]) == (Region.BASE, Region.SURFACE)
    assert len(set(BOLT_REGIONS)) == len(set(NUT_REGIONS)) == 9


def test_the_bolt_s_crest_is_its_largest_radius_and_the_nut_s_its_smallest() -> None:
    quarter = PAIR.thread_pitch / 4
    assert BOLT_REGIONS[PAIR.bolt.region_index(quarter)[0]] is Region.CREST
    assert NUT_REGIONS[PAIR.nut.region_index(quarter)[0]] is Region.ROOT
    assert NUT_REGIONS[PAIR.nut.region_index(3 * quarter)[0]] is Region.CREST


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_axial_play_is_that_of_the_flanks(pair: Pair) -> None:
    clearance = (pair.fit.nut_pitch_diameter - pair.fit.bolt_pitch_diameter) / 2
    down, up = (clearance * math.tan(half_angle) for half_angle in pair.bolt.half_angles)
    assert axial_limits(pair) == pytest.approx((down, up), abs=ROUND_OFF_INCH)
    assert axial_play(pair) == pytest.approx((down + up) / 2, abs=ROUND_OFF_INCH)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.designation)
def test_the_bolt_fits_the_nut_within_the_play_and_no_farther(pair: Pair) -> None:
    p, (down, up) = pair.thread_pitch, axial_limits(pair)

    def tightest(shift: float) -> float:
        return min(pair.nut.radius(i * p / 4000) - pair.bolt.radius(i * p / 4000 + shift) for i in range(4000))

    for farthest in (down, -up):
        assert tightest(farthest) >= -ROUND_OFF_INCH * 10
        assert tightest(1.01 * farthest) < -1e-7
