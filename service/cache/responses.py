"""Responses of status 200 with a strong ETag, as bytes; the least recently used make room for others."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass

from service.compression import Headers

OVERHEAD_BYTES = 1024
"""What a response takes beside its body, about."""
LARGEST_SHARE = 4
"""No response takes more than this part of the cache: one over it."""

_OF_CONTENT = (b"content-length", b"content-type")


@dataclass(frozen=True, slots=True)
class CachedResponse:
    """A response; ``body`` is None where only its ETag is known. ``route`` is the template of its address."""

    route: str
    etag: str
    headers: Headers
    body: bytes | None

    @property
    def headers_of_304(self) -> Headers:
        """The headers where the client has the body already."""
        return [(name, value) for name, value in self.headers if name not in _OF_CONTENT]


class ResponseCache:
    """Responses by their keys, bounded in bytes; ``hits`` and ``misses`` count how often one was found."""

    def __init__(self, largest_bytes: int) -> None:
        self._largest = largest_bytes
        self._responses: OrderedDict[Hashable, CachedResponse] = OrderedDict()
        self.bytes = 0
        self.hits = 0
        self.misses = 0

    def __len__(self) -> int:
        return len(self._responses)

    def get(self, key: Hashable) -> CachedResponse | None:
        """The response of that key."""
        found = self._responses.get(key)
        if found is None:
            self.misses += 1
        else:
            self.hits += 1
            self._responses.move_to_end(key)
        return found

    def put(self, key: Hashable, response: CachedResponse) -> None:
        """Cache a response, unless it is too large."""
        size = _size(response)
        if size > self._largest // LARGEST_SHARE:
            return
        before = self._responses.pop(key, None)
        self.bytes += size - (0 if before is None else _size(before))
        self._responses[key] = response
        while self.bytes > self._largest:
            _, oldest = self._responses.popitem(last=False)
            self.bytes -= _size(oldest)


def _size(response: CachedResponse) -> int:
    return OVERHEAD_BYTES + len(response.body or b"")
