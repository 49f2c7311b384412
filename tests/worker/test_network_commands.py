from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from harness.databases import Databases
from tests.stored_histories.history_library import SMALL_GRID as GRID
from tests.stored_histories.history_library import histories_of_grid, store_histories
from tests.worker.conftest import CommandLine
from threadstate.settings import DATABASE

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]


@pytest.fixture(scope="module")
def database(databases: Databases) -> str:
    url = databases.migrated()
    store_histories(url, GRID, histories_of_grid(GRID))
    return url


@pytest.fixture
def ask(
    command_line_on: Callable[[str], CommandLine], database: str, monkeypatch: pytest.MonkeyPatch
) -> Callable[..., str]:
    """What a command on the library prints."""
    monkeypatch.setenv(DATABASE, database)
    command_line = command_line_on(database)

    def asked(*arguments: str) -> str:
        code, out, err = command_line.here(*arguments)
        assert code == 0, err
        return out

    return asked


def test_a_history_stored_is_the_one_computed(ask: Callable[..., str]) -> None:
    orientation = ("--roll", "0", "--pitch", "-3", "--json")
    assert json.loads(ask("history", *orientation, "--stored")) == json.loads(ask("history", *orientation))


def test_heights_stored_are_those_computed(ask: Callable[..., str]) -> None:
    orientation = ("--roll", "0", "--pitch", "-3")
    heights = json.loads(ask("heights", *orientation, "--stored", "--json"))
    assert heights == json.loads(ask("heights", *orientation, "--json"))
    lines = ask("heights", *orientation, "--stored").splitlines()
    assert len(lines) == 1 + len(heights["phases"])
    assert f"{heights['first_heights'][0]:.6f}" in lines[1]


def test_tables_name_what_the_objects_hold(ask: Callable[..., str]) -> None:
    history = json.loads(ask("history", "--roll", "0", "--pitch", "-3", "--stored", "--json"))
    shown = ask("history", "--roll", "0", "--pitch", "-3", "--stored")
    assert all(one["formation"]["key"] in shown for one in history["intervals"])
    (orientation,) = json.loads(ask("windows", "--roll", "0", "--pitch", "-3", "--json"))["orientations"]
    shown = ask("windows", "--roll", "0", "--pitch", "-3")
    assert f"{orientation['snap']['fall']:.6f}" in shown
    assert f"{orientation['snap']['from']:.6f}" in shown
    assert f"{orientation['windows'][0]['enter']:.6f}" in shown
    key = next(one for one in history["intervals"] if not one["in_window"])["formation"]["key"]
    node = json.loads(ask("formation", "--key", key, "--json"))
    shown = ask("formation", "--key", key)
    assert all(one["formation"] in shown for one in node["following"])
    path = json.loads(ask("path", "--from", key, "--roll", "0", "--pitch", "-3", "--json"))
    assert f"{path['turning']:.6f} deg" in ask("path", "--from", key, "--roll", "0", "--pitch", "-3")
    location = json.loads(ask("locate", "--class", "stable_three_point", "--contacts", "3", "--json"))
    assert f"{100.0 * location['share']:.3f} %" in ask("locate", "--class", "stable_three_point", "--contacts", "3")
    summary = json.loads(ask("network", "--json"))
    assert str(summary["edges"]) in ask("network")
    assert ask("network", "--export", "dot").count(" -> ") == summary["edges"]
    for name in ("node-link", "graphml"):
        assert ask("network", "--export", name).count(key) > 0
    lines = ask("transitions", "--roll", "0", "--pitch", "-3", "--move", "ccw", "--limit", "5", "--json").splitlines()
    assert [json.loads(line)["move"] for line in lines] == ["ccw"] * 5
    assert json.loads(lines[0])["target"]["formation"] in ask("transitions", "--roll", "0", "--pitch", "-3")


