"""What samples of paths are computed from, and their identity: the hash of all that their content depends on."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from threadstate.chances.sampling import Uncertainty
from threadstate.device.document import device_document
from threadstate.device.model import Device
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.identity import COMPUTING, HELD, canonical_json, version_of_code
from threadstate.success.inputs import POINT_LIMIT, POINT_LIMITS
from threadstate.thread.pair import Pair

PHYSICS = (
    *HELD,
    "success/bounded.py",
    "success/model.py",
    "chances/compute.py",
    "chances/document.py",
    "chances/model.py",
    "chances/record.py",
    "chances/sampling.py",
)
"""The sources that decide what a sample holds."""
CHANCES_CODE = (PHYSICS, COMPUTING)


@dataclass(frozen=True)
class ChancesInputs:
    """All that the samples depend on; how many there are is no part of it.

    A path of which one turn, or the push before, has more than ``point_limit`` points is not followed to its end. The
    pair has to be one that settled states are computed of (``threadstate.device.settle.check_pair``).

    Raises:
        InvalidValueError: the limit is not from 10 to 2,500.
    """

    pair: Pair
    device: Device
    strategy: Strategy
    uncertainty: Uncertainty
    point_limit: int = POINT_LIMIT

    def __post_init__(self) -> None:
        least, largest = POINT_LIMITS
        if not least <= self.point_limit <= largest:
            raise InvalidValueError("point_limit", self.point_limit, f"{least} to {largest}")

    @property
    def code_version(self) -> str:
        """The project's version and the first 12 digits of the hash of the code that computes a sample."""
        return version_of_code(*CHANCES_CODE)

    @cached_property
    def document(self) -> dict[str, Any]:
        """The inputs without their hash; angles in degrees, lengths in the units that pair and device name."""
        uncertainty = self.uncertainty
        return {
            "code_version": self.code_version,
            "pair": json.loads(canonical_json(self.pair)),
            "device": device_document(self.device),
            "strategy": self.strategy.value,
            "tilt_mean": [float(mean) + 0.0 for mean in uncertainty.tilt_mean_deg],
            "tilt_sd": float(uncertainty.tilt_sd_deg) + 0.0,
            "mu": [float(mu) + 0.0 for mu in uncertainty.mu],
            "point_limit": self.point_limit,
        }

    @cached_property
    def sha256(self) -> str:
        """SHA-256, in hexadecimal, of the inputs with the code version."""
        text = json.dumps(self.document, sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()
