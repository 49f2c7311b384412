"""How the paths of one orientation end, and which of them others go on as."""

from __future__ import annotations

import math
import time
from collections import defaultdict
from dataclasses import dataclass, field

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.branches import KnownPaths
from threadstate.device.command import LONGEST_STEP_DEG, LONGEST_STEP_WITH_FRICTION_DEG
from threadstate.device.model import Device
from threadstate.device.strategy import CLOCKWISE_DEG, Strategy
from threadstate.success.bounded import bounded_cell
from threadstate.success.model import Cell
from threadstate.thread.pair import Pair


@dataclass
class OrientationPaths:
    """The paths of one orientation (deg), each with at most ``point_limit`` points in a turn.

    Where they start from several phases (``has_several``) a path with friction goes on as an earlier one does that it
    comes to, and that ends alike with half the step.
    """

    pair: Pair
    device: Device
    strategy: Strategy
    roll_deg: float
    pitch_deg: float
    point_limit: int
    has_several: bool
    _known: defaultdict[float, KnownPaths] = field(default_factory=lambda: defaultdict(KnownPaths), init=False)
    _alike: dict[tuple[float, float], bool] = field(default_factory=dict, init=False)

    def cell(self, phase_deg: float, mu: float, time_limit_s: float = math.inf) -> Cell:
        """How the path from a phase at a friction ends.

        One that others would go on as, and that ends otherwise with half the step, is undecided; so is a single one
        with friction that snaps in the last step of its turn. A path that takes more than ``time_limit_s`` seconds is
        bounded; one of which half the step would is not gone on as.
        """
        ends_s = time.monotonic() + time_limit_s
        known = self._known[mu] if self.has_several else None
        count = len(known or ())
        cell = self._bounded(phase_deg, mu, self.point_limit, None, known, time_limit_s)
        is_asked = self._snaps_last(cell) if known is None else len(known) > count
        if not is_asked:
            return cell
        is_alike = self.ends_alike(cell, ends_s - time.monotonic())
        is_late = time.monotonic() > ends_s
        if known is not None and (is_late or not is_alike):
            known.forget_last()
        return cell if is_late or is_alike else cell.step_dependent()

    def ends_alike(self, cell: Cell, time_limit_s: float = math.inf) -> bool:
        """Whether a path ends as its cell says when it is followed alone with half the step, in the time it has."""
        key = (cell.phase_deg, cell.mu)
        if key not in self._alike:
            longest_deg = LONGEST_STEP_WITH_FRICTION_DEG if cell.mu > 0.0 else LONGEST_STEP_DEG
            again = self._bounded(*key, 2 * self.point_limit, 0.5 * longest_deg, None, time_limit_s)
            self._alike[key] = again.outcome is cell.outcome
        return self._alike[key]

    def _snaps_last(self, cell: Cell) -> bool:
        """Whether a path with friction has snapped within a step of the end of the turn in which it may."""
        if self.strategy is not Strategy.CCW_THEN_CW or cell.end_deg is None or not cell.mu > 0.0:
            return False
        turned_deg = math.copysign(1.0, self.pair.lead) * (cell.end_deg - cell.phase_deg) + CLOCKWISE_DEG
        left_deg = self.device.ccw_turn_deg - turned_deg
        return cell.outcome is not AssemblyOutcome.NO_SNAP and 0.0 <= left_deg < LONGEST_STEP_WITH_FRICTION_DEG

    def _bounded(
        self,
        phase_deg: float,
        mu: float,
        point_limit: int,
        longest_step_deg: float | None,
        known: KnownPaths | None,
        time_limit_s: float,
    ) -> Cell:
        pose_deg = (self.roll_deg, self.pitch_deg, phase_deg)
        of = (self.pair, self.device, self.strategy)
        return bounded_cell(*of, pose_deg, mu, point_limit, longest_step_deg, known, time_limit_s)
