"""Files that grow by lines: a header of inputs, then a numbered value a line, as JSON, each with its own hash.

Lines are appended as values are computed. What a killed run leaves of a line is dropped by the next one.
"""

from __future__ import annotations

import fcntl
import json
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Generic, TypeVar

from threadstate.errors import InvalidValueError

Value = TypeVar("Value")


@dataclass(frozen=True)
class LineFile(Generic[Value]):
    """What a kind of file holds for some inputs.

    Attributes:
        name: what errors call the file, as "map file".
        content: what it holds, as "a success map"; ``short`` in a few letters, as "a map".
        line: what a line holds, as "an orientation".
        header: the first line; its ``input_sha256`` says which inputs the file is of.
        document: a value as JSON; ``value`` is its inverse and raises KeyError, TypeError or ValueError.
        sha256: the hash of a value.
        index: the number of a value; of lines with the same number the last one counts.
    """

    name: str
    content: str
    short: str
    line: str
    header: Mapping[str, Any]
    document: Callable[[Value], Mapping[str, Any]]
    value: Callable[[Any], Value]
    sha256: Callable[[Value], str]
    index: Callable[[Value], int]

    def read(self, path: Path) -> list[Value]:
        """The values of a file, by their numbers.

        Raises:
            InvalidValueError: the file cannot be read, is none of this kind, or is one of other inputs.
        """
        try:
            content = path.read_bytes()
        except OSError as error:
            raise self._invalid(path, f"a file that can be read ({error.strerror})") from None
        return self._values(path, content)

    @contextmanager
    def growing(self, path: Path) -> Iterator[tuple[list[Value], Callable[[Value], None]]]:
        """What a file has, and what appends a value; a file that does not exist is made.

        A value that was appended is on the disk. While the context lasts no other process can append.

        Raises:
            InvalidValueError: as :meth:`read`, or the file cannot be written, or another process appends to it.
        """
        try:
            file = path.open("a+b")
        except OSError as error:
            raise self._invalid(path, f"a file that can be written ({error.strerror})") from None
        with file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                raise self._invalid(path, "a file that no other run writes") from None
            file.seek(0)
            content = file.read()
            complete = content.rfind(b"\n") + 1
            found = self._values(path, content)
            file.truncate(complete)
            if complete == 0:
                _append(file, self.header)
            yield found, lambda one: _append(file, {"sha256": self.sha256(one), **self.document(one)})

    def _values(self, path: Path, content: bytes) -> list[Value]:
        # What follows the last end of a line is a part of one.
        lines = content[: content.rfind(b"\n") + 1].splitlines()
        another = f"{self.content}, or a file that does not exist"
        if not lines:
            if content and not line_text(self.header).encode().startswith(content):
                raise self._invalid(path, another)
            return []
        try:
            made_from = json.loads(lines[0])["input_sha256"]
        except (ValueError, KeyError, TypeError):
            raise self._invalid(path, another) from None
        wanted = self.header["input_sha256"]
        if made_from != wanted:
            hashes = f"{wanted[:12]}, not {str(made_from)[:12]}"
            raise self._invalid(path, f"{self.short} of the same inputs and code ({hashes})")
        found = {}
        for number, line in enumerate(lines[1:], 2):
            try:
                document = json.loads(line)
                one = self.value(document)
                is_whole = document["sha256"] == self.sha256(one)
            except (ValueError, KeyError, TypeError):
                is_whole = False
            if not is_whole:
                raise InvalidValueError(f"{self.name}: line {number}", str(path), f"{self.line} with its own hash")
            found[self.index(one)] = one
        return [found[index] for index in sorted(found)]

    def _invalid(self, path: Path, valid: str) -> InvalidValueError:
        return InvalidValueError(self.name, str(path), valid)


def line_text(document: Mapping[str, Any]) -> str:
    """A document as one line of compact JSON, every number as its shortest decimal.

    Raises:
        ValueError: a number is not finite.
    """
    return json.dumps(document, separators=(",", ":"), allow_nan=False)


def _append(file: BinaryIO, document: Mapping[str, Any]) -> None:
    file.write(line_text(document).encode() + b"\n")
    file.flush()
    os.fsync(file.fileno())
