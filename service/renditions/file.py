"""The file of a rendition: every state of a library as JSON, in order, each followed by a comma.

Eight bytes that say what it is, the SHA-256 of all that follows, the number of ordinals, one offset more than that
(64 bits each, as this machine has them), and the text. An undecided pose has no text. A state is a slice, and so is
a history.
"""

from __future__ import annotations

import hashlib
import json
import mmap
import os
from array import array
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import BinaryIO

from threadstate.errors import ThreadstateError
from threadstate.state.document import StateDocument

_MAGIC = b"tsrend01"
_HASHED_FROM = len(_MAGIC) + hashlib.sha256().digest_size
_HEAD = _HASHED_FROM + 8


class RenditionError(ThreadstateError):
    """A file that is no whole rendition."""


class Rendition:
    """A rendition, mapped into memory: what is read often stays there, shared by all processes that serve it."""

    def __init__(self, path: Path) -> None:
        with path.open("rb") as file:
            if os.fstat(file.fileno()).st_size < _HEAD:
                raise RenditionError(f"{path} is too short")
            self._bytes = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        stored = self._bytes[len(_MAGIC) : _HASHED_FROM]
        with memoryview(self._bytes) as view:
            if view[: len(_MAGIC)] != _MAGIC or hashlib.sha256(view[_HASHED_FROM:]).digest() != stored:
                raise RenditionError(f"{path} is damaged")
        count = int.from_bytes(self._bytes[_HASHED_FROM:_HEAD], "little")
        self._text = _HEAD + 8 * (count + 1)
        self._offsets = array("Q", self._bytes[_HEAD : self._text])
        self.ordinals = count

    def state(self, ordinal: int) -> bytes | None:
        """The state with that ordinal; None where the pose is undecided."""
        start, end = self._offsets[ordinal], self._offsets[ordinal + 1]
        return None if start == end else self._bytes[self._text + start : self._text + end - 1]

    def states(self, first: int, last: int) -> bytes | None:
        """The states with ordinals ``first`` to ``last``, separated by commas; None where one of them is undecided."""
        offsets = self._offsets[first : last + 2]
        if any(offsets[i] == offsets[i + 1] for i in range(len(offsets) - 1)):
            return None
        return self._bytes[self._text + offsets[0] : self._text + offsets[-1] - 1]


def write_rendition(path: Path, documents: Iterable[StateDocument | None], count: int) -> None:
    """Write a rendition of that many ordinals; it is at ``path`` when it is whole, and not before.

    Raises:
        RenditionError: there are more or fewer documents.
        OSError: it cannot be written.
    """
    partial = partial_path(path, os.getpid())
    try:
        with partial.open("w+b") as file:
            offsets = array("Q", [0])
            file.seek(_HEAD + 8 * (count + 1))
            for text in _texts(documents):
                file.write(text)
                offsets.append(offsets[-1] + len(text))
            if len(offsets) != count + 1:
                raise RenditionError(f"{len(offsets) - 1} states instead of {count}")
            file.seek(_HASHED_FROM)
            file.write(count.to_bytes(8, "little") + offsets.tobytes())
            _sign(file)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def partial_path(path: Path, process_id: int) -> Path:
    """Where a process writes before the rendition is whole."""
    return path.with_suffix(f".{process_id}.partial")


def _texts(documents: Iterable[StateDocument | None]) -> Iterator[bytes]:
    for document in documents:
        yield b"" if document is None else compact_json(document) + b","


def compact_json(document: object) -> bytes:
    """A document as compact JSON; every double is written so that it reads back the same."""
    return json.dumps(document, separators=(",", ":"), allow_nan=False).encode()


def _sign(file: BinaryIO) -> None:
    file.seek(_HASHED_FROM)
    digest = hashlib.sha256()
    while block := file.read(1 << 20):
        digest.update(block)
    file.seek(0)
    file.write(_MAGIC + digest.digest())
