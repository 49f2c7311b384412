"""Requests for where held bolts come to rest."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from threadstate.client.call import Call, LibraryName, path_of, post
from threadstate.client.models.settled import SettleAnswer


def settle(
    poses: Iterable[tuple[float, float, float]],
    *,
    device: Mapping[str, Any] | None = None,
    designation: str | None = None,
    library: LibraryName | None = None,
    unit: str | None = None,
) -> Call[SettleAnswer]:
    """Where a bolt comes to rest that a ``device`` holds at 1 to 1000 poses (roll, pitch, phase) and pushes.

    A device is a mapping with the keys of its document; None is the default one. Of a known thread, or with the pair of
    ``library``. Lengths of the answer are in ``unit``, those of the device in its own.
    """
    body = {
        "designation": designation,
        "library": library,
        "device": None if device is None else dict(device),
        "poses": [{"roll": float(roll), "pitch": float(pitch), "phase": float(phase)} for roll, pitch, phase in poses],
    }
    # Nothing is stored: repeatable.
    return post(path_of("v1", "settle"), SettleAnswer, body, repeatable=True, unit=unit)
