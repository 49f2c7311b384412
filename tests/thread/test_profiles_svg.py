"""The picture of a pair's profiles: what is drawn is the profiles, and the numbers are the play between them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import asdict, replace
from xml.etree import ElementTree

import numpy as np
import pytest

from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc
from threadstate.thread.fit import Fit
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.thread.play import axial_play, play_of
from threadstate.thread.profile import Profile
from threadstate.thread.profiles_svg import LEFT, PITCH_PX, START, profiles_svg
from threadstate.units import LengthUnit

SVG = "{http://www.w3.org/2000/svg}"
ROUNDED_PX = 0.02
"""Of what a hundredth of a pixel in each of an arc's numbers leaves."""
DESIGNATIONS = ("1/4-20 UNC", "M6 at minimum material", "1/4-16 ACME-2G", "1/4-20 BSW", "Tr 8x1.5 at middle")


def picture(*pairs: Pair, unit: LengthUnit | None = None) -> ElementTree.Element:
    text = profiles_svg(pairs, unit)
    assert "nan" not in text
    return ElementTree.fromstring(text)


def texts(root: ElementTree.Element) -> list[str]:
    return [element.text or "" for element in root.iter(f"{SVG}text")]


def drawn(root: ElementTree.Element, part: str) -> list[tuple[float, float]]:
    """Places along the drawn outline of a part, in pixels, with some on every arc."""
    (path,) = (path for path in root.iter(f"{SVG}path") if path.get("class") == f"{part}-edge")
    places: list[tuple[float, float]] = []
    for kind, numbers in re.findall(r"([MLA])([^MLA]+)", path.get("d") or ""):
        values = [float(number) for number in numbers.split()]
        end = values[-2], values[-1]
        if kind == "A":
            places += arc(places[-1], end, values[0], sweep=values[4] == 1.0)
        places.append(end)
    return places


def arc(
    start: tuple[float, float], end: tuple[float, float], radius: float, *, sweep: bool
) -> Iterator[tuple[float, float]]:
    """Places on the smaller arc of an SVG path between two others."""
    a, b = np.array(start), np.array(end)
    half = (b - a) / 2.0
    if not radius or not half.any():
        return
    across = np.array([-half[1], half[0]]) / np.linalg.norm(half) * (1.0 if sweep else -1.0)
    centre = a + half + across * np.sqrt(max(radius**2 - half @ half, 0.0))
    for share in np.linspace(0.0, 1.0, 7):
        out = a + 2.0 * share * half - centre
        x, y = centre + out / np.linalg.norm(out) * radius
        yield float(x), float(y)


@pytest.mark.parametrize("designation", DESIGNATIONS)
def test_outlines_are_the_profiles_with_their_true_fillets(designation: str) -> None:
    pair = pair_by_designation(designation)
    root, p = picture(pair), pair.thread_pitch
    offsets = []
    for part, profile in (("bolt", pair.bolt), ("nut", pair.nut)):
        places = drawn(root, part)
        assert len(places) > 40
        # Radii are measured from where the outline's lowest place, the minor radius, is drawn.
        bottom = max(y for _, y in places)
        offsets.append(bottom + profile.minor_diameter / 2.0 / p * PITCH_PX)
        for x, y in places:
            s = ((x - LEFT) / PITCH_PX + START) * p
            slope = abs(profile.derivatives(s)[1])
            radius = profile.minor_diameter / 2.0 + (bottom - y) / PITCH_PX * p
            assert abs(radius - profile.radius(s)) / p * PITCH_PX < ROUNDED_PX * (1.0 + slope), (part, s)
    assert offsets[0] == pytest.approx(offsets[1], abs=ROUNDED_PX), "bolt and nut have one axis"


def test_diameters_and_plays_are_labelled_with_the_units_asked_for() -> None:
    pair = quarter_twenty_unc()
    assert {
        "major ⌀ 0.2489",
        "pitch ⌀ 0.2164",
        "minor ⌀ 0.1894",
        "major ⌀ 0.25",
        "pitch ⌀ 0.2175",
        "minor ⌀ 0.196",
    } <= set(texts(picture(pair)))
    shown = texts(picture(pair, unit=LengthUnit.MILLIMETRE))
    # (0.25 - 0.2489) / 2, (0.196 - 0.1894) / 2, and tan 30 deg of half of 0.2175 - 0.2164, in mm.
    assert {"0.014 mm (1.1 % of p)", "0.0838 mm (6.6 % of p)", "±0.0081 mm", "thread pitch p = 1.27 mm"} <= set(shown)
    assert shown[0] == "1/4-20 UNC"
    assert any("ASME B1.1" in text for text in shown)


