"""Success maps in files: what is appended is read again, what was cut off is dropped, anything else is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.success.inputs import SuccessInputs
from threadstate.success.map_file import growing_map, inputs_of_map, read_map
from threadstate.success.model import Cell, CriticalFriction, OrientationMap
from threadstate.thread.catalogue import quarter_twenty_unc

INPUTS = SuccessInputs(quarter_twenty_unc(), default_device(), Strategy.CW, Grid(1.0, 1.0, 180.0))


def orientation(index: int) -> OrientationMap:
    """An orientation of the map."""
    place = INPUTS.grid.orientation(index)
    cell = Cell(180.0, 0.1, AssemblyOutcome.IDLE, (), False, 0.1 + index, 1.0, 1e-3, -90.0)
    critical = CriticalFriction(None, 0.0, 180.0, AssemblyOutcome.IDLE, reenters=False)
    return OrientationMap(index, place.roll_deg, place.pitch_deg, (cell,), (), critical)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file with two orientations, appended by two runs in the order in which they were finished."""
    path = tmp_path / "success.map"
    for index in (5, 2):
        with growing_map(path, INPUTS) as (_, append):
            append(orientation(index))
    return path


def test_what_is_appended_is_read_in_the_order_of_the_grid(path: Path) -> None:
    assert read_map(path, INPUTS) == [orientation(2), orientation(5)]
    assert path.read_bytes().count(b"\n") == 3


def test_what_a_killed_run_leaves_of_a_line_is_dropped(path: Path) -> None:
    content = path.read_bytes()
    header = content.index(b"\n") + 1
    whole = content.splitlines(keepends=True)
    for length in (0, 1, header // 2, header - 1, header, header + 40, len(content) - 1, len(content)):
        path.write_bytes(content[:length])
        kept = content[:length].count(b"\n") - 1
        expected = {-1: [], 0: [], 1: [orientation(5)], 2: [orientation(2), orientation(5)]}[kept]
        assert read_map(path, INPUTS) == expected
        with growing_map(path, INPUTS) as (known, append):
            assert known == expected
            append(orientation(7))
        assert read_map(path, INPUTS) == [*expected, orientation(7)]
        assert path.read_bytes().startswith(whole[0])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"roll,pitch\n1,2\n", "a success map, or a file that does not exist"),
        (b"notes", "a success map, or a file that does not exist"),
        (b'{"input_sha256":"0123456789abcdef"}\n', "a map of the same inputs and code"),
        (b"[]\n", "a success map, or a file that does not exist"),
    ],
)
def test_another_file_is_refused_and_left_as_it_is(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "other"
    path.write_bytes(content)
    with pytest.raises(InvalidValueError, match=words), growing_map(path, INPUTS):
        pass
    with pytest.raises(InvalidValueError, match=words):
        read_map(path, INPUTS)
    assert path.read_bytes() == content


def test_a_map_of_other_inputs_is_refused(path: Path) -> None:
    other = replace(INPUTS, point_limit=500)
    with pytest.raises(InvalidValueError, match=f"{other.sha256[:12]}, not {INPUTS.sha256[:12]}"):
        read_map(path, other)


def test_a_line_that_was_changed_is_named(path: Path) -> None:
    path.write_bytes(path.read_bytes().replace(b'"torque":2.1', b'"torque":2.2'))
    with pytest.raises(InvalidValueError, match=r"map file: line 3 is .*valid: an orientation with its own hash"):
        read_map(path, INPUTS)


def test_two_runs_do_not_write_one_file(path: Path) -> None:
    with (
        growing_map(path, INPUTS),
        pytest.raises(InvalidValueError, match="a file that no other run writes"),
        growing_map(path, INPUTS),
    ):
        pass


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with (
        pytest.raises(InvalidValueError, match="a file that can be written"),
        growing_map(tmp_path / "none" / "success.map", INPUTS),
    ):
        pass
    with pytest.raises(InvalidValueError, match="a file that can be read"):
        read_map(tmp_path / "none", INPUTS)


def test_a_file_says_what_its_map_is_computed_from(path: Path) -> None:
    found = inputs_of_map(path)
    assert found == INPUTS
    assert found is not None
    assert found.sha256 == INPUTS.sha256


def test_without_a_first_line_nothing_is_known_of_a_map(path: Path, tmp_path: Path) -> None:
    assert inputs_of_map(tmp_path / "missing.map") is None
    path.write_bytes(path.read_bytes().splitlines()[0][:-1])
    assert inputs_of_map(path) is None


@pytest.mark.parametrize("line", [b"# Notes\n", b"[]\n", b'{"pair": {}}\n', b"\xff\n"])
def test_a_file_that_is_no_map_has_no_inputs(tmp_path: Path, line: bytes) -> None:
    path = tmp_path / "notes.txt"
    path.write_bytes(line)
    with pytest.raises(InvalidValueError, match="a success map, or a file that does not exist"):
        inputs_of_map(path)


def test_a_folder_has_no_inputs(tmp_path: Path) -> None:
    with pytest.raises(InvalidValueError, match="a file that can be read"):
        inputs_of_map(tmp_path)
