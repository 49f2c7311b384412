"""What a success map says: shares, needs, worst phases, areas of tilt; documents and hashes."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag, default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.document import (
    document_text,
    map_sha256,
    orientation_document,
    orientation_from_document,
    orientation_sha256,
)
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, CriticalFriction, OrientationMap, PhaseBoundary
from threadstate.success.summary import LateSnaps, late_snaps, map_counts, orientation_summary, tilt_area
from threadstate.success.summary_document import totals_documents
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.hand import Hand

ENGAGED, IDLE, UNDECIDED = AssemblyOutcome.ENGAGED, AssemblyOutcome.IDLE, AssemblyOutcome.UNDECIDED
GRID = Grid(2.0, 1.0, 180.0)
NONE = CriticalFriction(None, 0.0, 0.0, IDLE, reenters=False)


def cell(phase_deg: float, outcome: AssemblyOutcome, torque: float = 1.0, mu: float = 0.1) -> Cell:
    """A path with numbers that differ from each other."""
    return Cell(phase_deg, mu, outcome, (), False, torque, 2.0 * torque, 3.0 * torque, phase_deg + 90.0)


def orientation(index: int, *cells: Cell) -> OrientationMap:
    """An orientation of the grid with these paths."""
    place = GRID.orientation(index)
    return OrientationMap(index, place.roll_deg, place.pitch_deg, cells, (), NONE)


def grid_map(engaging: set[tuple[int, int]]) -> list[OrientationMap]:
    """A map of the grid in which these places engage from both phases, all others from one."""
    return [
        orientation(i, cell(0.0, ENGAGED), cell(180.0, ENGAGED if divmod(i, 5) in engaging else IDLE))
        for i in range(GRID.orientation_count)
    ]


def test_an_orientation_asks_for_what_its_engaging_paths_ask_for() -> None:
    found = orientation(3, cell(0.0, ENGAGED, 1.0), cell(180.0, IDLE, 5.0), cell(180.0, ENGAGED, 7.0, 0.2))
    summary = orientation_summary(found, GRID, 0.1)
    assert (summary.phases, summary.engaged, summary.undecided, summary.share) == (2, 1, 0, 0.5)
    assert (summary.torque, summary.tilt_deg, summary.shift) == (1.0, 2.0, 3.0)
    assert summary.worst_phase_deg == 180.0
    assert not summary.all_engage


def test_the_worst_phase_is_a_certain_failure_else_the_largest_torque() -> None:
    def worst(*cells: Cell) -> float:
        return orientation_summary(orientation(3, *cells), GRID, 0.1).worst_phase_deg

    assert worst(cell(0.0, UNDECIDED), cell(180.0, IDLE)) == 180.0
    assert worst(cell(0.0, ENGAGED), cell(180.0, UNDECIDED)) == 180.0
    assert worst(cell(0.0, ENGAGED, 2.0), cell(180.0, ENGAGED, 1.0)) == 0.0


def test_where_nothing_engages_nothing_is_needed() -> None:
    summary = orientation_summary(orientation(3, cell(0.0, IDLE), cell(180.0, UNDECIDED)), GRID, 0.1)
    assert (summary.torque, summary.tilt_deg, summary.shift) == (None, None, None)
    assert (summary.engaged, summary.undecided) == (0, 1)


@pytest.mark.parametrize(
    ("engaging", "around_level", "largest"),
    [
        (set(), 0, 0),
        ({(2, 2)}, 1, 1),
        ({(2, 2), (2, 3), (3, 3), (0, 0)}, 3, 3),
        ({(2, 2), (1, 1), (1, 0), (0, 0)}, 1, 3),
        ({(0, 0), (4, 4)}, 0, 1),
    ],
)
def test_the_area_of_tilt_is_connected_by_neighbours(
    engaging: set[tuple[int, int]], around_level: int, largest: int
) -> None:
    area = tilt_area(grid_map(engaging), GRID, 0.1)
    assert (area.orientations, area.engaged) == (25, len(engaging))
    assert (area.around_level, area.largest, area.cell_deg2) == (around_level, largest, 1.0)


def test_one_orientation_has_no_area() -> None:
    level = orientation(0, cell(0.0, ENGAGED), cell(180.0, ENGAGED))
    area = tilt_area([level], Grid(0.0, 1.0, 180.0), 0.1)
    assert (area.engaged, area.around_level, area.cell_deg2) == (1, 1, 0.0)


def test_every_path_of_the_grid_is_counted() -> None:
    bounded = Cell(180.0, 0.1, UNDECIDED, (), True, None, None, None, None)
    flagged = replace(cell(0.0, UNDECIDED), flags=(SettledFlag.FLUSH,))
    counts = map_counts([orientation(0, flagged, bounded), orientation(1, cell(0.0, ENGAGED), bounded)], GRID, 0.1)
    assert counts.outcomes == ((ENGAGED, 1), (UNDECIDED, 3))
    assert (counts.flags, counts.bounded) == ((("flush", 1),), 2)


def test_a_document_reads_back_and_has_the_hash_of_its_map() -> None:
    bounded = Cell(180.0, 0.1, UNDECIDED, (SettledFlag.FLUSH,), True, None, None, None, None)
    found = replace(
        orientation(3, cell(0.0, ENGAGED, 0.1), bounded),
        boundaries=(PhaseBoundary(0.1, 0.0, 180.0, ENGAGED, UNDECIDED),),
        critical=CriticalFriction(0.1, 0.2, 180.0, IDLE, reenters=True),
    )
    text = document_text(orientation_document(found))
    again = orientation_from_document(json.loads(text))
    assert again == found
    assert document_text(orientation_document(again)) == text
    assert orientation_sha256(again) == orientation_sha256(found)
    assert orientation_sha256(replace(found, critical=NONE)) != orientation_sha256(found)


def test_the_hash_of_a_map_does_not_depend_on_the_order_in_which_it_was_computed() -> None:
    found = grid_map({(2, 2)})
    assert map_sha256(found) == map_sha256(found[::-1])
    assert map_sha256(found) != map_sha256(grid_map({(2, 3)}))


def test_paths_that_end_soon_before_a_snap_of_others_are_counted() -> None:
    """Of the first orientation others snap at 361.5 deg, of the second at 340; of the third none snaps."""
    grid = Grid(1.0, 1.0, 120.0)
    inputs = SuccessInputs(quarter_twenty_unc(), default_device(), Strategy.CCW_THEN_CW, grid, (0.1,))

    def path(phase_deg: float, snap_deg: float | None) -> Cell:
        outcome = AssemblyOutcome.NO_SNAP if snap_deg is None else ENGAGED
        end_deg = phase_deg + 360.0 if snap_deg is None else snap_deg - 270.0
        return Cell(phase_deg, 0.1, outcome, (), False, 1.0, 1.0, 1.0, end_deg)

    snaps = ((None, 361.5, 361.0), (None, 340.0, 340.0), (None, None, None))
    found = [
        OrientationMap(i, 0.0, 0.0, tuple(map(path, grid.phases_deg, row)), (), NONE) for i, row in enumerate(snaps)
    ]
    late = late_snaps(found, inputs, 0.1)
    assert (late.paths, late.turn_deg) == (1, 361.0)
    farther = replace(inputs, device=replace(inputs.device, ccw_turn_deg=361.25))
    assert late_snaps(found, farther, 0.1).turn_deg == 361.5
    (totals,) = totals_documents(found, inputs)
    assert (totals["late_snaps"], totals["late_snap_turn"]) == (1, 361.0)
    assert late_snaps(found[2:], inputs, 0.1) == LateSnaps(0.1, 0, None)


def test_a_left_hand_bolt_is_turned_the_other_way_to_its_snap() -> None:
    grid = Grid(1.0, 1.0, 180.0)
    pair = replace(quarter_twenty_unc(), hand=Hand.LEFT)
    inputs = SuccessInputs(pair, default_device(), Strategy.CCW_THEN_CW, grid, (0.1,))
    cells = (
        Cell(0.0, 0.1, AssemblyOutcome.NO_SNAP, (), False, 1.0, 1.0, 1.0, -360.0),
        Cell(180.0, 0.1, ENGAGED, (), False, 1.0, 1.0, 1.0, -2.0 + 270.0),
    )
    found = [OrientationMap(0, 0.0, 0.0, cells, (), NONE)]
    assert late_snaps(found, inputs, 0.1) == LateSnaps(0.1, 1, 362.0)
