"""The maps of the study: those of the default device and pair by either strategy, and of a hand that turns farther."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from threadstate.device.model import WHOLE_TURN_DEG, Device, default_device
from threadstate.device.strategy import Strategy
from threadstate.library.grid import Grid
from threadstate.numbers import number_text
from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import OrientationMap
from threadstate.thread.catalogue import quarter_twenty_unc

PHASES = 24
"""Starting phases of all 81 orientations of the default grid; boundaries between them are narrowed."""
TOLERANCE_DEG = 4.0
FRICTIONS = (0.1, 0.2, 0.3)
FARTHER_DEG = 390.0
"""A counter-clockwise turn that ends after the snaps that friction delays beyond a whole turn."""


@dataclass(frozen=True)
class StudiedMap:
    """A map with what it was computed from, and how long that took in words, empty where it was interrupted."""

    inputs: SuccessInputs
    orientations: Sequence[OrientationMap]
    duration: str = ""

    @cached_property
    def content_sha256(self) -> str:
        """Its content hash."""
        return map_sha256(self.orientations)

    @property
    def name(self) -> str:
        """Its strategy, and how far the hand turns if that is not a whole turn, as Markdown."""
        turn_deg = self.inputs.device.ccw_turn_deg
        farther = "" if turn_deg == WHOLE_TURN_DEG else f" through {number_text(turn_deg)} deg"
        return f"`{self.inputs.strategy.value}`{farther}"


def studied_inputs(friction_phases: int = PHASES) -> list[SuccessInputs]:
    """What the maps are computed from: frictionless ones, then those with friction, each by both strategies.

    The last one is that, with friction, of a hand that turns farther until the snap. With friction there may be fewer
    starting phases; critical frictions are those between the frictions of the map.
    """
    device = default_device()
    farther = replace(device, ccw_turn_deg=FARTHER_DEG)
    without, with_friction = ((0.0,), PHASES), (FRICTIONS, friction_phases)
    return [
        *(_inputs(device, strategy, *rest) for rest in (without, with_friction) for strategy in Strategy),
        _inputs(farther, Strategy.CCW_THEN_CW, *with_friction),
    ]


def _inputs(device: Device, strategy: Strategy, frictions: tuple[float, ...], phases: int) -> SuccessInputs:
    return SuccessInputs(
        quarter_twenty_unc(),
        device,
        strategy,
        Grid(4.0, 1.0, 360.0 / phases),
        frictions,
        phase_tolerance_deg=TOLERANCE_DEG,
        mu_tolerance=0.1,
    )
