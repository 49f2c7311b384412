"""The renditions at hand: opened where they are there, made in the background where they are not."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import os
import sys
from collections import OrderedDict
from functools import cache
from pathlib import Path

from fastapi.concurrency import run_in_threadpool

import service.renditions.file
import threadstate.state.document
from service.renditions.file import Rendition, RenditionError, partial_path
from threadstate.library.read import LibraryRecord
from threadstate.settings import DATABASE

STATE_BYTES = 3000
"""What a state takes, about."""
MOST_OPEN = 16
MEGABYTE = 10**6

_log = logging.getLogger(__name__)


class RenditionShelf:
    """Renditions in a folder, bounded in bytes; the one that was opened longest ago goes first.

    A file is named by the content of its library and by the code that writes it: it is never out of date. Where it
    cannot be written, or is damaged, answers are made from the tables.
    """

    def __init__(self, folder: Path, database: str, room_mb: int) -> None:
        self._folder = folder
        self._database = database
        self._room = room_mb * MEGABYTE
        self._open: OrderedDict[str, Rendition] = OrderedDict()
        self._given_up: set[str] = set()
        self._making: asyncio.Task[None] | None = None

    def get(self, library: LibraryRecord) -> Rendition | None:
        """The rendition of a library, if it is at hand; if not it will be, unless that was tried in vain.

        Does not wait. To be called within the service's event loop.
        """
        found = self._open.get(library.content_sha256)
        if found is not None:
            self._open.move_to_end(library.content_sha256)
        elif self._making is None and self._may_have(library):
            self._making = asyncio.create_task(self._fetch(library))
        return found

    async def settled(self) -> None:
        """Wait for what is being made."""
        if self._making is not None:
            await self._making

    async def close(self) -> None:
        """Leave what is being made."""
        if self._making is not None:
            self._making.cancel()
            await asyncio.gather(self._making, return_exceptions=True)

    def _may_have(self, library: LibraryRecord) -> bool:
        size = library.grid.state_count * STATE_BYTES
        return size <= self._room and library.content_sha256 not in self._given_up

    async def _fetch(self, library: LibraryRecord) -> None:
        path = self._folder / f"{library.content_sha256}-{writer_sha256()[:12]}.states"
        try:
            rendition = await run_in_threadpool(_opened, path)
            if rendition is None:
                self._folder.mkdir(parents=True, exist_ok=True)
                await self._make(library.id, path)
                await run_in_threadpool(_make_room, self._folder, self._room, path)
                rendition = await run_in_threadpool(_opened, path)
            if rendition is None:
                raise RenditionError(f"{path} was not made")
            self._open[library.content_sha256] = rendition
            while len(self._open) > MOST_OPEN:
                self._open.popitem(last=False)
        except (OSError, RenditionError) as error:
            self._given_up.add(library.content_sha256)
            _log.warning("library %d is answered from its tables: %s", library.id, error)
        finally:
            self._making = None

    async def _make(self, library_id: int, path: Path) -> None:
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "service.renditions.build", str(library_id), str(path)),
            env={**os.environ, DATABASE: self._database},
            stdout=asyncio.subprocess.DEVNULL,
            stderr=asyncio.subprocess.PIPE,
        )
        try:
            _, said = await process.communicate()
        except asyncio.CancelledError:
            process.kill()
            await process.wait()
            partial_path(path, process.pid).unlink(missing_ok=True)
            raise
        if process.returncode:
            lines = said.decode(errors="replace").strip().splitlines()
            raise RenditionError(lines[-1] if lines else f"ended with {process.returncode}")


def _opened(path: Path) -> Rendition | None:
    """The rendition in a file; None where there is none, or a damaged one, which is removed."""
    try:
        rendition = Rendition(path)
        path.touch()
    except FileNotFoundError:
        return None
    except RenditionError:
        path.unlink(missing_ok=True)
        return None
    return rendition


def _make_room(folder: Path, room: int, latest: Path) -> None:
    """Remove the files that were opened longest ago, as many as there are too many."""
    files = sorted(folder.glob("*.states"), key=lambda file: file.stat().st_mtime, reverse=True)
    files.remove(latest)
    left = room - latest.stat().st_size
    for file in files:
        left -= file.stat().st_size
        if left < 0:
            file.unlink(missing_ok=True)


@cache
def writer_sha256() -> str:
    """SHA-256, in hexadecimal, of the code that writes renditions."""
    digest = hashlib.sha256()
    for module in (threadstate.state.document, service.renditions.file):
        digest.update(Path(str(module.__file__)).read_bytes())
    return digest.hexdigest()
