"""Impossible threads get an error that names the value and the limit."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from threadstate.errors import ImpossibleThreadError, InvalidValueError
from threadstate.thread.catalogue import RootForm, is_known, pair_by_designation, quarter_twenty_unc
from threadstate.thread.pair import Pair

PAIR = quarter_twenty_unc()
BAD_LENGTHS = [0.0, -0.1, math.nan, math.inf]


def assert_names(error: pytest.ExceptionInfo[ImpossibleThreadError], name: str, value: float) -> None:
    """The message holds the name, the value and the limit."""
    assert error.value.name == name
    assert repr(value) in str(error.value)
    assert error.value.valid in str(error.value)


@pytest.mark.parametrize("name", ["nominal_diameter", "thread_pitch"])
@pytest.mark.parametrize("value", BAD_LENGTHS)
def test_lengths_of_a_pair_are_positive(name: str, value: float) -> None:
    with pytest.raises(ImpossibleThreadError, match="a finite length > 0") as error:
        replace(PAIR, **{name: value})  # type: ignore[arg-type]
    assert_names(error, name, value)


@pytest.mark.parametrize("part", ["bolt", "nut"])
@pytest.mark.parametrize("which", ["major", "pitch", "minor"])
@pytest.mark.parametrize("value", BAD_LENGTHS)
def test_diameters_are_positive(part: str, which: str, value: float) -> None:
    name = f"{part}_{which}_diameter"
    with pytest.raises(ImpossibleThreadError, match="a finite length > 0") as error:
        replace(PAIR.fit, **{name: value})  # type: ignore[arg-type]
    assert_names(error, name, value)


@pytest.mark.parametrize("which", ["major", "pitch", "minor"])
def test_a_bolt_larger_than_the_nut_is_refused(which: str) -> None:
    limit = getattr(PAIR.fit, f"nut_{which}_diameter")
    value = math.nextafter(limit, 1.0)
    with pytest.raises(ImpossibleThreadError) as error:
        replace(PAIR.fit, **{f"bolt_{which}_diameter": value})  # type: ignore[arg-type]
    assert_names(error, f"bolt_{which}_diameter", value)
    assert repr(limit) in error.value.valid


@pytest.mark.parametrize("value", [0.0, 90.0, -30.0, 120.0, math.nan])
def test_flanks_lean(value: float) -> None:
    with pytest.raises(ImpossibleThreadError, match="0 < angle < 90 deg") as error:
        replace(PAIR.form, flank_half_angle_deg=value)
    assert_names(error, "flank_half_angle_deg", value)


@pytest.mark.parametrize("name", ["bolt_root_fillet", "bolt_crest_fillet", "nut_root_fillet", "nut_crest_fillet"])
@pytest.mark.parametrize("value", [-1e-9, math.nan, math.inf])
def test_fillets_are_no_less_than_sharp(name: str, value: float) -> None:
    with pytest.raises(ImpossibleThreadError, match="a finite ratio >= 0") as error:
        replace(PAIR.form, **{name: value})  # type: ignore[arg-type]
    assert_names(error, name, value)


@pytest.mark.parametrize(
    ("fillet", "name"),
    [
        ("bolt_root_fillet", "minor_fillet_radius"),
        ("bolt_crest_fillet", "major_fillet_radius"),
        ("nut_crest_fillet", "minor_fillet_radius"),
        ("nut_root_fillet", "major_fillet_radius"),
    ],
)
def test_a_fillet_that_does_not_fit_names_the_largest_that_does(fillet: str, name: str) -> None:
    with pytest.raises(ImpossibleThreadError, match="at most") as error:
        replace(PAIR, form=replace(PAIR.form, **{fillet: 0.5}))  # type: ignore[arg-type]
    assert_names(error, name, 0.5 * PAIR.thread_pitch)
    largest = float(error.value.valid.split()[2])
    assert largest < 0.5 * PAIR.thread_pitch
    fitting = replace(PAIR.form, **{fillet: largest / PAIR.thread_pitch * (1.0 - 1e-9)})  # type: ignore[arg-type]
    assert isinstance(replace(PAIR, form=fitting), Pair)
    beyond = replace(PAIR.form, **{fillet: largest / PAIR.thread_pitch * (1.0 + 1e-6)})  # type: ignore[arg-type]
    with pytest.raises(ImpossibleThreadError):
        replace(PAIR, form=beyond)


def test_fillets_that_leave_no_flank_are_refused() -> None:
    bolt = PAIR.bolt
    with pytest.raises(ImpossibleThreadError, match="leave a flank between them") as error:
        replace(bolt, minor_diameter=bolt.pitch_diameter - 0.002, major_diameter=bolt.pitch_diameter + 0.002)
    assert_names(error, "minor_fillet_radius", bolt.minor_fillet_radius)


@pytest.mark.parametrize(("minor", "pitch", "major"), [(0.22, 0.21, 0.24), (0.19, 0.25, 0.24), (0.2, 0.2, 0.24)])
def test_diameters_of_a_part_are_in_order(minor: float, pitch: float, major: float) -> None:
    with pytest.raises(ImpossibleThreadError) as error:
        replace(PAIR.bolt, minor_diameter=minor, pitch_diameter=pitch, major_diameter=major)
    assert_names(error, "pitch_diameter", pitch)
    assert repr(minor) in error.value.valid
    assert repr(major) in error.value.valid


@pytest.mark.parametrize("root_form", RootForm)
def test_root_forms_differ_in_the_bolt_s_minor_diameter_alone(root_form: RootForm) -> None:
    pair = quarter_twenty_unc(root_form)
    assert pair.fit.bolt_minor_diameter == {RootForm.CLASSIC: 0.1894, RootForm.NEWER: 0.1876}[root_form]
    assert replace(pair, designation="", fit=replace(pair.fit, bolt_minor_diameter=0.1894)) == replace(
        PAIR, designation=""
    )


@pytest.mark.parametrize(
    ("written", "meant"),
    [
        ("1/4-20 UNC", "1/4-20 UNC"),
        ("  1/4-20   unc ", "1/4-20 UNC"),
        ("1/4-20 UNC-2A/2B", "1/4-20 UNC"),
        ("1/4-20 unc-2a at maximum", "1/4-20 UNC"),
        ("1/4-20 UNC Newer Root", "1/4-20 UNC newer root"),
        ("1/4-20 UNC-3A", "1/4-20 UNC-3A/3B"),
        ("1/4-20 UNC at minimum", "1/4-20 UNC-2A/2B at minimum material"),
        ("m6", "M6x1-6g/6H"),
        ("M6 - 6G at MIDDLE", "M6x1-6g/6G at middle"),
        ("M6 at 0/0.25", "M6x1-6g/6H at 0/0.25"),
        ("M6 at 0.5/0.5", "M6x1-6g/6H at middle"),
    ],
)
def test_a_designation_finds_its_pair_however_it_is_written(written: str, meant: str) -> None:
    assert pair_by_designation(written).designation == meant
    assert pair_by_designation(meant) == pair_by_designation(written)
    assert is_known(meant)


def test_the_default_pair_is_that_of_its_classes() -> None:
    assert pair_by_designation("1/4-20 UNC-2A/2B") == PAIR
    assert not is_known("1/4-20 UNC-2A/2B")
    assert not is_known("M6")


@pytest.mark.parametrize(
    ("written", "value", "valid"),
    [
        ("M7", "'M7'", "M6x1-6g/6H"),
        ("M7", "'M7'", "1/4-20 UNC newer root"),
        ("M6-7z", "'7z'", "a bolt's"),
        ("1/4-16 ACME-5G", "'5G'", "2G, 3G, 4G"),
        ("1/2-10 STUB ACME-3G", "'3G'", "2G of Stub Acme"),
        ("M6 at 1.5/0", "1.5", "maximum material"),
        ("M6 at nan/0", "'nan/0'", "0.25/0.75"),
        ("M6 at", "'M6 at'", "M6x1-6g/6H"),
        ("M6 at least", "'least'", "minimum material"),
    ],
)
def test_what_names_no_pair_says_what_does(written: str, value: str, valid: str) -> None:
    with pytest.raises(InvalidValueError) as error:
        pair_by_designation(written)
    assert value in str(error.value)
    assert valid in error.value.valid
