from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.image import imread
from numpy.typing import NDArray

from tests.worker.conftest import CommandLine
from threadstate.errors import InvalidValueError
from threadstate.responses.documents import HeightsDocument, WindowDocument
from threadstate.units import LengthUnit
from worker.plots import plot_heights, plot_map

Floats = NDArray[np.float64]

pytestmark = pytest.mark.sqlite_alone

HEIGHTS = HeightsDocument(
    roll=0.0,
    pitch=-4.0,
    tolerance=1e-5,
    phases=[0.0, 90.0, 180.0, 357.0, 357.0 + 1e-9, 360.0],
    first_heights=[-0.08, 0.15, 0.19, 0.19, -0.09, -0.08],
    rest_heights=[None, -0.06, -0.03, None, None, None],
)
WINDOW = WindowDocument(
    roll=0.0,
    pitch=-4.0,
    enter=357.0,
    leave=395.0,
    width=38.0,
    climb=0.1,
    enter_height=-0.09,
    leave_height=0.05,
    lowest_phase=357.0,
    lowest_height=-0.09,
    courses=[],
)
MAP: Mapping[tuple[float, float], float | None] = {
    (roll, pitch): None if roll == pitch == 0.0 else abs(roll) + 2.0 * pitch
    for roll in (-1.0, 0.0, 1.0)
    for pitch in (-1.0, 0.0, 1.0)
}
WINDOW_RGB = (0xDF / 255, 0xE9 / 255, 0xD8 / 255)
NONE_RGB = (0xC8 / 255, 0xC8 / 255, 0xC8 / 255)


def _words(path: Path) -> list[str]:
    """What a drawing says, in the comments that matplotlib puts beside the outlines of each text."""
    ElementTree.parse(path)
    return re.findall(r"<!-- (.*?) -->", path.read_text())


def _coloured(picture: Floats, colour: tuple[float, float, float]) -> NDArray[np.bool_]:
    """Which pixels of a picture, by rows, have a colour."""
    return np.asarray((np.abs(picture - colour) < 0.5 / 255).all(axis=2))


def _share(path: Path, colour: tuple[float, float, float]) -> float:
    """The share of a picture that has a colour."""
    picture = imread(path)[:, :, :3]
    return float(_coloured(picture, colour).mean())


def test_heights_are_drawn_with_axes_and_units(tmp_path: Path) -> None:
    path = tmp_path / "heights.svg"
    plot_heights(HEIGHTS, [WINDOW], LengthUnit.MILLIMETRE, path)
    words = _words(path)
    for text in ("roll 0°, pitch -4°", "phase (deg), counter-clockwise", "height of the bolt (mm)"):
        assert text in words
    for label in ("clearance window", "at rest", "first contact"):
        assert words.count(label) == 1


def test_a_window_is_shaded_on_both_sides_of_phase_0(tmp_path: Path) -> None:
    path = tmp_path / "heights.png"
    plot_heights(HEIGHTS, [], LengthUnit.INCH, path)
    assert _share(path, WINDOW_RGB) == 0.0
    plot_heights(HEIGHTS, [WINDOW], LengthUnit.INCH, path)
    picture = imread(path)[:, :, :3]
    shaded = _coloured(picture, WINDOW_RGB).sum(axis=0) > 0.5 * len(picture)
    stretches = np.flatnonzero(np.diff(shaded.astype(int)) == 1)
    assert len(stretches) == 2
    assert stretches[0] < 0.2 * picture.shape[1] < 0.9 * picture.shape[1] < stretches[1]


def test_a_map_has_a_square_for_every_orientation_and_says_where_there_is_none(tmp_path: Path) -> None:
    path = tmp_path / "map.svg"
    plot_map(MAP, "Fall of the snap", LengthUnit.INCH, path)
    words = _words(path)
    for text in ("Fall of the snap", "Fall of the snap (in)", "roll (deg)", "pitch (deg)", "none"):
        assert text in words
    plot_map(MAP, "Fall of the snap", LengthUnit.INCH, tmp_path / "with.png")
    plot_map({key: value or 0.0 for key, value in MAP.items()}, "Fall", LengthUnit.INCH, tmp_path / "without.png")
    assert _share(tmp_path / "with.png", NONE_RGB) > 0.02
    assert _share(tmp_path / "without.png", NONE_RGB) < 0.001


def test_roll_goes_to_the_right_and_pitch_up(tmp_path: Path) -> None:
    only = (-1.0, 1.0)
    plot_map({tilt: 1.0 if tilt == only else None for tilt in MAP}, "one", LengthUnit.INCH, tmp_path / "map.png")
    picture = imread(tmp_path / "map.png")[:, :, :3]
    rows, columns = np.nonzero(_coloured(picture, NONE_RGB))
    left, right, top, bottom = columns.min(), columns.max(), rows.min(), rows.max()
    inside = picture[top:bottom, left:right]
    grey = _coloured(inside, NONE_RGB)
    assert not grey[: grey.shape[0] // 4, : grey.shape[1] // 4].any()


def test_a_map_without_any_value_is_grey(tmp_path: Path) -> None:
    plot_map({(0.0, 0.0): None}, "Fall of the snap", LengthUnit.INCH, tmp_path / "map.svg")
    assert "none" in _words(tmp_path / "map.svg")


@pytest.mark.parametrize("ending", ["svg", "png"])
def test_the_same_drawing_is_the_same_file(tmp_path: Path, ending: str) -> None:
    for name in ("a", "b"):
        plot_heights(HEIGHTS, [WINDOW], LengthUnit.INCH, tmp_path / f"{name}.{ending}")
    assert (tmp_path / f"a.{ending}").read_bytes() == (tmp_path / f"b.{ending}").read_bytes()


@pytest.mark.parametrize(("name", "valid"), [("a.pdf", "ends in .svg or .png"), ("no/a.svg", "folder that exists")])
def test_what_cannot_be_written_is_said_before_anything_is_computed(
    command_line: CommandLine, tmp_path: Path, name: str, valid: str
) -> None:
    with pytest.raises(InvalidValueError, match=valid):
        plot_map(MAP, "one", LengthUnit.INCH, tmp_path / name)
    code, out, err = command_line.here("heights", "--roll", "99", "--pitch", "0", "--plot", str(tmp_path / name))
    assert (code, out) == (2, "")
    assert valid in err


@pytest.mark.slow
def test_heights_draws_beside_what_it_prints(command_line: CommandLine, tmp_path: Path) -> None:
    path = tmp_path / "heights.svg"
    arguments = ("heights", "--roll", "3", "--pitch", "-3", "--unit", "mm", "--json")
    assert command_line.here(*arguments, "--plot", str(path)) == command_line.here(*arguments)
    assert "height of the bolt (mm)" in _words(path)
    assert "first contact" in _words(path)
