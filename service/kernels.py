"""The kernels of the service: compiled by a separate process if necessary, while no request waits for it."""

from __future__ import annotations

import asyncio
import logging
import sys
from collections.abc import Sequence
from enum import StrEnum

from fastapi import Request
from fastapi.concurrency import run_in_threadpool

from threadstate.device.compile import load_turning, turning_is_compiled
from threadstate.errors import ThreadstateError
from threadstate.warm_up import kernels_are_compiled, load_kernels

COMPILE = (sys.executable, "-m", "threadstate.warm_up", "--serving")
"""Compiles the kernels into the cache of this machine."""
COMPILE_ALL = (sys.executable, "-m", "threadstate.warm_up")
"""Compiles those of bolts that are turned as well, which takes longer: when they are asked for."""

_log = logging.getLogger(__name__)


class KernelsCompilingError(ThreadstateError):
    """A pose cannot be solved while the kernels are being compiled."""


class KernelState(StrEnum):
    """Whether poses can be solved."""

    COMPILING = "compiling"
    READY = "ready"


class Kernels:
    """Whether the kernels can be used.

    Without a call of :meth:`run` they can from the start: the first request that solves loads them.
    """

    def __init__(self) -> None:
        self.state = KernelState.READY
        self.turning = KernelState.READY
        self._settled = asyncio.Event()
        self._turning_wanted = asyncio.Event()

    async def run(self) -> None:
        """Load the kernels into this process, once; a separate process compiles them if the cache lacks them.

        Those of bolts that are turned are loaded after all others, or compiled after the first request for them.
        """
        if not turning_is_compiled():
            self.turning = KernelState.COMPILING
        await self._load()
        if self.turning is KernelState.COMPILING:
            await self._turning_wanted.wait()
            try:
                await _compile(COMPILE_ALL)
            finally:
                self.turning = KernelState.READY
        else:
            await self._load_turning()

    def want_turning(self) -> None:
        """Have the kernels of bolts that are turned compiled, if they are not."""
        self._turning_wanted.set()

    async def _load(self) -> None:
        try:
            if not kernels_are_compiled():
                self.state = KernelState.COMPILING
                _log.info("the kernels are being compiled; what is to be solved meanwhile is refused")
                await _compile(COMPILE)
            await run_in_threadpool(load_kernels)
        except Exception:
            _log.exception("the kernels could not be loaded; the first request that solves tries again")
        finally:
            self.state = KernelState.READY
            self._settled.set()

    async def _load_turning(self) -> None:
        try:
            await run_in_threadpool(load_turning)
        except Exception:
            _log.exception("the kernels of bolts that are turned could not be loaded; the first path tries again")

    async def settled(self) -> None:
        """Wait until :meth:`run` has loaded what serving needs."""
        await self._settled.wait()


def kernels_of(request: Request) -> Kernels:
    """The application's."""
    kernels: Kernels = request.app.state.kernels
    return kernels


async def require_kernels(request: Request) -> None:
    """Reject a request that solves while the kernels are being compiled.

    Raises:
        KernelsCompilingError: the kernels are being compiled.
    """
    if kernels_of(request).state is KernelState.COMPILING:
        raise KernelsCompilingError(
            "the kernels are being compiled, once on this machine, for one to two minutes; what is stored is answered"
        )


async def require_turning(request: Request) -> None:
    """Reject a request that turns a bolt while the kernels for that are being compiled, and have them compiled.

    Raises:
        KernelsCompilingError: the kernels are being compiled.
    """
    kernels = kernels_of(request)
    if kernels.turning is KernelState.COMPILING:
        kernels.want_turning()
        raise KernelsCompilingError(
            "the kernels of bolts that are turned are being compiled, once on this machine, for one to two minutes"
        )


async def _compile(command: Sequence[str]) -> None:
    process = await asyncio.create_subprocess_exec(*command, stdout=asyncio.subprocess.DEVNULL)
    try:
        code = await process.wait()
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()
    if code != 0:
        _log.error("the process that compiles the kernels ended with code %d; they are compiled in this one", code)