def test_windows_of_all_orientations_are_one_object(ask: Callable[..., str]) -> None:
    found = json.loads(ask("windows", "--json"))
    assert (found["library"], found["unit"]) == (1, "in")
    tilts = [(one["roll"], one["pitch"]) for one in found["orientations"]]
    assert tilts == [(roll, pitch) for roll in GRID.tilts_deg for pitch in GRID.tilts_deg]
    names = {"from", "to", "fall", "steepest", "steepest_from", "jump", "jump_at"}
    assert {None if one["snap"] is None else frozenset(one["snap"]) for one in found["orientations"]} == {
        None,
        frozenset(names),
    }
    mm = json.loads(ask("windows", "--json", "--unit", "mm"))
    for one, other in zip(found["orientations"], mm["orientations"], strict=True):
        assert other["steepest"] == pytest.approx(25.4 * one["steepest"], rel=1e-12)


def test_falls_of_any_tilt_are_computed(ask: Callable[..., str]) -> None:
    asked = ("windows", "--roll", "2.5", "--pitch", "-1.2", "--json")
    (found,) = json.loads(ask(*asked))["orientations"]
    history = json.loads(ask("history", "--roll", "2.5", "--pitch", "-1.2", "--json"))
    assert found == {name: history[name] for name in found}
    (narrow,) = json.loads(ask(*asked, "--span", "0.5", "--least", "0.06"))["orientations"]
    assert 0.0 < narrow["steepest"] < found["steepest"]
    assert (narrow["snap"], narrow["windows"]) == (None, found["windows"])


def test_a_map_of_the_snaps_is_drawn(ask: Callable[..., str], tmp_path: Path) -> None:
    ask("windows", "--plot", str(tmp_path / "map.svg"))
    drawn = (tmp_path / "map.svg").read_text()
    assert drawn.startswith("<?xml")
    assert "fall of the snap" in drawn


def test_a_tolerance_gives_a_range(ask: Callable[..., str]) -> None:
    asked = ("windows", "--roll", "0", "--pitch", "-3", "--tolerance", "0.2")
    found = json.loads(ask(*asked, "--json"))
    low, high = found["range"]["fall"]
    assert low < found["orientations"][0]["snap"]["fall"] < high
    shown = ask(*asked)
    assert f"{low:.6f}" in shown
    assert "9 of 9 tilts" in shown


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--roll", "2.5"], "one of -3, 0, 3 deg"),
        (["--tolerance", "0.3"], "with --roll and --pitch"),
        (["--plot", "map.svg", "--roll", "0"], "`heights --plot`"),
        (["--roll", "0", "--pitch", "0", "--tolerance", "3"], "at most 2 deg"),
        (["--roll", "0", "--pitch", "0", "--span", "0"], "above 0"),
        (["--roll", "11", "--pitch", "0"], "-10 to 10"),
    ],
)
def test_what_cannot_be_answered_says_what_can(
    command_line_on: Callable[[str], CommandLine], database: str, arguments: list[str], message: str
) -> None:
    code, out, err = command_line_on(database).here("windows", "--database", database, *arguments)
    assert (code, out) == (2, "")
    assert message in err


def test_libraries_are_compared_over_all_orientations(ask: Callable[..., str]) -> None:
    first, second = json.loads(ask("compare", "--library", "1", "--library", "latest", "--json"))["libraries"]
    assert first == second
    windows = json.loads(ask("windows", "--json"))["orientations"]
    pitch = first["thread_pitch"]
    for one, found in zip(first["orientations"], windows, strict=True):
        assert (one["roll"], one["pitch"]) == (found["roll"], found["pitch"])
        widths = [window["width"] for window in found["windows"]]
        assert one["window"] == pytest.approx(sum(widths), abs=1e-9)
        assert one["widest"] == pytest.approx(max(widths, default=0.0), abs=1e-9)
        assert one["fall"] == pytest.approx(found["steepest"] / pitch, rel=1e-12)
        assert one["snaps"] == (found["snap"] is not None)
    assert (first["snaps"], first["windows"]) == (
        sum(one["snap"] is not None for one in windows),
        sum(bool(one["windows"]) for one in windows),
    )
    counted = json.loads(ask("summary", "--json"))
    assert first["states"] == counted["states"]
    assert first["classes"] == {name: count / counted["states"] for name, count in counted["classes"].items()}
    shown = ask("compare", "--library", "1", "--library", "latest", "--each").splitlines()
    (falls,) = [line for line in shown if line.startswith("steepest fall")]
    assert falls.count(f"{first['fall']['median']:.4f} (") == 2
    assert sum(line.count("snaps") for line in shown) - 1 == 2 * first["snaps"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [(["--unit", "mm"], "in thread pitches"), (["--each", "--tilt", "0,-3"], "without --tilt")],
)
def test_what_a_comparison_does_not_take(
    command_line_on: Callable[[str], CommandLine], database: str, arguments: list[str], message: str
) -> None:
    code, _, err = command_line_on(database).here("compare", "--database", database, *arguments)
    assert code == 2
    assert message in err


