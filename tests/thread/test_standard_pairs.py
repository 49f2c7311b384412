"""Pairs of standard threads: each fits, and their diameters are where the position says."""

from __future__ import annotations

from dataclasses import replace

import pytest

from threadstate.errors import InvalidValueError
from threadstate.thread.catalogue import pair_by_designation, source_of
from threadstate.thread.play import axial_limits, axial_play
from threadstate.thread.standards.designation import standard_thread, standard_threads
from threadstate.thread.standards.pairs import Position, pair_at, parsed_position, standard_pair
from threadstate.thread.standards.sizes import (
    ACME_SOURCE,
    BUTTRESS_SOURCE,
    MJ_SOURCE,
    OF_ONE_START,
    UNIFIED_SOURCE,
    UNJ_SOURCE,
    WHITWORTH_SOURCE,
    WIDER_OF_SEVERAL,
)


@pytest.mark.parametrize("position", [Position(0.0, 0.0), Position(1.0, 1.0)], ids=["maximum", "minimum"])
def test_every_bolt_of_the_catalogue_goes_into_its_nut(position: Position) -> None:
    """Roots and crests too: a fillet that is larger than that of the other part beside it would leave no play."""
    for thread in standard_threads():
        assert min(axial_limits(pair_at(thread, position))) >= -1e-12 * thread.thread_pitch, thread.designation


@pytest.mark.parametrize("designation", ["1/4-20 UNC-3A/3B", "M6-4h/4H", "1/4-20 BSW-close/close"])
def test_tightest_fits_have_no_play_at_maximum_material_and_some_at_minimum(designation: str) -> None:
    assert axial_play(standard_pair(designation)) == pytest.approx(0.0, abs=1e-12)
    loose = standard_pair(f"{designation} at minimum material")
    assert axial_play(loose) > 0.02 * loose.thread_pitch


def test_diameters_are_at_the_fractions_of_their_tolerances() -> None:
    thread = standard_thread("1/4-16 ACME-2G")
    fit = pair_at(thread, Position(0.25, 0.75)).fit
    for name, diameter in (("major", thread.bolt.major), ("pitch", thread.bolt.pitch), ("minor", thread.bolt.minor)):
        assert diameter.least is not None
        assert diameter.greatest is not None
        expected = 0.75 * diameter.greatest + 0.25 * diameter.least
        assert getattr(fit, f"bolt_{name}_diameter") == pytest.approx(expected, abs=1e-15)
    for name, diameter in (("major", thread.nut.major), ("pitch", thread.nut.pitch), ("minor", thread.nut.minor)):
        assert diameter.least is not None
        assert diameter.greatest is not None
        expected = 0.25 * diameter.least + 0.75 * diameter.greatest
        assert getattr(fit, f"nut_{name}_diameter") == pytest.approx(expected, abs=1e-15)


def test_a_metric_root_is_full_between_the_two_radii_of_the_standard() -> None:
    pitch = 1.0
    for position, radius in (("maximum", 0.144338), ("minimum", 0.125)):
        pair = standard_pair(f"M6 at {position}")
        assert pair.form.bolt_root_fillet == pytest.approx(radius, abs=2e-4)
        assert pair.bolt.boundaries[0] == pytest.approx(-pitch / 4.0, abs=1e-12)


@pytest.mark.parametrize("designation", ["1/4-28 UNJF", "MJ6", "MJ20x1.5"])
def test_a_controlled_root_is_an_arc_from_the_greatest_to_the_least_radius(designation: str) -> None:
    for position, radius in (("maximum", 0.18042), ("minimum", 0.15011)):
        pair = standard_pair(f"{designation} at {position}")
        rounding_of_diameters = 1e-4 if pair.thread_pitch < 0.1 else 1e-3
        assert pair.form.bolt_root_fillet == pytest.approx(radius, abs=2.0 * rounding_of_diameters / pair.thread_pitch)
        assert pair.bolt.boundaries[0] == pytest.approx(-pair.thread_pitch / 4.0, abs=1e-12)


def test_where_no_limit_was_found_the_known_one_stands_at_every_position() -> None:
    tight, loose = (standard_pair(f"1/4-28 UNJF at {position}").fit for position in ("maximum", "minimum"))
    assert tight.nut_minor_diameter == loose.nut_minor_diameter == 0.2152
    assert tight.nut_pitch_diameter < loose.nut_pitch_diameter


def test_a_screw_that_is_pulled_bears_on_the_flank_that_faces_its_head() -> None:
    pull, push = (standard_pair(f"1/2-16 {symbol} LH at middle").form for symbol in ("BUTT", "PUSH-BUTT"))
    assert (pull.flank_half_angle_deg, pull.flank_half_angle_neg_deg) == (45.0, 7.0)
    assert (push.flank_half_angle_deg, push.flank_half_angle_neg_deg) == (7.0, 45.0)
    assert replace(pull, name="", flank_half_angle_deg=7.0, flank_half_angle_neg_deg=45.0) == replace(push, name="")


@pytest.mark.parametrize(("position", "radius"), [("maximum", 0.0714), ("minimum", 0.0357)])
def test_a_buttress_root_is_an_arc_within_the_radii_of_the_standard(position: str, radius: float) -> None:
    form = standard_pair(f"1/2-16 BUTT at {position}").form
    assert form.bolt_root_fillet == pytest.approx(radius, abs=1e-3)
    assert form.nut_root_fillet == pytest.approx(radius, abs=1e-3)