def test_the_play_drawn_is_the_narrowest_gap_of_the_outlines() -> None:
    """Between the flanks that fall to the right, at the height of the two arrows that point along the axis."""
    pair = pair_by_designation("M6 at minimum material")
    play = play_of(pair)
    assert play.axial == axial_play(pair)
    assert play.radius is not None

    def gap(radius: float) -> float:
        falling = [0.5 * pair.thread_pitch - profile.inverse(radius) for profile in (pair.bolt, pair.nut)]
        return falling[1] - falling[0]

    assert gap(play.radius) == play.axial
    common = np.linspace(pair.nut.minor_diameter / 2.0, pair.bolt.major_diameter / 2.0, 2001)
    assert min(gap(float(radius)) for radius in common) == pytest.approx(play.axial, rel=1e-4)


def test_pairs_below_each_other_have_one_scale_of_thread_pitches() -> None:
    pairs = [pair_by_designation("1/4-20 UNC-3A/3B"), replace(pair_by_designation("M3"), hand=Hand.LEFT, starts=2)]
    root = picture(*pairs)
    arrows = [text for text in texts(root) if text.startswith("thread pitch")]
    assert arrows == ["thread pitch p = 0.05 in", "thread pitch p = 0.5 mm"]
    assert any("of a left-hand thread of 2 starts" in text for text in texts(root))
    outlines = [path.get("d") or "" for path in root.iter(f"{SVG}path") if path.get("class") == "bolt-edge"]
    assert len({(re.findall(r"[\d.]+", d)[0], re.findall(r"[\d.]+", d)[-2]) for d in outlines}) == 1
    assert float(root.get("height") or 0) > 2 * float(picture(pairs[0]).get("height") or 0) * 0.9


def fitted(designation: str = "a pair", **diameters: float) -> Pair:
    """M6, with other diameters, as a pair of one's own."""
    pair = pair_by_designation("M6")
    return replace(pair, designation=designation, fit=Fit(**{**asdict(pair.fit), **diameters}))


def test_a_bolt_thinner_than_the_nuts_hole_has_no_axial_play() -> None:
    pair = fitted(nut_minor_diameter=5.99, nut_pitch_diameter=6.3, nut_major_diameter=6.61)
    play = play_of(pair)
    assert (play.axial, play.radius) == (None, None)
    assert play.root == pytest.approx((5.99 - pair.fit.bolt_minor_diameter) / 2.0)
    assert not any("axial play" in text for text in texts(picture(pair))[3:])


def test_solids_that_overlap_in_phase_are_said_to() -> None:
    """A sharp root of the nut leaves no room for the bolt's large fillet at equal diameters."""
    pair = quarter_twenty_unc()
    pair = replace(pair, designation="sharp", fit=replace(pair.fit, nut_minor_diameter=pair.fit.bolt_minor_diameter))
    pair = replace(pair, form=replace(pair.form, nut_crest_fillet=0.0))
    assert axial_play(pair) < 0.0
    shown = texts(picture(pair))
    at = shown.index("no axial play:")
    assert shown[at + 1] == "overlap"
    assert float(shown[at + 2].removesuffix(" in")) == pytest.approx(-axial_play(pair), abs=1e-5)


def test_names_are_escaped_and_cut_where_they_are_too_long() -> None:
    pair = fitted("<a> & " + 94 * "x")
    root = picture(pair)
    (title,) = root.iter(f"{SVG}title")
    assert title.text is not None
    assert title.text.endswith(pair.designation)
    assert texts(root)[0].startswith("<a> & xxx")
    assert len(texts(root)[0]) == 80


def test_profile_without_fillets_is_drawn_of_straight_lines() -> None:
    pair = quarter_twenty_unc()
    sharp = replace(pair.form, bolt_root_fillet=0.0, bolt_crest_fillet=0.0, nut_root_fillet=0.0, nut_crest_fillet=0.0)
    places = drawn(picture(replace(pair, designation="sharp", form=sharp)), "bolt")
    corners = list(dict.fromkeys(places))
    profile: Profile = pair.bolt
    assert len(corners) == 8
    assert {round(y - corners[1][1], 1) for _, y in corners[1:-1]} == {
        0.0,
        round(-(profile.major_diameter - profile.minor_diameter) / 2.0 / pair.thread_pitch * PITCH_PX, 1),
    }
