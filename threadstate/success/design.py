"""The search for a device that brings as many orientations home as possible, within limits of travel and torque.

It knows neither kernels nor files: what a device's success map says is asked of a function (docs/design.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from itertools import pairwise

from scipy.optimize import direct

from threadstate.device.document import DIAGONAL, device_document, device_from_document
from threadstate.device.model import Device, Limits
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.numbers import number_text
from threadstate.success.model import Cell, OrientationMap
from threadstate.success.summary import grid_cells

NAMES = ("k_lateral", "k_axial", "k_tilt", "k_twist", "centre", "push", "ccw_turn")
"""What of a device can be varied."""
DIGITS = 3
"""Significant digits of a device that is tried: one that can be written down."""
LOGARITHMIC_FROM = 5.0
"""A range whose ends are at least this many times apart is searched by the logarithm."""
SHARE_OF_DIRECT = 0.6
"""Of the devices that are tried; the others are near the best of them."""
FIRST_STEP, LAST_STEP = 0.125, 0.01
"""Steps of that part of the search, of the ranges."""
STEPS = (1.1, 1.25, 1.5, 2.0, 3.0)
"""Factors by which a parameter may err; one that is searched linearly errs by as large a part of its range."""


@dataclass(frozen=True)
class Parameter:
    """A number of the device that is varied, in the device's own unit, and its range.

    Raises:
        InvalidValueError: it is not a number of a device, or the range is empty or not finite.
    """

    name: str
    low: float
    high: float

    def __post_init__(self) -> None:
        if self.name not in NAMES:
            raise InvalidValueError("vary", self.name, ", ".join(NAMES))
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            given = f"{number_text(self.low)}:{number_text(self.high)}"
            raise InvalidValueError(f"vary {self.name}", given, "two finite numbers, the lower one first")

    @property
    def is_logarithmic(self) -> bool:
        """Whether it is searched by its logarithm."""
        return self.low > 0.0 and self.high >= LOGARITHMIC_FROM * self.low

    def at(self, fraction: float) -> float:
        """The value at a fraction of the range, 0 to 1, rounded to three significant digits of the range's end."""
        if self.is_logarithmic:
            value = self.low * (self.high / self.low) ** fraction
            scale = abs(value)
        else:
            value = self.low + (self.high - self.low) * fraction
            scale = max(abs(self.low), abs(self.high))
        return round(value, DIGITS - 1 - math.floor(math.log10(scale))) + 0.0 if scale > 0.0 else 0.0

    def fraction_of(self, value: float) -> float:
        """The fraction of the range at which a value lies; outside 0 to 1 where that is outside."""
        if self.is_logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low) if value > 0.0 else -math.inf
        return (value - self.low) / (self.high - self.low)

    def moved(self, value: float, step: float) -> float:
        """The value that errs by a step of ``STEPS`` (or its inverse), within the range."""
        if self.is_logarithmic:
            moved = value * step
        else:
            size = (max(step, 1.0 / step) - 1.0) * 0.1 * (self.high - self.low)
            moved = value + math.copysign(size, step - 1.0)
        return min(max(moved, self.low), self.high)


def is_within(cell: Cell, limits: Limits) -> bool:
    """Whether a path engages within limits; lengths are in the pair's unit."""
    if not cell.engages or cell.tilt_deg is None or cell.shift is None or cell.torque is None:
        return False
    return limits.allow_travel(cell.tilt_deg, cell.shift) and limits.allow_torque(cell.torque)


