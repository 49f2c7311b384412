"""What a user may choose about a solve by meshes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from threadstate.errors import InvalidValueError
from threadstate.mesh.presets import Preset, Tessellation
from threadstate.numbers import number_text


class Descent(StrEnum):
    """How a motion is stepped until the meshes collide."""

    SAFE = "safe"
    """Down by no more than the meshes are apart; turns by a fixed fine march, then halving."""
    DECADES = "decades"
    """As printed: by a step until there is a collision, back, by a tenth of it, and so on. It tunnels."""


class FinalStep(StrEnum):
    """The last and smallest step; the paper gives both (sections 4.1 and 8, and 6.1)."""

    ONE_MICROINCH = "1uin"
    TEN_MICROINCH = "10uin"

    @property
    def thread_pitches(self) -> float:
        """The step in thread pitches, as on the paper's thread of 0.05 in."""
        return 2e-5 if self is FinalStep.ONE_MICROINCH else 2e-4


class Tangent(StrEnum):
    """The axis of the second turn (method, section 4)."""

    EDGE = "edge"
    """The tangent of the edge curve in contact."""
    AZIMUTHAL = "azimuthal"
    """The azimuthal direction at the contact: the bolt's edge rolls into the nut at once."""


class Scene(StrEnum):
    """How much of bolt and nut is modelled, from the most to the least."""

    FULL = "full"
    """Both solids, closed."""
    BAND = "band"
    """What can be reached within 10 deg of tilt and 45 deg of turn: threads and cut ends, without what is behind."""
    EDGES = "edges"
    """That, with fine triangles along the two edge curves alone."""
    CURVES = "curves"
    """No triangles: points of the two edge curves, against the closed form of the other part."""


DEFAULT_SCENE = Scene.BAND
"""It leaves out what the procedure does not need; ``EDGES`` saves more, and costs contacts of some pairs (decision
6).
"""
SMALLEST_STEP, LARGEST_STEP = 1e-7, 1e-2
"""Bounds of the final step, in thread pitches."""


@dataclass(frozen=True, slots=True)
class MeshOptions:
    """Tessellation, descent, final step (in thread pitches; turns: of arc at the bolt's major radius), tangent, scene.

    ``checked`` is whether another tessellation has to agree (:mod:`threadstate.mesh.agreement`); the paper has no such
    check.

    Raises:
        InvalidValueError: the final step is out of range.
    """

    tessellation: Tessellation = Preset.PAPER.tessellation
    descent: Descent = Descent.SAFE
    final_step: float = FinalStep.ONE_MICROINCH.thread_pitches
    tangent: Tangent = Tangent.EDGE
    scene: Scene = DEFAULT_SCENE
    checked: bool = True

    def __post_init__(self) -> None:
        if not (math.isfinite(self.final_step) and SMALLEST_STEP <= self.final_step <= LARGEST_STEP):
            valid = f"{number_text(SMALLEST_STEP)} to {number_text(LARGEST_STEP)} thread pitches"
            raise InvalidValueError("final_step", self.final_step, valid)
