"""Whether a component that holds none of the known contacts appears along a turn, by brute force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from oracle.overlap import check_tilt, clearance, excluded_rows, free_component, witness
from oracle.pose import turn_about
from oracle.profile import bolt_profile, nut_profile
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

STOP_SHORT_DEG = 1e-4
"""How far before its end a turn is looked at last."""


@dataclass(frozen=True)
class EarlierComponent:
    """A component without any known contact: the turn at which it was seen, its deepest point, its depth there."""

    turn_deg: float
    point: tuple[float, float, float]
    depth: float


def turned_pose(
    rotation: Floats, translation: Floats, axis_point: Floats, axis_direction: Floats, turn_deg: float
) -> tuple[Floats, Floats]:
    """The pose after a right-handed turn about an axis given in the nut's frame."""
    turn = turn_about(np.asarray(axis_direction, dtype=np.float64), turn_deg)
    point = np.asarray(axis_point, dtype=np.float64)
    return turn @ rotation, point + turn @ (np.asarray(translation, dtype=np.float64) - point)


def turns_to_look_at(turn_deg: float, steps: int) -> Floats:
    """``steps`` turns spread evenly, and more close to both ends; none within STOP_SHORT_DEG of the end."""
    size = abs(turn_deg)
    even = size * np.arange(1, steps) / steps
    near_ends = np.array([1e-3, 1e-2, 5e-2, size - 5e-2, size - 1e-2, size - 1e-3, size - STOP_SHORT_DEG])
    turns = np.unique(np.concatenate([even, near_ends]))
    turns = turns[(turns > 0.0) & (turns <= size - STOP_SHORT_DEG)]
    return np.asarray(np.sign(turn_deg) * turns)


def contact_components_along_turn(
    pair: Pair,
    rotation: Floats,
    translation: Floats,
    axis_point: Floats,
    axis_direction: Floats,
    turn_deg: float,
    exclude_points: Floats,
    steps: int = 40,
    at_ends: bool = True,
) -> EarlierComponent | None:
    """The first component seen strictly before the end of a turn that holds none of ``exclude_points``; None if none.

    Without ``at_ends`` those that reach an end without a face are passed over. The pose is that before the turn, the
    axis and the points (shape (n, 3), on the axis) are in the nut's frame.

    Raises:
        ValueError: an excluded point leaves one of the solids by more than 1e-7 of the nominal diameter, or the bolt
            is tilted by more than 25 deg.
    """
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    for turn in turns_to_look_at(turn_deg, steps):
        rot, t = turned_pose(rotation, translation, axis_point, axis_direction, float(turn))
        rot = np.ascontiguousarray(rot)
        check_tilt(rot)
        excluded = excluded_rows(rot, t, exclude_points)
        for theta, z, _ in excluded:
            gap = clearance(theta, min(z, 0.0), rot, t, bolt, nut)
            if gap < -1e-7 * pair.nominal_diameter:
                raise ValueError(f"excluded point at azimuth {theta} is {gap} outside at a turn of {turn} deg")
        depth, theta, z = free_component(rot, t, bolt, nut, excluded, at_ends)
        if depth > 0.0:
            x, y, height = (float(c) for c in witness(theta, z, rot, t, bolt, nut))
            return EarlierComponent(float(turn), (x, y, height), float(depth))
    return None
