"""The turns of a state, computed independently from its contacts by the method's section 4."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from oracle.overlap import LARGEST_TILT_DEG, clearance, end_distance, excluded_rows, free_component
from oracle.profile import P, bolt_profile, nut_profile
from oracle.solids import Floats, at_sharp_corner, edge_tangent, outward
from oracle.turn import contact_components_along_turn, turned_pose
from threadstate.state.model import Contact, ContactState
from threadstate.thread.pair import Pair

AZIMUTHS_OF_WAY, HEIGHTS_OF_WAY = 100, 41
WAY_HALF_WIDTH = 0.03
"""Samples on the way from a contact to a point, and how far from the straight way, in thread pitches."""
ON_SURFACE = 1e-8
"""A clearance of less, in thread pitches, is none: a contact at a sharp corner is at a fillet of 4e-9."""


@dataclass(frozen=True)
class Turn:
    """A turn in the nut's frame: the pose before it, the axis, the signed turn found (None: no contact), what is known.

    ``found`` holds the contacts at its end.
    """

    stage: int
    rotation: Floats
    translation: Floats
    point: Floats
    direction: Floats
    sense: float
    turn_deg: float | None
    known: Floats
    found: tuple[Contact, ...]

    def pose_after(self, turn_deg: float) -> tuple[Floats, Floats]:
        """Rotation and translation after a turn of that size in the turn's sense."""
        return turned_pose(self.rotation, self.translation, self.point, self.direction, self.sense * turn_deg)

    def end_deg(self, limit_deg: float) -> float:
        """The size of the turn, up to the limit where it ended without contact; no more than the oracle can follow."""
        size = limit_deg if self.turn_deg is None else self.turn_deg
        while _tilt_deg(self.pose_after(size)[0]) > LARGEST_TILT_DEG - 0.1:
            size -= 0.25
        return size


def within_brute_force(turn: Turn) -> bool:
    """Whether the brute force can look at the end of a turn that ended in a contact."""
    return turn.turn_deg is not None and _tilt_deg(turn.pose_after(turn.turn_deg)[0]) < LARGEST_TILT_DEG - 0.1


def _tilt_deg(rotation: Floats) -> float:
    return math.degrees(math.acos(min(1.0, rotation[2, 2])))


def contacts_of_stage(state: ContactState, stage: int) -> tuple[Contact, ...]:
    """The contacts that were found in a stage."""
    return tuple(contact for contact in state.contacts if contact.stage == stage)


def first_tangent(pair: Pair, state: ContactState) -> Floats:
    """``t0``, counter-clockwise: tangent at CP0 of the nut's edge, else of the bolt's; else of a thread's helix."""
    first = state.contacts[0]
    point, rotation = np.array(first.point), np.array(state.poses[0].rotation)
    bolt_feature, nut_feature = first.features.value.split("-")
    bolt, nut, point_bolt = bolt_profile(pair), nut_profile(pair), np.array(first.point_bolt)
    if nut_feature == "edge":
        # An edge's corner has the tangent that the other part's face has in the edge's plane: it rolls on that face.
        at_corner = bolt_feature == "thread" and at_sharp_corner(point, nut)
        face = rotation @ outward(point_bolt, bolt)
        tangent = np.cross(face, [0.0, 0.0, 1.0]) if at_corner else edge_tangent(point, nut)
    elif bolt_feature == "edge":
        at_corner = nut_feature == "thread" and at_sharp_corner(point_bolt, bolt)
        face = outward(point, nut)
        tangent = np.cross(face, rotation[:, 2]) if at_corner else rotation @ edge_tangent(point_bolt, bolt)
    elif nut_feature == "surface":
        tangent = rotation @ np.array([-point_bolt[1], point_bolt[0], pair.lead / (2.0 * math.pi)])
    else:
        tangent = np.array([-point[1], point[0], pair.lead / (2.0 * math.pi)])
    counter_clockwise = point[0] * tangent[1] - point[1] * tangent[0]
    return np.asarray(math.copysign(1.0, counter_clockwise) * tangent / np.linalg.norm(tangent))


def turns_of(pair: Pair, state: ContactState) -> list[Turn]:
    """The second stage's turn and, where that one ended in a contact, the third's; the pose must be tilted."""
    cp0 = np.array(state.contacts[0].point)
    rotation, translation = np.array(state.poses[0].rotation), np.array(state.poses[0].translation)
    second = contacts_of_stage(state, 2)
    turns = [
        Turn(
            stage=2,
            rotation=rotation,
            translation=translation,
            point=cp0,
            direction=first_tangent(pair, state),
            sense=-1.0,
            turn_deg=state.lambda_deg,
            known=cp0.reshape(1, 3),
            found=second,
        )
    ]
    if state.lambda_deg is None or second[0].features.value == "flush":
        return turns
    cp1 = np.array(second[0].point)
    rotation, translation = np.array(state.poses[1].rotation), np.array(state.poses[1].translation)
    axis = (cp1 - cp0) / np.linalg.norm(cp1 - cp0)
    turns.append(
        Turn(
            stage=3,
            rotation=rotation,
            translation=translation,
            point=cp0,
            direction=axis,
            sense=-math.copysign(1.0, np.cross(axis, translation - cp0)[2]),
            turn_deg=state.mu_deg,
            known=np.array([cp0, cp1]),
            found=contacts_of_stage(state, 3),
        )
    )
    return turns


