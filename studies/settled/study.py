"""The settled states of a grid beside the paper's: where they agree, and where the paper's turns lead elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from threadstate.device.model import Outcome, SettledFlag, SettledState
from threadstate.state.model import ContactState, Flag, Rotation, StateClass, Vector

SAME_AXIS_DEG = 0.1
"""Axes that are nearer than this are the same here."""
SAME_POINT = 0.05
"""Contacts that are nearer than this part of the nominal radius are the same here."""

PAPER_KINDS = ("flush", *(name.value for name in reversed(StateClass)))
SETTLED_KINDS = ("flush", "three or more", "two", "one", "not settled")


@dataclass(frozen=True)
class ComparedPose:
    """A pose of the grid: the paper's state, and where the bolt comes to rest. Lengths in the pair's unit."""

    state: ContactState
    settled: SettledState

    @property
    def paper_kind(self) -> str:
        """The state's class; flush states apart."""
        return "flush" if Flag.FLUSH in self.state.flags else self.state.state_class.value

    @property
    def settled_kind(self) -> str:
        """On what the bolt rests."""
        if self.settled.outcome is not Outcome.SETTLED:
            return "not settled"
        if SettledFlag.FLUSH in self.settled.flags:
            return "flush"
        return {1: "one", 2: "two"}.get(len(self.settled.contacts), "three or more")

    @property
    def embeds(self) -> bool:
        """Whether the solids overlap in the paper's last pose."""
        return self.state.embedment_margin is not None and self.state.embedment_margin < 0.0

    @property
    def lift(self) -> float | None:
        """How far above its origin in the paper's last pose the bolt rests; None where it is not settled."""
        if self.settled.pose is None:
            return None
        return self.settled.pose.translation[2] - self.state.poses[-1].translation[2]

    @property
    def apart_deg(self) -> float | None:
        """The angle between the bolt's axis in the paper's last pose and at rest; None where it is not settled."""
        return self._apart_deg(-1)

    @property
    def agrees(self) -> bool:
        """Whether the bolt rests as the paper has it: flush, or on as many contacts as its class has, near its axis."""
        kinds = {
            "flush": ("flush",),
            StateClass.STABLE_THREE_POINT.value: ("three or more",),
            StateClass.QUASI_STABLE_TWO_POINT.value: ("two",),
        }
        near = self.apart_deg is not None and self.apart_deg < SAME_AXIS_DEG
        return near and self.settled_kind in kinds.get(self.paper_kind, ())

    def turns_away(self, stage: int) -> bool | None:
        """Whether the turn of stage 2 or 3 takes the axis farther from where it rests; None where there is none."""
        if len(self.state.poses) < stage:
            return None
        before, after = self._apart_deg(stage - 2), self._apart_deg(stage - 1)
        return None if before is None or after is None else after > before

    def shared_contacts(self, nominal_radius: float) -> int:
        """How many contacts of the settled state have the features of one of the paper's, near it."""
        return sum(
            any(
                one.features is other.features and math.dist(one.point, other.point) < SAME_POINT * nominal_radius
                for other in self.state.contacts
            )
            for one in self.settled.contacts
        )

    def _apart_deg(self, stage: int) -> float | None:
        if self.settled.pose is None:
            return None
        return angle_deg(axis(self.state.poses[stage].rotation), axis(self.settled.pose.rotation))


def axis(rotation: Rotation) -> Vector:
    """The bolt's axis in the nut's frame."""
    return rotation[0][2], rotation[1][2], rotation[2][2]


def angle_deg(one: Vector, other: Vector) -> float:
    """The angle between two unit vectors, exact for small ones."""
    x, y, z = one
    u, v, w = other
    cross = math.hypot(y * w - z * v, z * u - x * w, x * v - y * u)
    return math.degrees(math.atan2(cross, x * u + y * v + z * w))


def compared(states: Sequence[ContactState], settled: Sequence[SettledState]) -> list[ComparedPose]:
    """The poses of both, which have to be the same and in the same order."""
    found = [ComparedPose(state, rest) for state, rest in zip(states, settled, strict=True)]
    for one in found:
        paper = (one.state.roll_deg, one.state.pitch_deg, one.state.phase_deg)
        assert paper == (one.settled.roll_deg, one.settled.pitch_deg, one.settled.phase_deg)
    return found