def test_orientations_are_compared_side_by_side(ask: Callable[..., str]) -> None:
    asked = ("compare", "--tilt", "0,-3", "--tilt", "2.5,-1.2", "--library", "1", "--library", "latest")
    found = json.loads(ask(*asked, "--json"))["orientations"]
    assert [(one["library"], one["roll"], one["pitch"]) for one in found] == [(1, 0, -3), (1, 2.5, -1.2)] * 2
    (stored,) = json.loads(ask("windows", "--roll", "0", "--pitch", "-3", "--json"))["orientations"]
    assert found[0] == {"library": 1, "designation": "1/4-20 UNC", "thread_pitch": 0.05, **stored}
    # All of this fall is within 3 deg, so that it is the steepest, too.
    assert ask(*asked).count(f"{stored['snap']['fall']:.6f}") == 4


def test_a_tilt_that_is_none_is_refused(command_line_on: Callable[[str], CommandLine], database: str) -> None:
    for tilt in ("0", "0,-4,1", "a,b"):
        code, _, err = command_line_on(database).here("compare", "--database", database, "--tilt", tilt)
        assert code == 2
        assert "two angles in degrees" in err


def test_a_library_is_asked_by_its_name(ask: Callable[..., str]) -> None:
    for arguments in (
        ("windows", "--json"),
        ("transitions", "--roll", "0", "--limit", "3", "--json"),
        ("network", "--json"),
        ("locate", "--flag", "tie", "--json"),
        ("history", "--roll", "0", "--pitch", "-3", "--json"),
        ("heights", "--roll", "0", "--pitch", "-3", "--json"),
        ("summary", "--json"),
    ):
        names = ("1", "latest", "1/4-20 UNC", "1-4-20-unc") if arguments[0] == "windows" else ("1/4-20 UNC",)
        said = {ask(*arguments, "--library", name) for name in names}
        assert said == {ask(*arguments, *(["--stored"] if arguments[0] in ("history", "heights") else []))}


def test_lengths_are_in_the_unit_that_is_asked_for(ask: Callable[..., str]) -> None:
    inches, millimetres = (
        json.loads(ask("history", "--roll", "0", "--pitch", "-3", "--library", "1", "--unit", unit, "--json"))
        for unit in ("in", "mm")
    )
    assert (inches["unit"], millimetres["unit"]) == ("in", "mm")
    for one, other in zip(inches["intervals"], millimetres["intervals"], strict=True):
        assert other["first_height"] == pytest.approx(25.4 * one["first_height"], rel=1e-15)
    shown = ask("history", "--roll", "0", "--pitch", "-3", "--library", "1", "--unit", "mm")
    assert "height (mm)" in shown
    assert f"{millimetres['intervals'][3]['first_height']:.5f}" in shown
    key = inches["intervals"][3]["formation"]["key"]
    for arguments in (
        ("transitions", "--from", key, "--limit", "1"),
        ("formation", "--key", key),
        ("path", "--from", key),
        ("heights", "--roll", "0", "--pitch", "-3", "--library", "1"),
    ):
        assert [json.loads(ask(*arguments, "--unit", unit, "--json"))["unit"] for unit in ("in", "mm")] == ["in", "mm"]
        if arguments[0] != "formation":
            assert "mm" in ask(*arguments, "--unit", "mm")