@dataclass(frozen=True)
class Candidate:
    """A device that was tried, and what its map says within the limits.

    Attributes:
        values: the parameters that are varied, in the order of the search.
        device: the device.
        frictions: the frictions of its map, ascending.
        engaged: at each friction how many orientations engage from every phase, within the limits.
        undecided: at each friction how many of the others might: a path of theirs has no certain outcome.
        worst_critical: the largest friction of the map up to which every orientation does; None where one does not at
            the least.
        mean_critical: the mean, over the orientations, of the largest friction of the map up to which each does, those
            that do not at the least counted as 0.
        torque, tilt_deg, shift: the largest asked for by the paths at the least friction that are within the limits; 0
            where there are none. Torque in N times the pair's unit, shift in the latter.
    """

    values: tuple[float, ...]
    device: Device
    frictions: tuple[float, ...]
    engaged: tuple[int, ...]
    undecided: tuple[int, ...]
    worst_critical: float | None
    mean_critical: float
    torque: float
    tilt_deg: float
    shift: float

    @property
    def rank(self) -> tuple[float, ...]:
        """What is compared: the worst critical friction, how many engage, the mean; then less travel is better."""
        worst = -1.0 if self.worst_critical is None else self.worst_critical
        return (worst, float(sum(self.engaged)), self.mean_critical, -self.tilt_deg, -self.shift)

    def dominates(self, other: Candidate) -> bool:
        """Whether it is at least as good in how many engage, tilt, shift and torque, and better in one of them."""
        ours, others = self._aims, other._aims
        return all(a >= b for a, b in zip(ours, others, strict=True)) and ours != others

    @property
    def _aims(self) -> tuple[float, ...]:
        return (float(sum(self.engaged)), -self.tilt_deg, -self.shift, -self.torque)


@dataclass(frozen=True)
class Tolerance:
    """How far a parameter of a device may err, the others as they are.

    ``low`` and ``high`` are the farthest values tried at which as many orientations engage at the least friction;
    ``fails_below`` and ``fails_above`` the nearest ones tried at which fewer do, None where none was found.
    """

    name: str
    value: float
    low: float
    high: float
    fails_below: float | None
    fails_above: float | None


def device_with(base: Device, values: Mapping[str, float]) -> Device:
    """A device with some of its numbers replaced, in its own unit.

    Raises:
        InvalidValueError: the device has no four stiffnesses of its own, or a number is not valid.
    """
    document = {name: value for name, value in device_document(base).items() if value is not None}
    if any(name in DIAGONAL for name in values) and "stiffness" in document:
        raise InvalidValueError("device", "a 6 x 6 matrix", "four stiffnesses, where one of them is varied")
    return device_from_document({**document, **values})


def candidate_of(
    values: Sequence[float],
    device: Device,
    orientations: Sequence[OrientationMap],
    grid: Grid,
    frictions: Sequence[float],
    limits: Limits,
) -> Candidate:
    """What a device's map says within the limits."""
    holding: list[list[bool]] = []
    undecided = []
    for mu in frictions:
        cells = [grid_cells(one, grid, mu) for one in orientations]
        holds = [all(is_within(cell, limits) for cell in of_one) for of_one in cells]
        holding.append(holds)
        open_cells = [all(is_within(cell, limits) or not cell.is_decided for cell in of_one) for of_one in cells]
        undecided.append(sum(is_open and not held for is_open, held in zip(open_cells, holds, strict=True)))
    criticals = [_critical([holds[k] for holds in holding], frictions) for k in range(len(orientations))]
    worst = None if None in criticals else min(mu for mu in criticals if mu is not None)
    within = [cell for one in orientations for cell in grid_cells(one, grid, frictions[0]) if is_within(cell, limits)]
    return Candidate(
        tuple(values),
        device,
        tuple(frictions),
        tuple(sum(holds) for holds in holding),
        tuple(undecided),
        worst,
        sum(mu or 0.0 for mu in criticals) / len(criticals),
        max((cell.torque or 0.0 for cell in within), default=0.0),
        max((cell.tilt_deg or 0.0 for cell in within), default=0.0),
        max((cell.shift or 0.0 for cell in within), default=0.0),
    )


