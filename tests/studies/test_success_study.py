"""The study of success maps: its tables and pictures, of maps that are given."""

from __future__ import annotations

from dataclasses import replace

import pytest

from studies.success.page import HEADING, critical_words, pictured, section, share_picture
from studies.success.study import StudiedMap, studied_inputs
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, CriticalFriction, OrientationMap, PhaseBoundary

ENGAGED, IDLE, UNDECIDED = AssemblyOutcome.ENGAGED, AssemblyOutcome.IDLE, AssemblyOutcome.UNDECIDED
GRID = Grid(1.0, 1.0, 180.0)


def studied(inputs: SuccessInputs) -> StudiedMap:
    """A map in which three orientations engage from every phase, one path is bounded and one lies flush."""
    orientations = []
    for i in range(GRID.orientation_count):
        place = GRID.orientation(i)
        cells = []
        for mu in inputs.frictions:
            second = ENGAGED if i in (3, 4, 5) else IDLE
            cells += [
                Cell(0.0, mu, ENGAGED, (), False, 0.25, 1.5, 0.002, 90.0),
                Cell(180.0, mu, second, (), False, 0.125, 1.0, 0.001, 90.0),
            ]
        if i == 0:
            cells[1] = Cell(180.0, inputs.frictions[0], UNDECIDED, (SettledFlag.FLUSH,), False, None, None, None, None)
        if i == 1:
            cells[1] = Cell(180.0, inputs.frictions[0], UNDECIDED, (), True, None, None, None, None)
        critical = CriticalFriction(0.1, 0.2, 180.0, IDLE, reenters=False)
        orientations.append(OrientationMap(i, place.roll_deg, place.pitch_deg, tuple(cells), (), critical))
    return StudiedMap(replace(inputs, grid=GRID), orientations)


@pytest.fixture(scope="module")
def maps() -> list[StudiedMap]:
    """Maps as of the study, over a small grid."""
    return [studied(inputs) for inputs in studied_inputs()]


def test_the_study_has_both_strategies_and_a_farther_turn_without_friction_and_with_it() -> None:
    found = {(one.strategy, one.device.ccw_turn_deg, one.frictions) for one in studied_inputs()}
    without, with_friction = (0.0,), (0.1, 0.2, 0.3)
    assert found == {
        *((strategy, 360.0, mu) for strategy in Strategy for mu in (without, with_friction)),
        (Strategy.CCW_THEN_CW, 390.0, with_friction),
    }


def test_the_section_counts_what_the_maps_hold(maps: list[StudiedMap]) -> None:
    text = section(maps)
    assert text.startswith(HEADING)
    assert "| `cw` | 0 | 9 | 3 | 3 | 3 | 9 | 7 |" in text
    assert "| `ccw_then_cw` | 0.2 | 9 | 3 | 3 | 3 | 9 | 9 |" in text
    assert "| `cw` | 0 | 12 of 18 | 0.25 | 1.5 | 0.002 |" in text
    assert "| `cw` | 0.1 | 12 engaged, 4 idle, 2 undecided | 1 `flush`, 1 bounded |" in text
    assert "| `cw` | 0.3 | 12 engaged, 6 idle | - |" in text
    assert "| `ccw_then_cw` through 390 deg | 0.3 | 12 of 18 | 0.25 | 1.5 | 0.002 |" in text
    assert "| roll | pitch | `ccw_then_cw` | `cw` | `ccw_then_cw` through 390 deg |" in text
    assert f"| -1 | 0 {3 * '| 0.1 to 0.2 (idle) '}|" in text
    assert text.count(".svg") == len(pictured(maps)) == 2
    assert "success/ccw_then_cw.svg" in text


def test_how_long_a_map_took_is_said_where_it_was_not_interrupted(maps: list[StudiedMap]) -> None:
    (line,) = [
        one for one in section([replace(maps[0], duration="7 min with 2 processes")]).splitlines() if "hash" in one
    ]
    assert line.endswith("`; 7 min with 2 processes.")
    (line,) = [one for one in section(maps[:1]).splitlines() if "hash" in one]
    assert line.endswith("`.")


def test_a_part_of_the_maps_has_a_section(maps: list[StudiedMap]) -> None:
    assert "Critical friction" not in section(maps[:1])


@pytest.mark.parametrize(
    ("critical", "words"),
    [
        (CriticalFriction(0.3, None, None, None, reenters=False), "at least 0.3"),
        (CriticalFriction(None, 0.0, 0.0, AssemblyOutcome.NO_SNAP, reenters=False), "none: no snap without friction"),
        (CriticalFriction(0.1, 0.2, 0.0, UNDECIDED, reenters=False), "0.1 to 0.2 (undecided)"),
    ],
)
def test_an_interval_is_words(critical: CriticalFriction, words: str) -> None:
    assert critical_words(critical) == words


def test_a_picture_has_every_orientation_and_marks_the_undecided(maps: list[StudiedMap]) -> None:
    drawn = share_picture(maps[0])
    assert drawn == share_picture(maps[0])
    assert drawn.count(">1?<") == 2
    assert drawn.count(">1<") + drawn.count(">2<") >= 7


def test_boundaries_are_counted_apart_from_paths_that_hang_on_the_step(maps: list[StudiedMap]) -> None:
    one = maps[0]
    first = one.orientations[2]
    boundaries = (
        PhaseBoundary(0.0, 0.0, 180.0, ENGAGED, IDLE),
        PhaseBoundary(0.0, 180.0, 360.0, IDLE, ENGAGED),
    )
    open_ended = (PhaseBoundary(0.0, 0.0, 180.0, ENGAGED, UNDECIDED),)
    doubtful = replace(first.cells[1], outcome=UNDECIDED, flags=(SettledFlag.STEP_DEPENDENT,))
    orientations = [
        replace(first, boundaries=boundaries),
        replace(first, cells=(first.cells[0], doubtful), boundaries=open_ended),
    ]
    text = section([StudiedMap(one.inputs, orientations)])
    assert "| `ccw_then_cw` | 0 | 2 | 1 |" in text
