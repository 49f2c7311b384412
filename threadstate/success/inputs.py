"""What a success map is computed from, and its identity: the hash of all that its content depends on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from threadstate.device.document import device_document
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.identity import COMPUTING, HELD, canonical_json, version_of_code
from threadstate.numbers import number_text
from threadstate.thread.pair import Pair

PHYSICS = (
    *HELD,
    "library/grid.py",
    "success/bounded.py",
    "success/compute.py",
    "success/document.py",
    "success/model.py",
    "success/orientation_paths.py",
    "success/search.py",
)
"""The sources that decide what a map holds."""
SUCCESS_CODE = (PHYSICS, COMPUTING)

FRICTIONS = (0.1, 0.2, 0.3)
PHASE_TOLERANCE_DEG = 2.0
MU_TOLERANCE = 0.01
POINT_LIMIT = 1000

LARGEST_FRICTION = 1.0
SMALLEST_PHASE_TOLERANCE_DEG, SMALLEST_MU_TOLERANCE = 0.01, 1e-4
POINT_LIMITS = (10, 2500)
"""The least and the largest limit of points; no turn has more than the latter."""


@dataclass(frozen=True)
class SuccessInputs:
    """All that the content of a success map depends on.

    The grid has the orientations and the starting phases. Frictions ascend. A boundary of outcome along the phase is
    narrowed to ``phase_tolerance_deg``, the critical friction to ``mu_tolerance``. A path of which one turn, or the
    push before, has more than ``point_limit`` points is not followed to its end. The pair has to be one that settled
    states are computed of (``threadstate.device.settle.check_pair``).

    Raises:
        InvalidValueError: a friction or a tolerance is outside its range, frictions are missing, twice the same or out
            of order, or the limit is not from 10 to 2,500.
    """

    pair: Pair
    device: Device
    strategy: Strategy
    grid: Grid
    frictions: tuple[float, ...] = FRICTIONS
    phase_tolerance_deg: float = PHASE_TOLERANCE_DEG
    mu_tolerance: float = MU_TOLERANCE
    point_limit: int = POINT_LIMIT

    def __post_init__(self) -> None:
        for mu in self.frictions:
            _require("mu", mu, 0.0, LARGEST_FRICTION)
        if not self.frictions or list(self.frictions) != sorted(set(self.frictions)):
            raise InvalidValueError("mu", _listed(self.frictions), "frictions that ascend, at least one")
        _require("phase_tolerance", self.phase_tolerance_deg, SMALLEST_PHASE_TOLERANCE_DEG, 360.0, " deg")
        _require("mu_tolerance", self.mu_tolerance, SMALLEST_MU_TOLERANCE, LARGEST_FRICTION)
        least, largest = POINT_LIMITS
        if not least <= self.point_limit <= largest:
            raise InvalidValueError("point_limit", self.point_limit, f"{least} to {largest}")

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
        """The project's version and the first 12 digits of the hash of the code that computes a map."""
        return version_of_code(*SUCCESS_CODE)

    @cached_property
    def sha256(self) -> str:
        """SHA-256, in hexadecimal, of pair, device, strategy, grid, frictions, tolerances, limit and code version."""
        numbers = [float(number) + 0.0 for number in (*self.frictions, self.phase_tolerance_deg, self.mu_tolerance)]
        parts = (
            self.pair_json,
            self.device_json,
            self.strategy,
            canonical_json(self.grid),
            numbers,
            self.point_limit,
            self.code_version,
        )
        return hashlib.sha256(json.dumps(parts, separators=(",", ":"), allow_nan=False).encode()).hexdigest()


def _require(name: str, value: float, low: float, high: float, unit: str = "") -> None:
    if not low <= value <= high:
        raise InvalidValueError(name, value, f"{number_text(low)} to {number_text(high)}{unit}")


def _listed(numbers: Sequence[float]) -> str:
    return ",".join(map(number_text, numbers))