def searched(
    evaluate: Callable[[tuple[float, ...]], Candidate],
    parameters: Sequence[Parameter],
    most: int,
    start: tuple[float, ...] | None = None,
) -> list[Candidate]:
    """Up to ``most`` different devices, in the order in which they were tried; that of ``start`` first, if it is given.

    For the first ``SHARE_OF_DIRECT`` of them DIRECT divides the ranges (Jones, Perttunen and Stuckman 1993, as scipy
    has it), beginning with the middle of all. From the best of these a compass search goes on (Kolda, Lewis and Torczon
    2003): each number alone a step up and down, with half the step where none of them is better. No chance is in it.
    """
    tried: dict[tuple[float, ...], Candidate] = {}

    def candidate(values: tuple[float, ...], room: int) -> Candidate:
        if values not in tried:
            if len(tried) >= room:
                raise _EnoughTriedError
            tried[values] = evaluate(values)
        return tried[values]

    def values_at(fractions: Sequence[float]) -> tuple[float, ...]:
        return tuple(one.at(float(fraction)) for one, fraction in zip(parameters, fractions, strict=True))

    divided = math.ceil(SHARE_OF_DIRECT * most)
    with suppress(_EnoughTriedError):
        if start is not None:
            candidate(start, most)
        cost = partial(_cost_at, lambda fractions: candidate(values_at(fractions), divided))
        direct(cost, [(0.0, 1.0)] * len(parameters), maxfun=20 * divided, maxiter=20 * divided)
    with suppress(_EnoughTriedError):
        _compass(lambda values: candidate(values, most), parameters, best_first(list(tried.values()))[0])
    return list(tried.values())


def _cost_at(at: Callable[[Sequence[float]], Candidate], fractions: Sequence[float]) -> float:
    return _cost(at(fractions))


def _compass(
    evaluate: Callable[[tuple[float, ...]], Candidate], parameters: Sequence[Parameter], best: Candidate
) -> None:
    """Try devices beside the best one, as long as steps are not too small to tell two of them apart."""
    step = FIRST_STEP
    while step >= LAST_STEP:
        before = best
        for k, parameter in enumerate(parameters):
            for sign in (1.0, -1.0):
                fraction = parameter.fraction_of(best.values[k]) + sign * step
                if 0.0 <= fraction <= 1.0:
                    values = (*best.values[:k], parameter.at(fraction), *best.values[k + 1 :])
                    best = min(best, evaluate(values), key=_cost)
        if best is before:
            step *= 0.5


def best_first(candidates: Sequence[Candidate]) -> list[Candidate]:
    """The candidates, the best one first; of equal ones that which was tried first."""
    return sorted(candidates, key=lambda one: one.rank, reverse=True)


def front(candidates: Sequence[Candidate]) -> list[Candidate]:
    """Those that no other one dominates, the best one first: how many engage against tilt, shift and torque.

    One of which nothing engages is among them only where nothing engages of any.
    """
    some = [one for one in candidates if sum(one.engaged) > 0] or candidates
    return best_first([one for one in some if not any(other.dominates(one) for other in some)])


def tolerances(
    evaluate: Callable[[tuple[float, ...]], Candidate], best: Candidate, parameters: Sequence[Parameter]
) -> list[Tolerance]:
    """How far each parameter of a device may err until fewer orientations engage at the least friction."""
    found = []
    for k, parameter in enumerate(parameters):
        ends = []
        for steps in ([1.0 / step for step in STEPS], STEPS):
            held, fails = best.values[k], None
            for step in steps:
                value = parameter.moved(best.values[k], step)
                if value == held:
                    break
                values = (*best.values[:k], value, *best.values[k + 1 :])
                if evaluate(values).engaged[0] < best.engaged[0]:
                    fails = value
                    break
                held = value
            ends.append((held, fails))
        (low, below), (high, above) = ends
        found.append(Tolerance(parameter.name, best.values[k], low, high, below, above))
    return found


class _EnoughTriedError(Exception):
    """As many devices were tried as may be."""


def _cost(candidate: Candidate) -> float:
    """What DIRECT makes small: how many do not engage, and, less than one of them, the travel."""
    travel = candidate.tilt_deg / (1.0 + candidate.tilt_deg)
    return -float(sum(candidate.engaged)) - candidate.mean_critical + 0.5 * travel


def _critical(holds: Sequence[bool], frictions: Sequence[float]) -> float | None:
    """The largest of ascending frictions up to which all hold."""
    if not holds[0]:
        return None
    steps = pairwise(zip(frictions, holds, strict=True))
    return next((before for (before, _), (_, held) in steps if not held), frictions[-1])
