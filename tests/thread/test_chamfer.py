"""A chamfer of the bolt's base: what is valid, how pairs name it, and that pairs without one are as they were."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from threadstate.errors import ImpossibleThreadError, InvalidValueError
from threadstate.library.identity import canonical_json, pair_of
from threadstate.thread.catalogue import is_known, pair_by_designation, quarter_twenty_unc, source_of
from threadstate.thread.chamfer import Chamfer
from threadstate.units import LengthUnit
from worker.pairs.selection import chosen_pair

UNC = quarter_twenty_unc()
CHAMFERED = replace(UNC, designation="chamfered", chamfer=Chamfer(0.18))

WITHOUT = (
    '{"designation":"1/4-20 UNC","fit":{"bolt_major_diameter":0.2489,"bolt_minor_diameter":0.1894,'
    '"bolt_pitch_diameter":0.2164,"name":"2A/2B","nut_major_diameter":0.25,"nut_minor_diameter":0.196,'
    '"nut_pitch_diameter":0.2175},"form":{"bolt_crest_fillet":0.054,"bolt_root_fillet":0.108,'
    '"flank_half_angle_deg":30.0,"name":"UN","nut_crest_fillet":0.108,"nut_root_fillet":0.054},"hand":"right",'
    '"nominal_diameter":0.25,"starts":1.0,"thread_pitch":0.05,"unit":"in"}'
)
"""The document of the default pair before there were chamfers."""


def test_the_document_of_a_pair_without_a_chamfer_does_not_name_it() -> None:
    assert json.loads(canonical_json(UNC)).keys() == json.loads(WITHOUT).keys()
    assert canonical_json(UNC) == WITHOUT
    assert pair_of(WITHOUT) == UNC


def test_the_document_of_a_chamfered_pair_gives_it_back() -> None:
    text = canonical_json(CHAMFERED)
    assert json.loads(text)["chamfer"] == {"angle_deg": 45.0, "end_diameter": 0.18}
    assert pair_of(text) == CHAMFERED


def test_the_cone_begins_at_the_end_diameter_and_grows_by_its_angle() -> None:
    steep = Chamfer(0.2, 60.0)
    assert steep.radius(0.0) == 0.1
    assert steep.radius(0.05) == pytest.approx(0.1 + 0.05 / math.sqrt(3.0), rel=1e-15)
    assert steep.radius(steep.height(0.25)) == pytest.approx(0.125, rel=1e-15)
    assert steep.height(0.2) == steep.height(0.15) == 0.0


@pytest.mark.parametrize("end", [0.0, -1.0, math.nan, math.inf])
def test_end_diameters_are_lengths(end: float) -> None:
    with pytest.raises(ImpossibleThreadError, match=r"end_diameter is .*; valid: a finite length > 0"):
        Chamfer(end)


@pytest.mark.parametrize("angle", [14.9, 75.1, math.nan])
def test_angles_are_those_of_chamfers(angle: float) -> None:
    with pytest.raises(ImpossibleThreadError, match=r"angle_deg is .*; valid: 15 to 75 deg"):
        Chamfer(0.2, angle)


def test_an_end_is_no_narrower_than_the_bore_of_meshes() -> None:
    with pytest.raises(ImpossibleThreadError, match=r"end_diameter is 0\.11; valid: at least 0\.1136"):
        replace(UNC, chamfer=Chamfer(0.11))


def test_units_scale_the_end_diameter() -> None:
    metric = CHAMFERED.in_unit(LengthUnit.MILLIMETRE)
    assert metric.chamfer == Chamfer(0.18 * 25.4)
    assert UNC.in_unit(LengthUnit.MILLIMETRE).chamfer is None


@pytest.mark.parametrize(
    ("written", "named"),
    [
        ("m6 with chamfer", "M6x1-6g/6H with chamfer"),
        ("M6x1-6g/6H, chamfer at minimum", "M6x1-6g/6H with chamfer at minimum material"),
        ("1/4-20 UNC with chamfer", "1/4-20 UNC-2A/2B with chamfer"),
        ("Tr 8x1.5 with sharp corners with chamfer", "Tr 8x1.5-7e/7H with sharp corners with chamfer"),
        ("1/4-16 ACME-2G LH with chamfer at 0.25/0.75", "1/4-16 ACME-2G LH with chamfer at 0.25/0.75"),
    ],
)
def test_designations_take_a_chamfer(written: str, named: str) -> None:
    pair = pair_by_designation(written)
    assert pair.designation == named
    assert is_known(named)
    assert pair.chamfer == Chamfer(pair.fit.bolt_minor_diameter - 0.1 * pair.thread_pitch, 45.0)
    flat = pair_by_designation(named.replace(" with chamfer", ""))
    assert (flat.fit, flat.form, flat.chamfer) == (pair.fit, pair.form, None)
    assert source_of(pair) == f"{source_of(flat)}; the chamfer a choice here"


def test_files_take_a_chamfer(tmp_path: Path) -> None:
    file = tmp_path / "pair.toml"
    file.write_text('designation = "own"\nlike = "1/4-20 UNC"\n[chamfer]\nend_diameter = 0.18\n')
    assert chosen_pair(str(file)) == replace(CHAMFERED, designation="own")
    file.write_text('designation = "own"\nlike = "M6 with chamfer"\n[chamfer]\nangle_deg = 30\n')
    default = pair_by_designation("M6 with chamfer").chamfer
    assert default is not None
    assert chosen_pair(str(file)).chamfer == replace(default, angle_deg=30.0)
    file.write_text('designation = "own"\nlike = "M6 with chamfer"\n')
    assert chosen_pair(str(file)).chamfer == default


def test_dimensions_take_a_chamfer() -> None:
    given = ["like=1/4-20 UNC", "chamfer.end_diameter=0.18", "chamfer.angle_deg=45"]
    assert chosen_pair("own", given) == replace(CHAMFERED, designation="own")


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("angle_deg = 45", r"chamfer\.end_diameter is None; valid: a value, or as `like` a pair that has a chamfer"),
        ("end_diameter = -1", r"chamfer\.end_diameter is -1\.0; valid: a finite length > 0"),
        ("end_diameter = 0.1", r"chamfer\.end_diameter is 0\.1; valid: at least 0\.1136"),
        ("end_diameter = 0.18\nangle_deg = 80", r"chamfer\.angle_deg is 80\.0; valid: 15 to 75 deg"),
        ("end = 0.18", r"chamfer\.end is 0\.18; valid: one of the keys end_diameter, angle_deg"),
    ],
)
def test_a_bad_chamfer_of_a_file_is_named(tmp_path: Path, table: str, message: str) -> None:
    file = tmp_path / "pair.toml"
    file.write_text(f'designation = "own"\nlike = "1/4-20 UNC"\n[chamfer]\n{table}\n')
    with pytest.raises(InvalidValueError, match=message):
        chosen_pair(str(file))
