"""SIGTERM and Ctrl-C of a worker: they end its waits, and what else it does is done to its end first.

An exception out of a signal's handler may come between any two instructions: raised in the pool of connections it
leaves the pool's lock taken, on which the thread of the heartbeat then waits forever.
"""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


class _Interruption:
    requested = False
    waiting = False

    def handle(self, _signal: int, _frame: object) -> None:
        self.requested = True
        if self.waiting:
            raise KeyboardInterrupt


_interruption = _Interruption()


@contextmanager
def interruptible_at_waits() -> Iterator[None]:
    """While it lasts SIGTERM and SIGINT raise ``KeyboardInterrupt`` inside of :func:`waiting` alone: at once if the
    process waits, otherwise when it is about to. For the main thread.
    """
    _interruption.requested = False
    before = {number: signal.signal(number, _interruption.handle) for number in (signal.SIGTERM, signal.SIGINT)}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def waiting() -> Iterator[None]:
    """A wait that holds no lock.

    Raises:
        KeyboardInterrupt: in :func:`interruptible_at_waits`, if the process was told to stop before or in it.
    """
    _interruption.waiting = True
    try:
        if _interruption.requested:
            raise KeyboardInterrupt
        yield
    finally:
        _interruption.waiting = False