def deepest_near(pair: Pair, rotation: Floats, translation: Floats, point: Floats, reach: float) -> float:
    """The oracle's clearance where it is greatest within ``reach`` (along the nut's azimuth and axis) of a point."""
    rotation = np.ascontiguousarray(rotation)
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    azimuth, radius = math.atan2(point[1], point[0]), math.hypot(point[0], point[1])
    centre, size, best = (azimuth, min(float(point[2]), 0.0)), reach, -math.inf
    steps = np.linspace(-1.0, 1.0, 9)
    while size > 1e-4 * reach:
        around = [
            (centre[0] + size * a / radius, min(centre[1] + size * b, 0.0))
            for a in steps.tolist()
            for b in steps.tolist()
        ]
        values = [clearance(theta, z, rotation, translation, bolt, nut) for theta, z in around]
        highest = int(np.argmax(values))
        best, centre = max(best, values[highest]), around[highest]
        size *= 0.5
    return best


def _greatest_clearance(
    theta: float, z: float, rotation: Floats, translation: Floats, bolt: Floats, nut: Floats
) -> float:
    """The greatest clearance at an azimuth near ``z``: the best of samples, then of ever narrower ones about it."""
    best, half = -math.inf, WAY_HALF_WIDTH * nut[P]
    while half > 1e-11 * nut[P]:
        for at in np.linspace(z - half, z + half, HEIGHTS_OF_WAY).tolist():
            value = clearance(theta, min(at, 0.0), rotation, translation, bolt, nut)
            if value > best:
                best, z = value, at
        half *= 4.0 / HEIGHTS_OF_WAY
    return best


def begins_at(pair: Pair, turn: Turn, point: Floats, before_and_after_deg: float, reach_pitches: float) -> bool:
    """Whether an overlap begins about a point at the end of a turn: just before it there is none, just after there is.

    It is looked for within ``reach_pitches`` thread pitches of the point.
    """
    assert turn.turn_deg is not None
    reach = reach_pitches * pair.thread_pitch
    before, after = (
        deepest_near(pair, *turn.pose_after(turn.turn_deg + change), point, reach)
        for change in (-before_and_after_deg, before_and_after_deg)
    )
    return before < 0.0 < after


@dataclass(frozen=True)
class Appearance:
    """A component without any known contact: the turn at which it appears, and its depth as soon as it is seen.

    A component at its onset is shallow; a piece that parts from a grown overlap is deep at once. It is deepest
    on the ray of ``azimuth`` (radians) and height ``z``, in the nut's frame.
    """

    turn_deg: float
    depth: float
    azimuth: float
    z: float


def earlier_appearance(pair: Pair, turn: Turn, limit_deg: float, steps: int) -> Appearance | None:
    """The first component without any known contact that the brute force sees before the turn's end.

    Where it comes in over an end without a face, which cannot touch, the first of those that reach no end counts.
    """
    seen = _first_appearance(pair, turn, limit_deg, steps, at_ends=True)
    if seen is None or not _enters_over_an_end(pair, turn, seen):
        return seen
    return _first_appearance(pair, turn, limit_deg, steps, at_ends=False)


def _enters_over_an_end(pair: Pair, turn: Turn, seen: Appearance) -> bool:
    rotation, translation = turn.pose_after(seen.turn_deg)
    rotation = np.ascontiguousarray(rotation)
    distance = end_distance(seen.azimuth, seen.z, rotation, translation, bolt_profile(pair), nut_profile(pair))
    return distance < 2.0 * seen.depth + 1e-9 * pair.thread_pitch


def _first_appearance(pair: Pair, turn: Turn, limit_deg: float, steps: int, *, at_ends: bool) -> Appearance | None:
    seen = contact_components_along_turn(
        pair,
        turn.rotation,
        turn.translation,
        turn.point,
        turn.direction,
        turn.sense * turn.end_deg(limit_deg),
        turn.known,
        steps=steps,
        at_ends=at_ends,
    )
    if seen is None:
        return None
    bolt, nut = bolt_profile(pair), nut_profile(pair)

    def component(turn_deg: float) -> tuple[float, float, float]:
        rotation, translation = turn.pose_after(turn_deg)
        rotation = np.ascontiguousarray(rotation)
        excluded = excluded_rows(rotation, translation, turn.known)
        return free_component(rotation, translation, bolt, nut, excluded, at_ends)

    low, high = 0.0, abs(seen.turn_deg)
    while high - low > 1e-5:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if component(middle)[0] > 0.0 else (middle, high)
    return Appearance(high, *component(high))


def spreads_from_contact(pair: Pair, turn: Turn, seen: Appearance) -> bool:
    """Whether what the brute force takes for a component of its own is the overlap of a known contact.

    Along a crest's corner, and where a bolt is nearly in phase, an overlap spreads thinner than samples are apart. It
    is followed from the contact to where the component seen is deepest: at each azimuth between, some point
    near the straight way overlaps.
    """
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    rotation, translation = turn.pose_after(seen.turn_deg)
    rotation = np.ascontiguousarray(rotation)
    theta, z = seen.azimuth, seen.z
    p = pair.thread_pitch
    for known in turn.known:
        begin = math.atan2(known[1], known[0])
        far = math.remainder(theta - begin, 2.0 * math.pi)
        if all(
            _greatest_clearance(begin + part * far, known[2] + part * (z - known[2]), rotation, translation, bolt, nut)
            > -ON_SURFACE * p
            for part in np.linspace(0.0, 1.0, AZIMUTHS_OF_WAY).tolist()
        ):
            return True
    return False
