"""Along the phase: where the contacts can hold a load or wedge at a friction, and where that begins and ends.

Within an interval of a history the least frictions are continuous functions of phase. They are looked at every degree,
and at their extrema in between; each change of the verdict is then enclosed by halving.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from threadstate.contact import _record_kernel as rk
from threadstate.errors import UnresolvedPoseError
from threadstate.state.decode import decoded_states
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics.load import Load
from threadstate.statics.rows import statics_rows
from threadstate.statics.solve import statics_of
from threadstate.statics.verdict import FrictionBounds, Verdict, verdict_at
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

STEP_DEG = 1.0
CERTAIN_DEG = 1e-9
"""A change of the verdict is enclosed to this width, unless the verdict is undecided in between."""
POINT_DEG = 1e-6
"""A verdict that holds over less phase belongs to the change there, as labels of a history do; so near its ends an
interval is not looked at."""
EXTREMUM_STEPS = 24
"""Halvings, by the golden ratio, of the interval about an extremum of a least friction."""

_GOLDEN = (math.sqrt(5.0) - 1.0) / 2.0

_HOLD, _WEDGE = nk.N_HOLD + 1, nk.N_WEDGE + 1


@dataclass(frozen=True, slots=True)
class Stretch:
    """Phases of one interval at which the verdict at a friction is the same.

    From ``start_deg`` to ``end_deg``, which is larger; both as the interval's. ``uncertainty_deg`` is the width of what
    encloses the start, 0 where the interval begins there.
    """

    start_deg: float
    end_deg: float
    verdict: Verdict
    uncertainty_deg: float


class LoadedOrientation:
    """The least frictions of an orientation (degrees) under a load, each phase solved once."""

    def __init__(
        self, pair: Pair, options: SolveOptions, roll_deg: float, pitch_deg: float, load: Load | None = None
    ) -> None:
        self._pair, self._options, self._load = pair, options, load or Load()
        self.tilt_deg = (roll_deg, pitch_deg)
        self._rows: dict[float, Floats] = {}

    def rows(self, phases_deg: Sequence[float]) -> Floats:
        """Rows of shape (n, NUMBERS_SIZE), as ``_numbers_kernel`` lays them out; NaN where nothing is known."""
        new = sorted({phase % 360.0 for phase in phases_deg} - self._rows.keys())
        if new:
            self._rows.update(zip(new, self._solved(np.array([(*self.tilt_deg, phase) for phase in new])), strict=True))
        return np.array([self._rows[phase % 360.0] for phase in phases_deg]).reshape(-1, nk.NUMBERS_SIZE)

    def _solved(self, poses_deg: Floats) -> Floats:
        records = solve_records(self._pair, self._options, poses_deg)
        rows = np.full((len(records), nk.NUMBERS_SIZE), math.nan)
        known = np.flatnonzero(records[:, rk.O_STATUS] == 0.0)
        rows[known] = statics_rows(self._pair, records[known], self._load)
        for i in known[rows[known, nk.N_STATUS] == nk.OPEN_PATCH]:
            (state,) = decoded_states(self._pair, self._options, poses_deg[i : i + 1], records[i : i + 1])
            try:
                hold = statics_of(self._pair, state, self._load).hold
            except UnresolvedPoseError:
                continue
            rows[i, nk.N_HOLD : _HOLD + 1] = hold.lower, hold.upper
        return rows

    def verdicts(self, phases_deg: Sequence[float], mu: float) -> list[Verdict]:
        """The verdicts at a friction; undecided where a pose is."""
        return [_verdict(row, mu) for row in self.rows(phases_deg)]

    def stretches(self, intervals: Sequence[tuple[float, float]], mu: float) -> list[list[Stretch]]:
        """The stretches of each interval (start and end in degrees, the end larger), in order of phase.

        A verdict that holds nowhere at a look and between two of them, over less than ``STEP_DEG`` and not about an
        extremum of a least friction, is not found.
        """
        looks = [_looks(start, end) for start, end in intervals]
        self.rows([phase for of_interval in looks for phase in of_interval])
        looks = [sorted({*of_interval, *self._extrema(of_interval, mu)}) for of_interval in looks]
        changes = self._enclosed([pair for of_interval in looks for pair in pairwise(of_interval)], mu)
        return [
            self._cut(start, end, of_interval, changes, mu)
            for (start, end), of_interval in zip(intervals, looks, strict=True)
        ]

    def _extrema(self, phases: list[float], mu: float) -> list[float]:
        """Phases of extrema between looks, where a least friction may reach ``mu`` without doing so at a look."""
        found = []
        rows = self.rows(phases)
        for column in (_HOLD, _WEDGE):
            values = rows[:, column] - mu
            for i in range(1, len(phases) - 1):
                before, here, after = values[i - 1 : i + 2]
                sign = math.copysign(1.0, here)
                if not (np.isfinite([before, here, after]).all() and before * sign > 0.0 and after * sign > 0.0):
                    continue
                nearest = sign * here <= min(sign * before, sign * after)
                if nearest and abs(here) < abs(before - here) + abs(after - here):
                    found.append(self._extremum(phases[i - 1], phases[i + 1], column, sign))
        return found

    def _extremum(self, low: float, high: float, column: int, sign: float) -> float:
        """The phase of the least value of ``sign`` times a column of the rows, by golden section."""
        inner = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
        values = [float(value) for value in sign * self.rows(inner)[:, column]]
        for _ in range(EXTREMUM_STEPS):
            if values[0] < values[1]:
                high, inner[1], values[1] = inner[1], inner[0], values[0]
                inner[0] = high - _GOLDEN * (high - low)
                values[0] = float(sign * self.rows(inner[:1])[0, column])
            else:
                low, inner[0], values[0] = inner[0], inner[1], values[1]
                inner[1] = low + _GOLDEN * (high - low)
                values[1] = float(sign * self.rows(inner[1:])[0, column])
        return inner[0] if values[0] < values[1] else inner[1]

    def _enclosed(self, brackets: list[tuple[float, float]], mu: float) -> list[tuple[float, float]]:
        """The changes of the verdict between two phases each, enclosed; all are halved together."""
        found = []
        while brackets:
            ends = self.verdicts([phase for bracket in brackets for phase in bracket], mu)
            differing = [one for i, one in enumerate(brackets) if ends[2 * i] is not ends[2 * i + 1]]
            found += [one for one in differing if not one[1] - one[0] > CERTAIN_DEG]
            halved = [(low, low + 0.5 * (high - low), high) for low, high in differing if high - low > CERTAIN_DEG]
            self.rows([middle for _, middle, _ in halved])
            brackets = [part for low, middle, high in halved for part in ((low, middle), (middle, high))]
        return sorted(found)

    def _cut(
        self, start: float, end: float, looks: list[float], changes: list[tuple[float, float]], mu: float
    ) -> list[Stretch]:
        inside = [one for one in changes if looks[0] <= one[0] and one[1] <= looks[-1]]
        # A verdict that holds between two changes over less than a point belongs to both of them.
        events: list[tuple[float, float]] = []
        for low, high in inside:
            if events and low - events[-1][1] < POINT_DEG:
                events[-1] = (events[-1][0], high)
            else:
                events.append((low, high))
        cuts = [(start, start), *events, (end, end)]
        found: list[Stretch] = []
        for begins, ends in cuts[:-1]:
            at = 0.5 * (begins + ends)
            (verdict,) = self.verdicts([ends if begins != ends else looks[0]], mu)
            if found and found[-1].verdict is verdict:
                found[-1] = Stretch(found[-1].start_deg, 0.0, verdict, found[-1].uncertainty_deg)
            else:
                found.append(Stretch(at, 0.0, verdict, ends - begins))
        ends_at = [one.start_deg for one in found[1:]] + [end]
        return [
            Stretch(one.start_deg, until, one.verdict, one.uncertainty_deg)
            for one, until in zip(found, ends_at, strict=True)
        ]


def _verdict(row: Floats, mu: float) -> Verdict:
    if math.isnan(row[nk.N_HOLD]):
        return Verdict.UNDECIDED
    hold = FrictionBounds(row[nk.N_HOLD], row[_HOLD])
    return verdict_at(mu, hold, FrictionBounds(row[nk.N_WEDGE], row[_WEDGE]))


def _looks(start: float, end: float) -> list[float]:
    """Phases of an interval: near its ends, and every degree between."""
    inset = min(POINT_DEG, (end - start) / 4.0)
    low, high = start + inset, end - inset
    between = STEP_DEG * np.arange(math.ceil(low / STEP_DEG), math.floor(high / STEP_DEG) + 1)
    return sorted({low, *between.tolist(), high})
