"""What takes time besides the network, for either client: pauses, and writing to a file."""

from __future__ import annotations

import time
from typing import IO

import anyio
import anyio.to_thread


async def async_pause(seconds: float) -> None:
    """Let other tasks run for so long."""
    await anyio.sleep(seconds)


def pause(seconds: float) -> None:
    """Stand still for so long."""
    time.sleep(seconds)


async def async_write(file: IO[bytes], part: bytes) -> None:
    """Append to a file, in a thread of its own."""
    await anyio.to_thread.run_sync(file.write, part)


def write(file: IO[bytes], part: bytes) -> None:
    """Append to a file."""
    file.write(part)
