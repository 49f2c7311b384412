"""What a library of settled states is computed from, and its identity: the hash of all that its content depends on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property

from threadstate.device.document import device_document, device_from_document
from threadstate.device.model import Device
from threadstate.library.grid import Grid
from threadstate.library.identity import COMPUTING, HELD, canonical_json, version_of_code
from threadstate.thread.pair import Pair

PHYSICS = (
    *HELD,
    "library/grid.py",
    "settled/compute.py",
    "settled/rows.py",
)
"""The sources that decide what is stored."""
SETTLED_CODE = (PHYSICS, COMPUTING)


@dataclass(frozen=True)
class SettledInputs:
    """All that the content of a library of settled states depends on.

    The pair has to be one that settled states are computed of (``threadstate.device.settle.check_pair``).
    """

    pair: Pair
    grid: Grid
    device: Device

    @cached_property
    def pair_json(self) -> str:
        """The pair as canonical JSON."""
        return canonical_json(self.pair)

    @cached_property
    def device_json(self) -> str:
        """The device's document as canonical JSON, in the device's own unit."""
        return json.dumps(device_document(self.device), sort_keys=True, separators=(",", ":"), allow_nan=False)

    @property
    def code_version(self) -> str:
        """The project's version and the first 12 digits of the hash of the code that computes what is stored."""
        return version_of_code(*SETTLED_CODE)

    @cached_property
    def sha256(self) -> str:
        """SHA-256, in hexadecimal, of pair, grid, device and code version."""
        parts = (self.pair_json, canonical_json(self.grid), self.device_json, self.code_version)
        return hashlib.sha256(json.dumps(parts, separators=(",", ":")).encode()).hexdigest()


def device_of(device_json: str) -> Device:
    """The device of its canonical JSON."""
    return device_from_document(json.loads(device_json))
