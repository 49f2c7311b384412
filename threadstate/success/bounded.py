"""Paths that are not followed beyond a limit of points: how a path ends, or that it has more."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Event, Thread

from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath
from threadstate.device.branches import KnownPaths
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.device.watch import PathStoppedError, PathWatch, RunningLeg
from threadstate.success.model import Cell
from threadstate.thread.pair import Pair

LOOK_S = 0.02
"""How often a path is looked at. What is found does not depend on it, only how soon a path ends that passes the limit.
"""


class BoundedWatch(PathWatch):
    """A watch that ends a path of which one leg has more points than a limit, or that takes longer than a time.

    A leg only gains points. One that was stopped beyond the limit and one that was not looked at in time therefore end
    alike: without a time the outcome does not depend on time.
    """

    def __init__(self, point_limit: int, time_limit_s: float = math.inf) -> None:
        super().__init__()
        self._point_limit = point_limit
        self._ends_s = time.monotonic() + time_limit_s
        self._leg: RunningLeg | None = None

    @property
    def is_over(self) -> bool:
        """Whether the leg that is followed, or was last, has more points than the limit, or the time has passed."""
        if time.monotonic() > self._ends_s:
            return True
        return self._leg is not None and self._leg.reached()[0] > self._point_limit

    def begin_leg(self, leg: RunningLeg) -> None:
        """A kernel is about to follow a leg."""
        self._leg = leg
        super().begin_leg(leg)

    def end_leg(self) -> None:
        """The kernel has returned.

        Raises:
            PathStoppedError: the leg has more points than the limit, or the time has passed.
        """
        if self.is_over:
            raise PathStoppedError("the path has more points than its limit, or takes longer")
        super().end_leg()

    @contextmanager
    def looking(self) -> Iterator[None]:
        """Another thread looks at the path while the context lasts."""
        ended = Event()
        thread = Thread(target=self._look, args=(ended,), daemon=True)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()

    def _look(self, ended: Event) -> None:
        while not ended.wait(LOOK_S):
            if self.is_over:
                self.stop()


def bounded_cell(
    pair: Pair,
    device: Device,
    strategy: Strategy,
    pose_deg: tuple[float, float, float],
    mu: float,
    point_limit: int,
    longest_step_deg: float | None = None,
    known: KnownPaths | None = None,
    time_limit_s: float = math.inf,
) -> Cell:
    """The cell of the path from a commanded pose (roll, pitch, phase in degrees) at a friction.

    ``longest_step_deg`` is the path's longest step; None: that of :func:`threadstate.device.assemble.assemble_pose`, as
    are the ``known`` paths. A path that takes more than ``time_limit_s`` seconds is bounded, too.

    Raises:
        InvalidValueError: as :func:`threadstate.device.assemble.assemble_pose`.
    """
    watch = BoundedWatch(point_limit, time_limit_s)
    phase_deg = pose_deg[2]
    try:
        with watch.looking():
            path = assemble_pose(
                pair, *pose_deg, device, strategy, mu=mu, longest_step=longest_step_deg, watch=watch, known=known
            )
    except PathStoppedError:
        return Cell(phase_deg, mu, AssemblyOutcome.UNDECIDED, (), True, None, None, None, None)
    return cell_of(path)


def cell_of(path: AssemblyPath) -> Cell:
    """The cell of a path that was followed to its end."""
    travel = path.travel
    return Cell(
        path.start.phase_deg,
        path.mu,
        path.outcome,
        path.flags,
        False,
        None if travel is None else travel.torque,
        None if travel is None else travel.tilt_deg,
        None if travel is None else travel.shift,
        path.points[-1].phase_deg if path.points else None,
    )
