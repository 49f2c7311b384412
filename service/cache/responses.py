"""An LRU cache of responses with status 200 and a strong ETag, as bytes."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Hashable
from dataclasses import dataclass

from service.compression import Headers

OVERHEAD_BYTES = 1024
"""Approximate memory of a response besides its body."""
LARGEST_SHARE = 4
"""No response may take more than the cache's size divided by this."""

_OF_CONTENT = (b"content-length", b"content-type")


@dataclass(frozen=True, slots=True)
class CachedResponse:
    """A response; ``body`` is None if only its ETag is known. ``route`` is the template of its address."""

    route: str
    etag: str
    headers: Headers
    body: bytes | None

    @property
    def headers_of_304(self) -> Headers:
        """The headers of a 304 response."""
        return [(name, value) for name, value in self.headers if name not in _OF_CONTENT]


class ResponseCache:
    """Responses by key, limited in bytes; ``hits`` and ``misses`` count the lookups."""

    def __init__(self, largest_bytes: int) -> None:
        self._largest = largest_bytes
        self._responses: OrderedDict[Hashable, CachedResponse] = OrderedDict()
        self.bytes = 0
        self.hits = 0
        self.misses = 0

    def __len__(self) -> int:
        return len(self._responses)

    def get(self, key: Hashable) -> CachedResponse | None:
        """The cached response of a key; None if there is none."""
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
