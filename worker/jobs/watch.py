"""Finding out who is silent, by a steady clock of one's own and counts alone."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class _Seen:
    beat: int
    since_s: float


class Watch:
    """Remembers when each count was seen first.

    No clock but the watcher's own is read, and that one only goes forward: setting clocks, back or forth, on this
    machine or another, changes nothing.
    """

    def __init__(self, lease_s: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._lease_s = lease_s
        self._clock = clock
        self._seen: dict[str, _Seen] = {}
        self._looked_s = clock()

    def silent(self, beats: Mapping[str, int]) -> list[tuple[str, int]]:
        """Those whose count has stood still for longer than the lease, with that count.

        A watcher that has not looked itself for half a lease (it was stopped, or the database was away) begins anew:
        the others may not have been able to count either.
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
