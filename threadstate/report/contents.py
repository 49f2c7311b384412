"""What a report says: a success map, its summaries, its worst approaches and one path, as frozen values."""

from __future__ import annotations

import datetime
import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from threadstate.device.assembly_document import AssemblyDocument, assembly_document
from threadstate.device.assembly_model import AssemblyPath
from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.scaled import scaled_orientation
from threadstate.success.summary import (
    MapCounts,
    OrientationSummary,
    TiltArea,
    grid_cells,
    map_counts,
    orientation_summary,
    tilt_area,
)
from threadstate.units import LengthUnit, conversion_factor

_FIRST_TO_FAIL = (
    "Of the orientations that engage from every starting phase none has a lower critical friction than this one. The "
    "path has its largest torque, at the largest friction of the map at which all its phases engage."
)
_LARGEST_TORQUE = (
    "The orientations that engage from every starting phase do so at every friction of the map. Of them this one has "
    "the largest torque; the path is at the largest friction."
)
_NOT_FROM_ALL = (
    "No orientation engages from every starting phase. Of the paths that engage this one has the largest torque."
)
_NONE_ENGAGES = "No path engages. This one is the worst of the orientation nearest to level."


@dataclass(frozen=True, slots=True)
class ChosenPath:
    """The path that a report shows in detail: its commanded pose in degrees, its friction, and why this one.

    ``is_default`` says that it is the one that :func:`default_path` finds.
    """

    roll_deg: float
    pitch_deg: float
    phase_deg: float
    mu: float
    why: str
    is_default: bool


@dataclass(frozen=True, slots=True)
class FrictionPart:
    """A map at one friction: its orientations in the order of the grid, and what the paths that engage ask for.

    ``torque`` is in N times the report's unit, ``shift`` in that unit; None where no path engages. ``reasons`` are why
    paths are undecided, with how many: flags, and "bounded" for those beyond the limit of points.
    """

    mu: float
    area: TiltArea
    counts: MapCounts
    orientations: tuple[OrientationSummary, ...]
    torque: float | None
    tilt_deg: float | None
    shift: float | None
    reasons: tuple[tuple[str, int], ...]

    @property
    def paths(self) -> int:
        """The number of paths."""
        return sum(one.phases for one in self.orientations)

    @property
    def engaged_paths(self) -> int:
        """The number of paths that engage."""
        return sum(one.engaged for one in self.orientations)

    @property
    def undecided_paths(self) -> int:
        """The number of paths without a certain outcome."""
        return sum(one.undecided for one in self.orientations)


@dataclass(frozen=True)
class Report:
    """All that a report says; lengths of the map and of the path are in ``unit``.

    ``content_sha256`` is the map's, in the pair's unit. ``libraries`` are the versions of what computes, by name.
    """

    title: str
    date: datetime.date
    unit: LengthUnit
    inputs: SuccessInputs
    content_sha256: str
    orientations: tuple[OrientationMap, ...]
    parts: tuple[FrictionPart, ...]
    chosen: ChosenPath
    path: AssemblyDocument
    libraries: tuple[tuple[str, str], ...]

    @cached_property
    def without_friction(self) -> tuple[OrientationMap, ...]:
        """The orientations that engage from every phase without friction."""
        return tuple(one for one in self.orientations if one.critical.last is not None)

    @cached_property
    def failing_without_friction(self) -> tuple[OrientationMap, ...]:
        """Those that do not, the nearest to level first; an undecided path is not counted as a failure."""
        failing = [one for one in self.orientations if one.critical.last is None and _ends_decided(one)]
        return tuple(sorted(failing, key=lambda one: (math.hypot(one.roll_deg, one.pitch_deg), one.index)))

    @cached_property
    def undecided_without_friction(self) -> tuple[OrientationMap, ...]:
        """Those of which no more is known, as a path without friction is undecided."""
        return tuple(one for one in self.orientations if one.critical.last is None and not _ends_decided(one))

    @cached_property
    def worst(self) -> tuple[OrientationMap, ...]:
        """The orientations that engage without friction and not at each of the map's, the least critical first."""
        return tuple(sorted((one for one in self.without_friction if one.critical.first is not None), key=_critical))

    @property
    def first_failure(self) -> OrientationMap | None:
        """The orientation that certainly fails at the least friction above none; None where none does."""
        return next((one for one in self.worst if _ends_decided(one)), None)


