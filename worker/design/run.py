"""Searching a device: success maps of the devices that are tried, computed by several processes and kept in files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from threadstate.device.document import device_document
from threadstate.device.model import Limits
from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.success.design import (
    Candidate,
    Parameter,
    Tolerance,
    best_first,
    candidate_of,
    device_with,
    front,
    searched,
    tolerances,
)
from threadstate.success.inputs import SuccessInputs
from worker.output import print_status
from worker.success.run import computed_map

NO_TOLERANCE_DEG = 360.0
"""Boundaries along the phase are those of the starting phases: a search does not ask for them."""
LARGEST_MU_TOLERANCE = 1.0


@dataclass(frozen=True)
class DesignResult:
    """What a search found.

    Attributes:
        parameters: what was varied.
        base: the device that was begun with, at all frictions.
        tried: all devices that were tried, at the least friction, in that order.
        front: those of them that no other one dominates, the best one first.
        finalists: the best of the front at all frictions, the best one first.
        tolerances: how far the parameters of the best finalist may err.
    """

    parameters: tuple[Parameter, ...]
    base: Candidate
    tried: tuple[Candidate, ...]
    front: tuple[Candidate, ...]
    finalists: tuple[Candidate, ...]
    tolerances: tuple[Tolerance, ...]


class Design:
    """A search with these inputs: those of the map of the device that is begun with, and all frictions that count.

    Maps are kept below ``folder``; a search that was interrupted goes on with them.
    """

    def __init__(
        self,
        inputs: SuccessInputs,
        parameters: Sequence[Parameter],
        limits: Limits,
        workers: int,
        folder: Path,
        scheduler: str | None = None,
    ) -> None:
        names = self._names = tuple(one.name for one in parameters)
        if not names or len(set(names)) < len(names):
            raise InvalidValueError("vary", ", ".join(names) or "nothing", "one or more names, each once")
        self._inputs = replace(inputs, phase_tolerance_deg=NO_TOLERANCE_DEG, mu_tolerance=LARGEST_MU_TOLERANCE)
        self._parameters = tuple(parameters)
        self._limits = limits
        self._workers = workers
        self._folder = folder
        self._scheduler = scheduler
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InvalidValueError("maps", str(folder), f"a folder that can be made ({error.strerror})") from None

    def run(self, most: int, finalists: int) -> DesignResult:
        """Try up to ``most`` devices at the least friction, then the best of the front at all of them.

        Raises:
            InvalidValueError: a device that is tried is not valid.
            ComputeError: a computing process failed.
            ClusterError: the cluster cannot be used, or becomes unreachable.
        """
        least, every = self._inputs.frictions[:1], self._inputs.frictions
        given = device_document(self._inputs.device)
        start = tuple(given[name] for name in self._names if isinstance(given.get(name), float))
        candidates = searched(
            lambda values: self._candidate(least, values),
            self._parameters,
            most,
            start if len(start) == len(self._names) else None,
        )
        best = front(candidates)
        whole = best_first([self._candidate(every, one.values) for one in best[:finalists]])
        errors = tolerances(lambda values: self._candidate(least, values), whole[0], self._parameters)
        return DesignResult(
            self._parameters,
            self._candidate(every, ()),
            tuple(candidates),
            tuple(best),
            tuple(whole),
            tuple(errors),
        )

    def _candidate(self, frictions: tuple[float, ...], values: tuple[float, ...]) -> Candidate:
        """What is said of the device with these values; without values of the one that is begun with."""
        device = device_with(self._inputs.device, dict(zip(self._names, values, strict=False)))
        inputs = replace(self._inputs, device=device, frictions=frictions)
        path = self._folder / f"{inputs.sha256[:16]}.map"
        result = computed_map(inputs, self._workers, path, _Unwatched(), self._scheduler)
        found = candidate_of(values, device, result.orientations, inputs.grid, frictions, self._limits)
        words = ", ".join(f"{name} {number_text(value)}" for name, value in zip(self._names, values, strict=False))
        print_status(f"{words or 'as given'}: {found.engaged[0]} of {inputs.grid.orientation_count} engage")
        return found


class _Unwatched:
    """Nobody watches how far the map of a device is; a line says what was found of it."""

    def begin(self, committed: int, total: int) -> None:
        """The map is open."""

    def ready(self) -> None:
        """The kernels are loaded."""

    def advance(self, poses: int) -> None:
        """More paths are there."""
