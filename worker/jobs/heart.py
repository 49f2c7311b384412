"""A worker's heart: a thread that says that the worker lives, and takes those for dead that do not say so."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Event, Thread

from sqlalchemy import Engine
from sqlalchemy.exc import SQLAlchemyError

from threadstate.jobs.workers import LostLeaseError, beat, beats, remove_silent
from worker.jobs.watch import Watch
from worker.output import tell

BEATS_A_LEASE = 8


class Heart:
    """The heart of one worker; made by :func:`beating`."""

    def __init__(self, engine: Engine, worker_id: str, lease_s: float, file: Path | None) -> None:
        self._engine = engine
        self._worker_id = worker_id
        self._interval_s = lease_s / BEATS_A_LEASE
        self._watch = Watch(lease_s)
        self._file = file
        self._stopped = Event()
        self._lost: LostLeaseError | None = None

    def check(self) -> None:
        """Whether one counts as alive, as far as is known here.

        Raises:
            LostLeaseError: no.
        """
        if self._lost is not None:
            raise self._lost

    def beat_on(self) -> None:
        """Beat until stopped or lost; a database that is away is the worker's own to find out."""
        while not self._stopped.wait(self._interval_s):
            try:
                beat(self._engine, self._worker_id)
                if self._file is not None:
                    with suppress(OSError):
                        self._file.touch()
                for silent, count in self._watch.silent(beats(self._engine)):
                    if remove_silent(self._engine, silent, count):
                        tell(f"worker {silent} is silent; its chunks are free")
            except LostLeaseError as error:
                self._lost = error
                return
            except SQLAlchemyError:
                continue

    def stop(self) -> None:
        """Let :meth:`beat_on` return."""
        self._stopped.set()


@contextmanager
def beating(engine: Engine, worker_id: str, lease_s: float, file: Path | None = None) -> Iterator[Heart]:
    """A heart that beats while the context lasts, and touches ``file`` with every beat that the database has taken."""
    if file is not None:
        file.touch()
    heart = Heart(engine, worker_id, lease_s, file)
    thread = Thread(target=heart.beat_on, name="heart", daemon=True)
    thread.start()
    try:
        yield heart
    finally:
        heart.stop()
        with suppress(KeyboardInterrupt):
            thread.join()