def made_report(
    inputs: SuccessInputs,
    orientations: Sequence[OrientationMap],
    chosen: ChosenPath,
    path: AssemblyPath,
    *,
    unit: LengthUnit,
    title: str,
    date: datetime.date,
    libraries: Sequence[tuple[str, str]],
) -> Report:
    """The report of a whole map, in the order of its grid, and of the path that was chosen."""
    factor = conversion_factor(inputs.pair.unit, unit)
    scaled = tuple(scaled_orientation(one, factor) for one in orientations)
    return Report(
        title,
        date,
        unit,
        inputs,
        map_sha256(orientations),
        scaled,
        tuple(_part(scaled, inputs, mu) for mu in inputs.frictions),
        chosen,
        assembly_document(path, unit, factor),
        tuple(libraries),
    )


def default_path(inputs: SuccessInputs, orientations: Sequence[OrientationMap]) -> ChosenPath:
    """The worst path that engages.

    Of the orientations that engage from every phase at the least friction of the map it is that of the least critical
    friction, or of the largest torque where several are alike, at the largest friction of the map at which all its
    phases engage, from the phase of the largest torque. Where there is none it is the path of the largest torque that
    engages; where none does, the worst phase of the orientation nearest to level.
    """
    grid, frictions = inputs.grid, inputs.frictions
    summaries = [[orientation_summary(one, grid, mu) for mu in frictions] for one in orientations]
    engaging = [(one, found) for one, found in zip(orientations, summaries, strict=True) if found[0].all_engage]
    if engaging:
        ranks = [(*_critical(one)[:2], -(found[0].torque or 0.0), one.index) for one, found in engaging]
        one, found = engaging[ranks.index(min(ranks))]
        summary = [part for part in found if part.all_engage][-1]
        why = _FIRST_TO_FAIL if one.critical.first is not None else _LARGEST_TORQUE
        return ChosenPath(one.roll_deg, one.pitch_deg, summary.worst_phase_deg, summary.mu, why, is_default=True)
    cells = [(one, cell) for one in orientations for cell in grid_cells(one, grid, frictions[0]) if cell.engages]
    if cells:
        one, cell = max(cells, key=lambda pair: pair[1].torque or 0.0)
        return ChosenPath(one.roll_deg, one.pitch_deg, cell.phase_deg, cell.mu, _NOT_FROM_ALL, is_default=True)
    one = min(orientations, key=lambda found: (math.hypot(found.roll_deg, found.pitch_deg), found.index))
    worst_deg = orientation_summary(one, grid, frictions[0]).worst_phase_deg
    return ChosenPath(one.roll_deg, one.pitch_deg, worst_deg, frictions[0], _NONE_ENGAGES, is_default=True)


def _part(orientations: Sequence[OrientationMap], inputs: SuccessInputs, mu: float) -> FrictionPart:
    grid = inputs.grid
    summaries = tuple(orientation_summary(one, grid, mu) for one in orientations)
    return FrictionPart(
        mu,
        tilt_area(orientations, grid, mu),
        map_counts(orientations, grid, mu),
        summaries,
        _largest([one.torque for one in summaries]),
        _largest([one.tilt_deg for one in summaries]),
        _largest([one.shift for one in summaries]),
        _reasons([cell for one in orientations for cell in grid_cells(one, grid, mu)]),
    )


def _reasons(cells: Sequence[Cell]) -> tuple[tuple[str, int], ...]:
    counts = Counter(
        reason
        for cell in cells
        if not cell.is_decided
        for reason in (*(flag.value for flag in cell.flags), *(["bounded"] if cell.is_bounded else []))
    )
    return tuple(sorted(counts.items()))


def _largest(values: Sequence[float | None]) -> float | None:
    return max((value for value in values if value is not None), default=None)


def _critical(one: OrientationMap) -> tuple[float, float, int]:
    """By the friction up to which an orientation engages, then by that at which it does not, then by its number."""
    critical = one.critical
    last = -1.0 if critical.last is None else critical.last
    return (last, math.inf, one.index) if critical.first is None else (last, critical.first, one.index)


def _ends_decided(one: OrientationMap) -> bool:
    failure = failure_of(one)
    return failure is not None and failure.is_decided


def failure_of(one: OrientationMap) -> Cell | None:
    """The path that ends an orientation's critical friction; None where all engage."""
    critical = one.critical
    if critical.first is None or critical.phase_deg is None:
        return None
    return one.cell_at[critical.first, critical.phase_deg]
