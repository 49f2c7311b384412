"""The maps of the study: those of the default device and pair, by either strategy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import OrientationMap
from threadstate.thread.catalogue import quarter_twenty_unc

PHASES = 24
"""Starting phases of all 81 orientations of the default grid; boundaries between them are narrowed."""
TOLERANCE_DEG = 4.0
FRICTIONS = (0.1, 0.2, 0.3)


@dataclass(frozen=True)
class StudiedMap:
    """A map with what it was computed from."""

    inputs: SuccessInputs
    orientations: Sequence[OrientationMap]

    @cached_property
    def content_sha256(self) -> str:
        """Its content hash."""
        return map_sha256(self.orientations)


def studied_inputs(friction_phases: int = PHASES) -> list[SuccessInputs]:
    """What the maps are computed from: frictionless ones, then those with friction, each by both strategies.

    With friction there may be fewer starting phases; critical frictions are those between the frictions of the map.
    """
    pair, device = quarter_twenty_unc(), default_device()
    return [
        SuccessInputs(
            pair,
            device,
            strategy,
            Grid(4.0, 1.0, 360.0 / phases),
            frictions,
            phase_tolerance_deg=TOLERANCE_DEG,
            mu_tolerance=0.1,
        )
        for frictions, phases in (((0.0,), PHASES), (FRICTIONS, friction_phases))
        for strategy in Strategy
    ]
