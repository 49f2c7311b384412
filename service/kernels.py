"""The kernels of a process that serves: a process of its own compiles them if need be, and no request waits for it."""

from __future__ import annotations

import asyncio
import logging
import sys
from enum import StrEnum

from fastapi import Request
from fastapi.concurrency import run_in_threadpool

from threadstate.errors import ThreadstateError
from threadstate.warm_up import kernels_are_compiled, load_kernels

COMPILE = (sys.executable, "-m", "threadstate.warm_up")
"""Compiles the kernels into the cache of this machine."""

_log = logging.getLogger(__name__)


class KernelsCompilingError(ThreadstateError):
    """Something was to be solved while the kernels are being compiled."""


class KernelState(StrEnum):
    """Whether poses can be solved."""

    COMPILING = "compiling"
    READY = "ready"


class Kernels:
    """Whether the kernels can be used; :meth:`run` sees to it that they can.

    They can from the beginning where it is not called: the first request that solves loads them then.
    """

    def __init__(self) -> None:
        self.state = KernelState.READY
        self._settled = asyncio.Event()

    async def run(self) -> None:
        """Load the kernels into this process, compiled by another one where the cache has none, once."""
        try:
            if not kernels_are_compiled():
                self.state = KernelState.COMPILING
                _log.info("the kernels are being compiled; what is to be solved meanwhile is refused")
                await _compile()
            await run_in_threadpool(load_kernels)
        except Exception:
            _log.exception("the kernels could not be loaded; the first request that solves tries again")
        finally:
            self.state = KernelState.READY
            self._settled.set()

    async def settled(self) -> None:
        """Wait until :meth:`run` has ended."""
        await self._settled.wait()


def kernels_of(request: Request) -> Kernels:
    """The application's."""
    kernels: Kernels = request.app.state.kernels
    return kernels


async def require_kernels(request: Request) -> None:
    """Let a request pass that solves, unless it would have to wait for the compiler.

    Raises:
        KernelsCompilingError: it would.
    """
    if kernels_of(request).state is KernelState.COMPILING:
        raise KernelsCompilingError(
            "the kernels are being compiled, once on this machine, for a minute or two; what is stored is answered"
        )


async def _compile() -> None:
    process = await asyncio.create_subprocess_exec(*COMPILE, stdout=asyncio.subprocess.DEVNULL)
    try:
        code = await process.wait()
    finally:
        if process.returncode is None:
            process.kill()
    if code != 0:
        _log.error("the process that compiles the kernels ended with code %d; they are compiled in this one", code)