def test_whitworth_is_round_and_its_radius_that_of_the_standard() -> None:
    form = standard_pair("1/4-20 BSW-close/close").form
    assert form.flank_half_angle_deg == 27.5
    assert {form.bolt_root_fillet, form.bolt_crest_fillet, form.nut_root_fillet, form.nut_crest_fillet} == {0.137329}


@pytest.mark.parametrize("text", ["maximum", "Middle", "minimum material", "0.25/1", "0/0.125"])
def test_the_name_of_a_position_means_it(text: str) -> None:
    position = parsed_position(text)
    assert standard_pair(f"M6{position.name}") == pair_at(standard_thread("M6"), position)


@pytest.mark.parametrize(
    ("designation", "source"),
    [
        ("1/4-20 UNC", UNIFIED_SOURCE),
        ("1/4-20 UNC-3A/3B LH at 0.25/0.5", UNIFIED_SOURCE),
        ("1/4-20 UNC newer root", f"{UNIFIED_SOURCE}; the bolt's minor diameter from newer editions"),
        ("1/4-16 acme at middle", ACME_SOURCE),
        ("1/4-20 BSW", WHITWORTH_SOURCE),
        ("1/4-28 UNJF at minimum material", UNJ_SOURCE),
        ("MJ6 at middle", MJ_SOURCE),
        ("1/2-16 BUTT-3A", BUTTRESS_SOURCE),
        ("1/2-16 PUSH-BUTT with sharp crests", BUTTRESS_SOURCE),
    ],
)
def test_a_pair_rests_on_its_standard_while_every_number_is_the_standards(designation: str, source: str) -> None:
    pair = pair_by_designation(designation)
    assert source_of(pair) == source
    fit = replace(pair.fit, nut_minor_diameter=pair.fit.nut_minor_diameter * (1.0 + 1e-12))
    assert source_of(replace(pair, fit=fit)) is None
    assert source_of(replace(pair, designation="a thread of one's own")) is None


@pytest.mark.parametrize(
    ("written", "designation", "starts"),
    [
        ("M6xPh2P1", "M6x1-6g/6H 2 starts", 2),
        ("m6 x ph3p1 - 6h/6H lh", "M6x1-6h/6H LH 3 starts", 3),
        ("MJ6xPh2P1", "MJ6x1-4h6h/4H5H 2 starts", 2),
        ("1/2-16 BUTT-2A 3 starts", "1/2-16 BUTT-2A/2B 3 starts", 3),
        ("Tr 8x3(P1.5)", "Tr 8x1.5-7e/7H 2 starts", 2),
        ("tr8x3 P1.5-8c/8H at middle", "Tr 8x1.5-8c/8H 2 starts at middle", 2),
        ("1/4-16 ACME-2G 2 starts", "1/4-16 ACME-2G 2 starts", 2),
        ("1/4-16 acme, 4-start", "1/4-16 ACME-2G 4 starts", 4),
        ("M6 1 start", "M6x1-6g/6H", 1),
    ],
)
def test_several_starts_are_written_as_a_number_or_as_lead_and_pitch(
    written: str, designation: str, starts: int
) -> None:
    pair = pair_by_designation(written)
    assert (pair.designation, pair.starts) == (designation, starts)
    assert abs(pair.lead) == starts * pair.thread_pitch
    assert pair_by_designation(pair.designation) == pair
    of_several = WIDER_OF_SEVERAL if pair.form.name == "Tr" else OF_ONE_START
    assert str(source_of(pair)).endswith(of_several) == (starts > 1)


@pytest.mark.parametrize(
    ("designation", "valid"),
    [
        ("M6 0 starts", "starts is 0; valid: 1 to 4"),
        ("M6 5 starts", "starts is 5; valid: 1 to 4"),
        ("M6xPh2.5P1", r"lead is '2\.5'; valid: a whole number of pitches"),
        ("M6xPh2P1 2 starts", "lead is '2'"),
        ("Tr 8x3(P0)", "lead is '3'"),
        ("1/4-20 BSW with sharp corners", "none of Whitworth threads, which are round"),
    ],
)
def test_starts_and_corners_that_no_thread_has_are_refused(designation: str, valid: str) -> None:
    with pytest.raises(InvalidValueError, match=valid):
        pair_by_designation(designation)


def test_sharp_corners_are_a_named_choice_of_roots_and_crests() -> None:
    rounded = pair_by_designation("1/4-16 ACME-2G at minimum material")
    crests = pair_by_designation("1/4-16 acme with sharp crests at minimum material")
    sharp = pair_by_designation("1/4-16 ACME-2G, sharp corners at minimum material")
    assert crests.designation == "1/4-16 ACME-2G with sharp crests at minimum material"
    assert sharp.designation == "1/4-16 ACME-2G with sharp corners at minimum material"
    names = ("bolt_crest_fillet", "nut_crest_fillet", "bolt_root_fillet", "nut_root_fillet")
    of = {pair: [getattr(pair.form, name) for name in names] for pair in (rounded, crests, sharp)}
    assert of[crests] == [0.0, 0.0, *of[rounded][2:]]
    assert of[sharp] == [0.0] * 4
    assert crests.fit == sharp.fit == rounded.fit
    assert {source_of(pair) for pair in (rounded, crests, sharp)} == {ACME_SOURCE}
    assert [pair_by_designation(pair.designation) for pair in (crests, sharp)] == [crests, sharp]
