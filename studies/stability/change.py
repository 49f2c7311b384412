"""How two states differ, and whether they differ by no more than continuity allows."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from studies.methods import Case, moved
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, Vector
from threadstate.thread.pair import Pair

HEIGHT_STEEPNESS = 10.0
"""A contact whose normal is less than 84 deg off the vertical lets the height follow a motion no faster than this."""
STEEPNESS = 10.0
"""Of turns (times the bolt's reach) and contact points, over the sine of the tilt: they follow the tilt's direction."""
ROUND_OFF_INCH = 1e-15
"""Of where a point of the bolt is."""
HEIGHT_NOISE_INCH, NOISE_INCH = 1e-11, 1e-8
"""Of a height; of a turn or a point: what round-off makes of them where edges graze or contacts are nearly tied."""
STEEP_INCH = 1e-3
"""What is steeper than is usual may still change by no more than this."""
PHASE_ROUND_OFF = 2.0**-51
"""Of a phase, when it is written in rad."""
JUMP_INCH = 1e-6
"""What changes by more between inputs that are one has jumped."""


@dataclass(frozen=True, slots=True)
class SolvedCase:
    """A case and the state that a method gave for it; what is compared here has the scale 1."""

    case: Case
    state: ContactState


def at_scale_one(solved: SolvedCase, pair: Pair) -> SolvedCase:
    """The state of a scaled case as one of the pair from which it was scaled: every length divided by the scale."""
    factor = 1.0 / solved.case.scale

    def length(value: float | None) -> float | None:
        return None if value is None else factor * value

    def vector(value: Vector) -> Vector:
        return factor * value[0], factor * value[1], factor * value[2]

    state = solved.state
    state = replace(
        state,
        poses=tuple(replace(pose, translation=vector(pose.translation)) for pose in state.poses),
        contacts=tuple(
            replace(
                contact,
                point=vector(contact.point),
                point_bolt=vector(contact.point_bolt),
                bolt_margin=factor * contact.bolt_margin,
                nut_margin=factor * contact.nut_margin,
            )
            for contact in state.contacts
        ),
        drop=length(state.drop),
        embedment=length(state.embedment),
        pivot_offset=length(state.pivot_offset),
        drop_margin=length(state.drop_margin),
        embedment_margin=length(state.embedment_margin),
        pivot_margin=length(state.pivot_margin),
    )
    return SolvedCase(replace(solved.case, pair=pair, scale=1.0), state)


@dataclass(frozen=True, slots=True)
class Change:
    """The largest changes between two states that have the same stages, in inches.

    ``height`` is that of the first contact, ``turn`` the second's or third's in rad times the bolt's reach, ``point``
    a contact's in the nut's frame, ``number`` that of drop, embedment or pivot offset.
    """

    height: float
    turn: float
    point: float
    number: float

    @property
    def largest(self) -> float:
        """The greatest of the four."""
        return max(self.height, self.turn, self.point, self.number)


def leading_contacts(state: ContactState) -> dict[int, Contact]:
    """The first contact of every stage that ends in one and not in a patch, by stage."""
    found: dict[int, Contact] = {}
    for contact in state.contacts:
        if contact.features is not FeaturePair.FLUSH and contact.stage not in found:
            found[contact.stage] = contact
    return found


def stages(state: ContactState) -> tuple[str, ...]:
    """How each stage ended, and whether several contacts or senses were followed: equal where numbers compare."""
    kinds = [""] * len(state.poses)
    for contact in state.contacts:
        kinds[contact.stage - 1] = "flush" if contact.features is FeaturePair.FLUSH else "contact"
    return (*kinds, *(flag.value for flag in (Flag.TIE, Flag.BALANCED) if flag in state.flags))


def pivot_lever(state: ContactState) -> float | None:
    """The lever of a vertical force at the bolt's origin about CP0-CP1, signed, in inches; None without that axis."""
    held = leading_contacts(state)
    if not {1, 2} <= held.keys():
        return None
    point = np.array(held[1].point)
    axis = np.array(held[2].point) - point
    lever = np.cross(axis / np.linalg.norm(axis), np.array(state.poses[1].translation) - point)
    return float(lever[2])


def change_between(one: SolvedCase, other: SolvedCase) -> Change | None:
    """How two states differ; None where their stages do."""
    a, b = one.state, other.state
    if stages(a) != stages(b):
        return None
    height = abs(a.poses[0].translation[2] - b.poses[0].translation[2])
    turn = max(_difference(a.lambda_deg, b.lambda_deg), _difference(a.mu_deg, b.mu_deg))
    point = 0.0
    those = leading_contacts(b)
    for stage, contact in leading_contacts(a).items():
        point = max(point, math.dist(contact.point, those[stage].point))
    number = max(
        _difference(x, y) for x, y in ((a.drop, b.drop), (a.embedment, b.embedment), (a.pivot_offset, b.pivot_offset))
    )
    return Change(height, math.radians(turn) * one.case.reach, point, number)


def allowed(one: Case, other: Case, factor: float = 1.0) -> tuple[float, float]:
    """The most by which the height, and anything else, changes between two cases where nothing happens.

    With a ``factor`` slopes may be so many times steeper than is usual.
    """
    phase = math.radians(max(abs(one.pose_deg[2]), abs(other.pose_deg[2])))
    far = moved(one, other) + ROUND_OFF_INCH + PHASE_ROUND_OFF * phase * one.reach
    tilt = min(one.tilt, other.tilt)
    height = HEIGHT_STEEPNESS * far
    rest = math.inf if tilt == 0.0 else STEEPNESS * far / tilt
    if factor != 1.0:
        height, rest = max(height, min(factor * height, STEEP_INCH)), max(rest, min(factor * rest, STEEP_INCH))
    return height + HEIGHT_NOISE_INCH, rest + NOISE_INCH


def is_steady(one: SolvedCase, other: SolvedCase, factor: float = 1.0) -> bool:
    """Whether nothing happens between two states: same stages, and no change beyond what is allowed."""
    change = change_between(one, other)
    if change is None:
        return False
    height, rest = allowed(one.case, other.case, factor)
    return change.height <= height and max(change.turn, change.point, change.number) <= rest


def has_jumped(one: SolvedCase, other: SolvedCase) -> bool:
    """Whether neighbouring states differ by more than a steep slope could make of what is between them."""
    change = change_between(one, other)
    return change is None or (change.largest > JUMP_INCH and not is_steady(one, other))


def _difference(a: float | None, b: float | None) -> float:
    return abs(a - b) if a is not None and b is not None else 0.0
