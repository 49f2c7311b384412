"""One's own thread on the command line: by a file, by dimensions, by a setting."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from tests.worker.conftest import CommandLine
from threadstate.errors import InvalidValueError
from threadstate.settings import DATABASE, DATABASE_PASSWORD_FILE, KEY, NAMES, PAIR, PORT, SERVICE
from threadstate.state.solve import solve_pose
from threadstate.thread.catalogue import RootForm, pair_by_designation, quarter_twenty_unc
from threadstate.thread.hand import Hand
from threadstate.thread.pair import Pair
from threadstate.units import LengthUnit
from worker.pairs.selection import chosen_pair, pair_of_file

pytestmark = pytest.mark.sqlite_alone

EXAMPLE = "examples/m6x1.toml"
LIKE = "like=1/4-20 UNC"
POSE = ("--roll", "2.5", "--pitch", "-1.2", "--phase", "357")

LOOSE = """
designation = "loose"
like = "1/4-20 UNC"
[fit]
name = "loose"
nut_pitch_diameter = 0.219
"""


@pytest.fixture
def example(repository_root: Path) -> Pair:
    return pair_of_file(repository_root / EXAMPLE)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "own.toml"
    path.write_text(LOOSE)
    return path


def test_the_example_is_m6x1_at_maximum_material(example: Pair) -> None:
    assert (example.designation, example.unit) == ("M6x1", LengthUnit.MILLIMETRE)
    d, p, es, fit = example.nominal_diameter, example.thread_pitch, 0.026, example.fit
    height = 0.5 * math.sqrt(3.0) * p
    assert fit.bolt_major_diameter == pytest.approx(d - es, abs=5e-4)
    assert fit.bolt_pitch_diameter == pytest.approx(d - 0.75 * height - es, abs=6e-4)
    assert fit.bolt_minor_diameter == pytest.approx(fit.bolt_pitch_diameter - 2.0 / 3.0 * height, abs=6e-4)
    assert fit.nut_major_diameter == d
    assert fit.nut_pitch_diameter == pytest.approx(d - 0.75 * height, abs=6e-4)
    assert fit.nut_minor_diameter == pytest.approx(d - 1.25 * height, abs=6e-4)
    assert example.form.flank_half_angle_deg == 30.0


def test_the_example_is_solved(command_line: CommandLine, repository_root: Path, example: Pair) -> None:
    path = str(repository_root / EXAMPLE)
    code, out, _ = command_line.here("solve", *POSE, "--pair", path, "--json")
    state = json.loads(out)
    assert (code, state["unit"]) == (0, "mm")
    assert state["drop"] == solve_pose(example, 2.5, -1.2, 357.0).drop
    assert "x (mm)" in command_line.here("solve", *POSE, "--pair", path)[1]
    in_inches = json.loads(command_line.here("solve", *POSE, "--pair", path, "--unit", "in", "--json")[1])
    assert in_inches["drop"] == pytest.approx(state["drop"] / 25.4, rel=1e-15)


def test_a_library_of_a_file_is_found_by_its_slug(command_line: CommandLine, repository_root: Path) -> None:
    arguments = ("--tilt-max", "0", "--phase-step", "90", "--workers", "1", "--json")
    made = json.loads(command_line.out("rebuild", "--pair", str(repository_root / EXAMPLE), *arguments))
    summary = json.loads(command_line.here("summary", "--library", "m6x1", "--json")[1])
    assert (summary["library"], summary["pair"], summary["unit"]) == (made["library"], "M6x1", "mm")
    code, out, err = command_line.here("heights", "--roll", "3", "--pitch", "1", "--library", "m6x1", "--json")
    assert (code, json.loads(out)["unit"]) == (0, "mm")
    assert err == (
        "computed: roll 3 is not on the grid of library 1\ncomputed: pitch 1 is not on the grid of library 1\n"
    )


def test_a_file_may_be_a_sweep_of_one_pair(file: Path, tmp_path: Path) -> None:
    sweep = tmp_path / "sweep.toml"
    own = LOOSE.replace("[fit]", "[pair.fit]")
    sweep.write_text(f"[[pair]]\n{own}\n[[grid]]\ntilt_max = 0\n")
    assert pair_of_file(sweep) == pair_of_file(file)


def test_dimensions_make_the_pair_of_a_file(file: Path) -> None:
    dimensions = [LIKE, "fit.name=loose", "fit.nut_pitch_diameter=0.219"]
    assert chosen_pair("loose", dimensions) == pair_of_file(file)


def test_dimensions_alone_make_a_pair(example: Pair) -> None:
    fields = {"unit": "mm", "nominal_diameter": 6, "thread_pitch": 1}
    dimensions = [f"{key}={value}" for key, value in fields.items()]
    for table, part in (("form", example.form), ("fit", example.fit)):
        dimensions += [f"{table}.{key}={value}" for key, value in vars(part).items() if value is not None]
    assert chosen_pair("M6x1", dimensions) == example
    of_two_angles = chosen_pair("M6x1", [*dimensions, "form.flank_half_angle_neg_deg=20"])
    assert of_two_angles.form == replace(example.form, flank_half_angle_neg_deg=20.0)
    with pytest.raises(InvalidValueError, match=r"flank_half_angle_neg_deg is 30\.0; valid: another angle, or none"):
        chosen_pair("M6x1", [*dimensions, "form.flank_half_angle_neg_deg=30"])


def test_a_known_pair_is_made_left_hand_and_of_two_starts() -> None:
    pair = chosen_pair("M6 of two starts", ["like=M6", "starts=2", "hand=left"])
    known = pair_by_designation("M6")
    assert pair == replace(known, designation="M6 of two starts", starts=2, hand=Hand.LEFT)
    assert pair.lead == -2.0 * known.thread_pitch


def test_without_a_pair_it_is_that_of_the_setting(
    command_line: CommandLine, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert chosen_pair(None) == quarter_twenty_unc()
    monkeypatch.setenv(PAIR, str(file))
    assert chosen_pair(None) == pair_of_file(file)
    assert chosen_pair("1/4-20 UNC newer root") == quarter_twenty_unc(RootForm.NEWER)
    by_setting = command_line.here("solve", *POSE, "--json")
    assert by_setting == command_line.here("solve", *POSE, "--pair", str(file), "--json")
    assert by_setting != command_line.here("solve", *POSE, "--pair", "1/4-20 UNC", "--json")


@pytest.mark.parametrize(
    ("text", "name", "value", "valid"),
    [
        ("", "designation", "None", "a value"),
        (LOOSE.replace("[fit]", "[fits]"), "fits", "{", "a valid list"),
        (LOOSE.replace("nut_pitch", "nutpitch"), "fit.nutpitch_diameter", "0.219", "one of the keys name, bolt_major"),
        (LOOSE.replace("0.219", "'0.219'"), "fit.nut_pitch_diameter", "'0.219'", "a valid number"),
        (LOOSE.replace("0.219", "0.2"), "fit.bolt_pitch_diameter", "0.2164", "at most the nut's, 0.2"),
        (LOOSE.replace('"loose"', '"1/4-20 UNC"', 1), "designation", "'1/4-20 UNC'", "one's own"),
        (LOOSE.replace('like = "1/4-20 UNC"', ""), "form.name", "None", "a known pair as `like`"),
        (LOOSE.replace('like = "1/4-20 UNC"', 'like = "M51"'), "like", "'M51'", "1/4-20 UNC"),
        (LOOSE.replace("[fit]", "[[fits]]") + "[[fits]]\nname = 'b'\n", "fits", "'2 fits'", "one fit alone, as `fit`"),
        ("[[pair]]\ndesignation = 'a'\n[[pair]]\ndesignation = 'b'", "pair", "'2 pairs'", "one pair alone"),
        ("[[pair]]\ndesignation = 'a'\nunit = 'm'", "pair[1].unit", "'m'", "'in' or 'mm'"),
    ],
)
def test_what_a_file_may_not_say_is_named_with_file_and_key(
    file: Path, text: str, name: str, value: str, valid: str
) -> None:
    file.write_text(text)
    with pytest.raises(InvalidValueError) as caught:
        chosen_pair(str(file))
    message = str(caught.value)
    assert message.startswith(f"{file}: {name} is {value}")
    assert valid in message


@pytest.mark.parametrize(
    ("name", "dimensions", "words"),
    [
        ("M7", [], "designation is 'M7'; valid: a standard thread, .* a file that ends in .toml"),
        ("no-such.toml", [], r"file is 'no-such\.toml'; valid: a file that can be read"),
        (None, [LIKE], "--pair is None; valid: with --dimension, a name"),
        ("own.toml", [LIKE], r"--pair is 'own\.toml'; valid: with --dimension, a name"),
        ("own", ["thread_pitch"], "--dimension is 'thread_pitch'; valid: KEY=VALUE"),
        ("own", [LIKE, "designation=b"], "--dimension is 'designation=b'; valid: one of the keys like, unit"),
        ("own", [LIKE, "fit=b"], "--dimension is 'fit=b'; valid: one of the keys"),
        ("own", [LIKE, "fit.a.b=1"], r"--dimension is 'fit\.a\.b=1'; valid: one of the keys .*fit\.nut_minor_diameter"),
        ("own", [LIKE, "lead=1"], "--dimension: lead is 1.0; valid: one of the keys designation, like"),
        ("own", [LIKE, "thread_pitch=x"], "--dimension: thread_pitch is 'x'; valid: a valid number"),
        ("own", [LIKE, "thread_pitch=nan"], "--dimension: thread_pitch is 'nan'; valid: a valid number"),
        ("own", [LIKE, LIKE], "--dimension: like is '1/4-20 UNC'; valid: each key once"),
        (
            "own",
            [LIKE, "fit.bolt_major_diameter=0.26"],
            r"--dimension: fit\.bolt_major_diameter is 0.26; valid: at most",
        ),
        ("own", [LIKE, "starts=0"], "--dimension: starts is 0; valid: a whole number, 1 to 4"),
        ("own", [LIKE, "starts=5"], "--dimension: starts is 5; valid: a whole number, 1 to 4"),
        ("own", [LIKE, "starts=1.5"], r"--dimension: starts is 1\.5; valid: a valid integer"),
        ("own", [LIKE, "hand=both"], "--dimension: hand is 'both'; valid: 'right' or 'left'"),
        ("own", ["unit=mm"], r"--dimension: form\.name is None; valid: a value"),
    ],
)
def test_what_cannot_be_a_pair_is_said(name: str | None, dimensions: list[str], words: str) -> None:
    with pytest.raises(InvalidValueError, match=words):
        chosen_pair(name, dimensions)


def test_a_setting_that_is_no_pair_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PAIR, "M7")
    with pytest.raises(InvalidValueError, match=f"{PAIR} is 'M7'; valid: a standard thread"):
        chosen_pair(None)


def _settings(command_line: CommandLine, *arguments: str) -> tuple[dict[str, tuple[Any, str]], dict[str, Any]]:
    code, out, err = command_line.here("settings", *arguments, "--json")
    assert (code, err) == (0, "")
    document = json.loads(out)
    return {one["name"]: (one["value"], one["source"]) for one in document["settings"]}, document["pair"]


def test_settings_shows_every_setting_and_where_it_comes_from(
    command_line: CommandLine, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv(PORT, raising=False)
    settings, pair = _settings(command_line)
    assert list(settings) == list(NAMES)
    assert settings[DATABASE] == (command_line.database, "environment")
    assert settings[PORT] == (8000, "default")
    monkeypatch.setenv(PORT, "8080")
    assert _settings(command_line)[0][PORT] == (8080, "environment")
    assert settings[PAIR] == ("1/4-20 UNC", "default")
    assert (pair["designation"], pair["fit"]["bolt_major_diameter"]) == ("1/4-20 UNC", 0.2489)
    lines = command_line.here("settings")[1].splitlines()
    assert [line.split()[0] for line in lines[1 : 1 + len(NAMES)]] == list(NAMES)
    assert "fit.bolt_major_diameter    0.2489" in lines


def test_settings_shows_the_pair_that_is_asked_for(command_line: CommandLine, file: Path, example: Pair) -> None:
    assert _settings(command_line, "--pair", str(file))[1]["fit"]["nut_pitch_diameter"] == 0.219
    shown = command_line.here("settings", "--pair", "own", "--dimension", LIKE, "--dimension", "unit=mm")[1]
    assert re.search(r"^unit +mm$", shown, re.M)
    assert example.designation not in shown


def test_settings_shows_no_secret(command_line: CommandLine, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "password").write_text("of-the-file")
    monkeypatch.setenv(DATABASE, "postgresql+psycopg://somebody:of-the-url@host.example/threads")
    monkeypatch.setenv(DATABASE_PASSWORD_FILE, str(tmp_path / "password"))
    monkeypatch.setenv(KEY, "of-the-client")
    monkeypatch.setenv(SERVICE, "http://somebody:of-the-service@host.example")
    for arguments in ((), ("--json",)):
        code, out, _ = command_line.here("settings", *arguments)
        assert code == 0
        assert "somebody:***@host.example/threads" in out
        assert not re.search("of-the-", out)


def test_profiles_of_ones_own_pair_are_printed_with_their_play(command_line: CommandLine, example: Pair) -> None:
    code, out, _ = command_line.here("profiles", "--pair", EXAMPLE, "--pair", "1/4-20 UNC", "--unit", "mm", "--json")
    assert code == 0
    own, known = json.loads(out)["profiles"]
    assert (own["designation"], own["source"], own["unit"], own["hand"]) == ("M6x1", None, "mm", "right")
    assert own["bolt"]["major_fillet_radius"] == example.form.bolt_crest_fillet * example.thread_pitch
    assert own["play"]["crest"] == pytest.approx((6.0 - example.fit.bolt_major_diameter) / 2.0)
    assert own["play"]["axial"] > 0.0
    assert "ASME B1.1" in known["source"]
    # Parallel flanks: tan 30 deg of half the difference of the pitch diameters.
    assert known["play"]["axial"] == pytest.approx(25.4 * math.tan(math.radians(30.0)) * 0.00055)
    code, out, _ = command_line.here("profiles", "--pair", EXAMPLE)
    assert code == 0
    assert f"axial play, either way           {own['play']['axial']:.5f}" in out
    assert "M6x1: dimensions of one's own" in out


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--pair", "a", "--pair", "b", "--dimension", LIKE), "with one --pair"),
        (("--plot", "profiles.png"), "a name that ends in .svg"),
    ],
)
def test_profiles_that_cannot_be_shown_are_refused(
    command_line: CommandLine, options: tuple[str, ...], message: str
) -> None:
    code, _, err = command_line.here("profiles", *options)
    assert code == 2
    assert message in err
