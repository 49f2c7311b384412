"""Paths while they are followed: how far they are, and how they are stopped from another thread.

A kernel follows a leg of a path at once, without the interpreter's lock, in arrays that are made before. Another thread
reads them, and stops the leg by a number that the kernel compares at every step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

from threadstate.device.assembly_model import PathEvent
from threadstate.errors import ThreadstateError


class PathStoppedError(ThreadstateError):
    """The path was stopped before its end."""


@dataclass(frozen=True, slots=True)
class PathProgress:
    """How far a path is.

    ``leg`` is the number of its current turn, 0 while the bolt settles; ``points`` how many points that one has, and
    ``phase_deg`` the phase of the last one, None without any; ``events`` are those of all turns. With friction the
    events of a turn are known at its end.
    """

    leg: int
    points: int
    phase_deg: float | None
    events: tuple[PathEvent, ...]


class RunningLeg(Protocol):
    """A leg that a kernel follows."""

    def reached(self) -> tuple[int, float | None]:
        """How many points it has, and the phase of the last one in degrees."""

    def events(self, phase_deg: float | None) -> list[PathEvent]:
        """The events up to a phase that it has reached."""

    def stop(self) -> None:
        """Have the kernel end it."""


class PathWatch:
    """A path as another thread sees it. The thread that follows it calls the methods that begin and end parts of it."""

    def __init__(self) -> None:
        # Replaced as a whole, so that what another thread reads belongs together.
        self._seen: tuple[int, RunningLeg | None, tuple[PathEvent, ...]] = (0, None, ())
        self._followed: PathProgress | None = None
        self._stopped = False

    def progress(self) -> PathProgress:
        """How far the path is now."""
        if self._followed is not None:
            return self._followed
        turn, leg, events = self._seen
        if leg is None:
            return PathProgress(turn, 0, None, events)
        points, phase_deg = leg.reached()
        return PathProgress(turn, points, phase_deg, (*events, *leg.events(phase_deg)))

    def stop(self) -> None:
        """Have the path end by :class:`PathStoppedError`; to be repeated until it has.

        A leg that begins, or counts, at the same moment may miss it once.
        """
        self._stopped = True
        _, leg, _ = self._seen
        if leg is not None:
            leg.stop()

    def begin_turn(self) -> None:
        """A turn begins."""
        turn, _, events = self._seen
        self._seen = (turn + 1, None, events)

    def begin_leg(self, leg: RunningLeg) -> None:
        """A kernel is about to follow a leg.

        Raises:
            PathStoppedError: the path was stopped.
        """
        self._check()
        turn, _, events = self._seen
        self._seen = (turn, leg, events)

    def end_leg(self) -> None:
        """The kernel has returned.

        Raises:
            PathStoppedError: the path was stopped.
        """
        self._check()

    def end_turn(self, events: Sequence[PathEvent]) -> None:
        """A turn has ended; ``events`` are those of the path up to here."""
        turn, _, _ = self._seen
        self._seen = (turn, None, tuple(events))

    def begin_confirmation(self) -> None:
        """The path has been followed, and is about to be once more: what is seen of it stays as it is."""
        self._followed = self.progress()

    def _check(self) -> None:
        if self._stopped:
            raise PathStoppedError("the path was stopped before its end")