def test_phases_are_in_the_turn_and_intervals_past_it_marked(ask: Callable[..., str]) -> None:
    history = json.loads(ask("history", "--roll", "0", "--pitch", "-3", "--library", "1", "--json"))
    last = history["intervals"][-1]
    assert last["end"] > 360.0
    shown = ask("history", "--roll", "0", "--pitch", "-3", "--library", "1")
    assert f"{last['start']:.6f}  -> {last['end'] - 360.0:.6f}" in shown
    assert f"{last['end']:.6f}" not in shown


def test_what_is_located_leads_to_a_path(ask: Callable[..., str]) -> None:
    observed = ("--class", "stable_three_point", "--flag", "flush")
    location = json.loads(ask("locate", *observed, "--json"))
    keys = [one["key"] for one in location["formations"]]
    assert {one["formation"] for one in location["stretches"]} == set(keys)
    assert sum(one["share"] for one in location["formations"]) == pytest.approx(location["share"])
    shown = ask("locate", *observed)
    assert all(key in shown for key in keys)
    stretch = location["stretches"][0]
    at = ("--roll", str(stretch["roll"]), "--pitch", str(stretch["pitch"]), "--phase", str(stretch["start"] + 1e-6))
    path = json.loads(ask("path", "--from", stretch["formation"], *at, "--json"))
    assert path["steps"][0]["formation"] == stretch["formation"]


@pytest.mark.parametrize("command", ["history", "heights"])
def test_off_the_grid_a_library_is_computed(
    command_line_on: Callable[[str], CommandLine], database: str, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    monkeypatch.setenv(DATABASE, database)
    command_line = command_line_on(database)
    orientation = ("--roll", "2.5", "--pitch", "-3", "--json")
    code, out, err = command_line.here(command, *orientation, "--library", "latest")
    assert (code, err) == (0, "computed: roll 2.5 is not on the grid of library 1\n")
    assert out == command_line.here(command, *orientation)[1]
    on_grid = command_line.here(command, "--roll", "3", "--pitch", "-3", "--library", "1")
    assert (on_grid[0], on_grid[2]) == (0, "")
    code, _, err = command_line.here(command, *orientation, "--library", "latest", "--stored")
    assert (code, "no orientation of roll 2.5" in err) == (4, True)


def test_what_cannot_be_asked_is_said(
    command_line_on: Callable[[str], CommandLine], database: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(DATABASE, database)
    command_line = command_line_on(database)
    for arguments, code, words in (
        (("formation", "--key", "0123456789"), 4, "no formation 0123456789"),
        (("history", "--roll", "1", "--pitch", "0", "--stored"), 4, "no orientation of roll 1"),
        (("path", "--from", "0123456789", "--moves", "sideways"), 2, "sideways"),
        (("path", "--from", "0123456789", "--roll", "1"), 2, "roll and pitch"),
        (("locate", "--contact", "9"), 2, "stage"),
        (("history", "--roll", "11", "--pitch", "0"), 2, "roll is 11"),
        (("history", "--roll", "11", "--pitch", "0", "--library", "1"), 2, "roll is 11"),
        (("history", "--roll", "1", "--pitch", "0", "--library", "m6"), 4, "published are: 1 (1-4-20-unc)"),
        (("windows", "--library", "2"), 4, "library 2 is not published here; published are: 1 (1-4-20-unc)"),
        (("network", "--library", "latest-mesh"), 4, "no library is published yet"),
        (("summary", "--library", "1", "--method", "mesh"), 2, "--method is 'mesh'; valid: without --library"),
        (("locate",), 2, "at least one of --class, --contacts, --contact, --flag"),
        (("locate", "--ordered"), 2, "at least one of --class, --contacts, --contact, --flag"),
        (("heights", "--roll", "1", "--pitch", "0", "--library", "1", "--pair", "x"), 2, "without a library"),
        (
            ("history", "--roll", "1", "--pitch", "0", "--library", "1", "--dimension", "unit=mm"),
            2,
            "without a library",
        ),
    ):
        found, _, error = command_line.here(*arguments)
        assert (found, words in error) == (code, True), error
