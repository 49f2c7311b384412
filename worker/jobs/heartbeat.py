"""The heartbeat of a worker: a thread that increments its counter, and removes workers whose counter stopped."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Thread

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from threadstate.jobs.workers import LostLeaseError, beat, beats, remove_dead_worker
from worker.output import print_status

BEATS_PER_LEASE = 8


class Heartbeat:
    """The heartbeat of one worker; made by :func:`heartbeat`."""

    def __init__(self, engine: Engine, worker_id: str, lease_s: float, file: Path | None) -> None:
        self._engine = engine
        self._worker_id = worker_id
        self._interval_s = lease_s / BEATS_PER_LEASE
        self._detector = SilenceDetector(lease_s)
        self._file = file
        self._stopped = Event()
        self._lost: LostLeaseError | None = None

    def check(self) -> None:
        """Check that the worker is alive, as far as this process knows.

        Raises:
            LostLeaseError: the worker was considered dead.
        """
        if self._lost is not None:
            raise self._lost

    def run(self) -> None:
        """Send heartbeats until stopped or lost; errors of the database are left to the worker's loop."""
        while not self._stopped.wait(self._interval_s):
            try:
                beat(self._engine, self._worker_id)
                if self._file is not None:
                    with suppress(OSError):
                        self._file.touch()
                for silent, count in self._detector.silent(beats(self._engine)):
                    if remove_dead_worker(self._engine, silent, count):
                        print_status(f"worker {silent} sends no heartbeat; its chunks are free")
            except LostLeaseError as error:
                self._lost = error
                return
            except SQLAlchemyError:
                continue

    def stop(self) -> None:
        """Make :meth:`run` return."""
        self._stopped.set()


@contextmanager
def heartbeat(engine: Engine, worker_id: str, lease_s: float, file: Path | None = None) -> Iterator[Heartbeat]:
    """Heartbeats while the context lasts; ``file`` is touched after each one that the database has accepted."""
    if file is not None:
        file.touch()
    beats_of_worker = Heartbeat(engine, worker_id, lease_s, file)
    thread = Thread(target=beats_of_worker.run, name="heartbeat", daemon=True)
    thread.start()
    try:
        yield beats_of_worker
    finally:
        beats_of_worker.stop()
        thread.join()


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
