"""What a success map says as JSON objects: totals by friction, and orientations with their summaries."""

from __future__ import annotations

from collections.abc import Sequence

from typing_extensions import TypedDict

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.library.grid import Grid
from threadstate.success.document import CellDocument, OrientationDocument, cell_document, orientation_document
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.scaled import scaled_cell, scaled_orientation
from threadstate.success.summary import late_snaps, map_counts, orientation_summary, tilt_area


class FrictionTotalsDocument(TypedDict):
    """A map at one friction: how many orientations engage from every phase, and how all paths end.

    ``late_snaps`` paths end without a snap that others of their orientation meet; a turn of ``late_snap_turn`` degrees
    reaches those. Null where there are none.
    """

    mu: float
    orientations: int
    engaged: int
    around_level: int
    largest: int
    area: float
    outcomes: dict[AssemblyOutcome, int]
    flags: dict[str, int]
    bounded: int
    late_snaps: int
    late_snap_turn: float | None


class PhaseSummaryDocument(TypedDict):
    """An orientation at one friction, over the starting phases of the grid; null where none engages."""

    mu: float
    share: float
    engaged: int
    undecided: int
    worst_phase: float
    torque: float | None
    tilt: float | None
    shift: float | None


class SummarisedOrientationDocument(OrientationDocument):
    """The map of an orientation with its summary at each friction."""

    summary: list[PhaseSummaryDocument]


class OutcomeDocument(CellDocument):
    """How a path ends, with the orientation at which it starts, in degrees."""

    roll: float
    pitch: float


def outcome_document(roll_deg: float, pitch_deg: float, cell: Cell, factor: float = 1.0) -> OutcomeDocument:
    """The document of a path that ends so, in a unit of which the pair's has ``factor``."""
    return {"roll": roll_deg + 0.0, "pitch": pitch_deg + 0.0, **cell_document(scaled_cell(cell, factor))}


def totals_documents(orientations: Sequence[OrientationMap], inputs: SuccessInputs) -> list[FrictionTotalsDocument]:
    """The totals of a map at each of its frictions; ``area`` is that of the largest set, in square degrees."""
    found: list[FrictionTotalsDocument] = []
    grid = inputs.grid
    for mu in inputs.frictions:
        area = tilt_area(orientations, grid, mu)
        counts = map_counts(orientations, grid, mu)
        late = late_snaps(orientations, inputs, mu)
        found.append(
            {
                "mu": mu + 0.0,
                "orientations": area.orientations,
                "engaged": area.engaged,
                "around_level": area.around_level,
                "largest": area.largest,
                "area": area.largest * area.cell_deg2,
                "outcomes": dict(counts.outcomes),
                "flags": dict(counts.flags),
                "bounded": counts.bounded,
                "late_snaps": late.paths,
                "late_snap_turn": late.turn_deg,
            }
        )
    return found


def summarised_document(
    found: OrientationMap, grid: Grid, frictions: Sequence[float], factor: float = 1.0
) -> SummarisedOrientationDocument:
    """The document of an orientation and its summaries, in a unit of which the pair's has ``factor``."""
    shown = scaled_orientation(found, factor)
    summaries = [orientation_summary(shown, grid, mu) for mu in frictions]
    return {
        **orientation_document(shown),
        "summary": [
            {
                "mu": one.mu + 0.0,
                "share": one.share,
                "engaged": one.engaged,
                "undecided": one.undecided,
                "worst_phase": one.worst_phase_deg + 0.0,
                "torque": one.torque,
                "tilt": one.tilt_deg,
                "shift": one.shift,
            }
            for one in summaries
        ],
    }
