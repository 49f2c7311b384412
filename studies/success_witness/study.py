"""Random cells of success maps, each by the solver and by the witness of the oracle (docs/success-witness.md)."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np

from oracle.follow import Hand
from oracle.outcomes import STEP_DEG, End, followed_to_end
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.success.orientation_paths import OrientationPaths
from threadstate.thread.catalogue import quarter_twenty_unc

SEED = 2032
TILTS_DEG = tuple(float(tilt) for tilt in range(-4, 5))
PHASE_STEP_DEG = 15.0
FRICTIONS = (0.0, 0.1, 0.2, 0.3)
POINT_LIMIT = 1000


@dataclass(frozen=True)
class Compared:
    """A cell, its outcome by the solver, and its end and processor time (s) by the witness.

    The solver's is undecided where half its step leads to another one, as of a map's paths beside a boundary.
    ``halved`` is the witness's outcome with half its step, of cells in which the first one is not the solver's.
    """

    strategy: Strategy
    pose_deg: tuple[float, float, float]
    mu: float
    solver: str
    witness: End
    seconds: float
    halved: str | None = None

    @property
    def is_decided(self) -> bool:
        """Whether both have an outcome."""
        return "undecided" not in (self.solver, self.witness.outcome)

    @property
    def agrees(self) -> bool:
        """Whether both outcomes are one."""
        return self.solver == self.witness.outcome

    @property
    def is_decided_halved(self) -> bool:
        """Whether both have an outcome with half the witness's step."""
        return self.halved is not None and "undecided" not in (self.solver, self.halved)

    @property
    def agrees_halved(self) -> bool:
        """Whether both outcomes are one with half the witness's step alone."""
        return self.is_decided_halved and self.solver == self.halved


def cell(number: int) -> tuple[Strategy, tuple[float, float, float], float]:
    """Strategy, roll, pitch and phase (deg), and friction of the cell with a number."""
    choose = np.random.default_rng([SEED, number])
    roll, pitch = choose.choice(TILTS_DEG, 2)
    phase = PHASE_STEP_DEG * choose.integers(round(360.0 / PHASE_STEP_DEG))
    strategy = (Strategy.CCW_THEN_CW, Strategy.CW)[number % 2]
    return strategy, (float(roll), float(pitch), float(phase)), FRICTIONS[number // 2 % len(FRICTIONS)]


def done(number: int) -> Compared:
    """The cell with a number, computed by both."""
    strategy, pose_deg, mu = cell(number)
    pair = quarter_twenty_unc()
    device = default_device().in_unit(pair.unit)
    paths = OrientationPaths(pair, device, strategy, *pose_deg[:2], POINT_LIMIT, has_several=False)
    by_solver = paths.cell(pose_deg[2], mu)
    outcome = by_solver.outcome if paths.ends_alike(by_solver) else AssemblyOutcome.UNDECIDED
    hand = Hand(np.array(device.stiffness), device.centre, device.push)
    began = time.process_time()
    counter_deg = device.ccw_turn_deg if strategy is Strategy.CCW_THEN_CW else 0.0
    end, _ = followed_to_end(pair, hand, pose_deg, mu, counter_deg=counter_deg)
    compared = Compared(strategy, pose_deg, mu, outcome.value, end, time.process_time() - began)
    if compared.agrees or compared.solver == "undecided":
        return compared
    again, _ = followed_to_end(pair, hand, pose_deg, mu, counter_deg=counter_deg, step_deg=0.5 * STEP_DEG)
    return replace(compared, halved=again.outcome)
