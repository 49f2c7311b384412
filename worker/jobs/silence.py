"""Detection of dead workers by their heartbeat counters and a local monotonic clock."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class _Seen:
    beat: int
    since_s: float


class SilenceDetector:
    """Remembers when each counter value was first seen.

    Reads a monotonic clock of this process alone: setting the clock of any machine has no effect.
    """

    def __init__(self, lease_s: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._lease_s = lease_s
        self._clock = clock
        self._seen: dict[str, _Seen] = {}
        self._looked_s = clock()

    def silent(self, beats: Mapping[str, int]) -> list[tuple[str, int]]:
        """The workers whose counter has not changed for longer than the lease, with the counter.

        A detector that was not called for half a lease (the process was stopped, or the database was unreachable)
        starts
        again: the other workers may not have been able to send heartbeats either.
        """
        now_s = self._clock()
        if now_s - self._looked_s > 0.5 * self._lease_s:
            self._seen = {}
        self._looked_s = now_s
        before = self._seen
        self._seen = {
            one: before[one] if one in before and before[one].beat == beat else _Seen(beat, now_s)
            for one, beat in beats.items()
        }
        return [(one, seen.beat) for one, seen in self._seen.items() if now_s - seen.since_s > self._lease_s]
