"""A path that a thread computes: seen from the event loop, and stopped when nobody waits for it any more."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass

import anyio
from fastapi.concurrency import run_in_threadpool

from threadstate.device.watch import PathStoppedError, PathWatch

LOOK_S = 0.1
"""How often it is seen how far a path is, and whether its client is there."""
STOP_S = 0.01
"""How often a path is told to stop until it has."""


@dataclass(frozen=True)
class RunningPath:
    """A path that a thread computes: its watch, and the task that ends with its document as JSON."""

    watch: PathWatch
    task: asyncio.Task[str]

    async def has_ended(self) -> bool:
        """Whether it has ended; waits for that as long as between two looks."""
        await asyncio.wait((self.task,), timeout=LOOK_S)
        return self.task.done()


@asynccontextmanager
async def running_path(compute: Callable[[PathWatch], str]) -> AsyncIterator[RunningPath]:
    """A path that is computed meanwhile, and stopped if it has not ended at the end of the block."""
    watch = PathWatch()
    path = RunningPath(watch, asyncio.create_task(run_in_threadpool(compute, watch)))
    try:
        yield path
    finally:
        if not path.task.done():
            with anyio.CancelScope(shield=True):
                await _stop(path)


async def _stop(path: RunningPath) -> None:
    """Wait until a path has stopped, also where this is cancelled: until then its thread computes."""
    cancelled = False
    while not path.task.done():
        path.watch.stop()
        try:
            await asyncio.wait((path.task,), timeout=STOP_S)
        except asyncio.CancelledError:
            cancelled = True
    error = path.task.exception()
    if error is not None and not isinstance(error, PathStoppedError):
        raise error
    if cancelled:
        raise asyncio.CancelledError
