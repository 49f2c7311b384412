"""Pauses and file writes of both clients."""

from __future__ import annotations

import time
from typing import IO

import anyio
import anyio.to_thread


async def async_pause(seconds: float) -> None:
    """Wait asynchronously."""
    await anyio.sleep(seconds)


def pause(seconds: float) -> None:
    """Wait."""
    time.sleep(seconds)


async def async_write(file: IO[bytes], part: bytes) -> None:
    """Append to a file, in a worker thread."""
    await anyio.to_thread.run_sync(file.write, part)


def write(file: IO[bytes], part: bytes) -> None:
    """Append to a file."""
    file.write(part)
