"""Success maps: from which orientations, starting phases and frictions a device and a strategy assemble a pair."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime

from threadstate.client.models.answer import Answer
from threadstate.client.models.libraries import GridDocument
from threadstate.client.models.settled import Device
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag
from threadstate.device.strategy import Strategy
from threadstate.units import LengthUnit


class Cell(Answer):
    """A path of a map; torque in N times the unit, angles in degrees. None where it has none."""

    phase: float
    mu: float
    outcome: AssemblyOutcome
    flags: tuple[SettledFlag, ...]
    bounded: bool
    torque: float | None
    tilt: float | None
    shift: float | None
    end: float | None


class PathOutcome(Cell):
    """How a path ends, with the orientation at which it starts, in degrees."""

    roll: float
    pitch: float


class OutcomesAnswer(Answer):
    """How the paths of several commanded poses end, in their order."""

    designation: str
    source: str | None
    library: int | None
    unit: LengthUnit
    outcomes: tuple[PathOutcome, ...]


class PhaseBoundary(Answer):
    """Two starting phases of unlike outcomes at one friction, between which no other was computed."""

    mu: float
    phase_from: float
    phase_to: float
    outcome_before: AssemblyOutcome
    outcome_after: AssemblyOutcome


class CriticalFriction(Answer):
    """The interval of the critical friction, and the phase and the outcome that end it."""

    last: float | None
    first: float | None
    phase: float | None
    outcome: AssemblyOutcome | None
    reenters: bool


class PhaseSummary(Answer):
    """An orientation at one friction, over the starting phases of the grid; None where none engages."""

    mu: float
    share: float
    engaged: int
    undecided: int
    worst_phase: float
    torque: float | None
    tilt: float | None
    shift: float | None


class SummarisedOrientation(Answer):
    """The map of an orientation: its paths, boundaries of outcome, critical friction, and a summary at each friction.

    ``index`` is its number in the grid.
    """

    index: int
    roll: float
    pitch: float
    cells: tuple[Cell, ...]
    boundaries: tuple[PhaseBoundary, ...]
    critical: CriticalFriction
    summary: tuple[PhaseSummary, ...]


class FrictionTotals(Answer):
    """A map at one friction: how many orientations engage from every phase, and how all paths end.

    ``late_snaps`` paths end without a snap that others of their orientation meet; a turn of ``late_snap_turn`` degrees
    reaches those.
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


class SuccessMap(Answer):
    """A published success map."""

    id: int
    designation: str
    source: str | None
    device: Device
    strategy: Strategy
    grid: GridDocument
    mu: tuple[float, ...]
    phase_tolerance: float
    mu_tolerance: float
    point_limit: int
    stored_unit: LengthUnit
    code_version: str
    input_sha256: str
    content_sha256: str
    created_at: datetime
    published_at: datetime


class SuccessMapDetail(SuccessMap):
    """A published success map with its totals at each friction."""

    summary: tuple[FrictionTotals, ...]


class SuccessMapList(Answer):
    """All published success maps, the latest first."""

    success_maps: tuple[SuccessMap, ...]


class SuccessOrientationPage(Answer):
    """One page of orientations of a map, in the order of roll and pitch."""

    success_map: int
    unit: LengthUnit
    orientations: tuple[SummarisedOrientation, ...]
    next: str | None

    @property
    def items(self) -> Sequence[SummarisedOrientation]:
        """The orientations."""
        return self.orientations


class GrowingMap(Answer):
    """What is computed so far of a success map that is a job: of ``chunks`` orientations those that are there."""

    job: int
    chunks: int
    unit: LengthUnit
    summary: tuple[FrictionTotals, ...]
    orientations: tuple[SummarisedOrientation, ...]
