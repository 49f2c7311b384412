"""Answers of status 200 with a strong ETag, as bytes; the least recently asked for make room for others."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass

Headers = list[tuple[bytes, bytes]]

OVERHEAD_BYTES = 1024
"""What an answer takes beside its body, about."""
LARGEST_SHARE = 4
"""No answer takes more than this part of the room: one over it."""

_OF_CONTENT = (b"content-length", b"content-type")


@dataclass(frozen=True, slots=True)
class Answer:
    """An answer; ``body`` is None where only its ETag is known. ``route`` is the template of its address."""

    route: str
    etag: str
    headers: Headers
    body: bytes | None

    @property
    def headers_of_304(self) -> Headers:
        """What is sent where the client has the body already."""
        return [(name, value) for name, value in self.headers if name not in _OF_CONTENT]


class KeptAnswers:
    """Answers by their keys, bounded in bytes; ``hits`` and ``misses`` count how often one was found."""

    def __init__(self, room_bytes: int) -> None:
        self._room = room_bytes
        self._answers: OrderedDict[Hashable, Answer] = OrderedDict()
        self.bytes = 0
        self.hits = 0
        self.misses = 0

    def __len__(self) -> int:
        return len(self._answers)

    def takes(self, size_bytes: int) -> bool:
        """Whether a body of that size is kept."""
        return size_bytes + OVERHEAD_BYTES <= self._room // LARGEST_SHARE

    def get(self, key: Hashable) -> Answer | None:
        """The answer of that key."""
        found = self._answers.get(key)
        if found is None:
            self.misses += 1
        else:
            self.hits += 1
            self._answers.move_to_end(key)
        return found

    def put(self, key: Hashable, answer: Answer) -> None:
        """Keep an answer, if there is room for one of its size."""
        size = _size(answer)
        if not self.takes(size - OVERHEAD_BYTES):
            return
        before = self._answers.pop(key, None)
        self.bytes += size - (0 if before is None else _size(before))
        self._answers[key] = answer
        while self.bytes > self._room:
            _, gone = self._answers.popitem(last=False)
            self.bytes -= _size(gone)


def _size(answer: Answer) -> int:
    return OVERHEAD_BYTES + len(answer.body or b"")
