"""The boxes with which a search begins: those that are dropped stay above the plane."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.contact.edges import new_edge, new_kept
from tests.contact.samples import Floats
from threadstate.contact._box_kernel import BOXES_SIZE, X_END, X_HALF, X_START, X_THETA
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import (
    M_SIGMA,
    MOTION_SIZE,
    PATH_SIZE,
    edge_point,
    position,
    set_path,
    set_path_from,
    velocity,
)
from threadstate.contact._initial_box_kernel import LONGEST, drop_above, heights_at, set_initial_boxes
from threadstate.contact._stage_kernel import rotation, set_motions
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.profile import Profile

PAIR = quarter_twenty_unc()


def random_edges(rng: np.random.Generator, *, is_turn: bool) -> list[tuple[Edge, Profile]]:
    """Both edges of a random motion of a bolt in its nut."""
    pose = np.zeros(12)
    tilt = 10.0 ** rng.uniform(-4.0, 0.0)
    rotation(*(tilt * rng.uniform(-1.0, 1.0, 2)), rng.uniform(-3.0, 3.0), pose)
    pose[9:] = rng.uniform(-0.1, 0.1, 3) * PAIR.thread_pitch
    axis = rng.normal(0.0, 1.0, 3) * (1.0, 1.0, rng.choice([0.01, 1.0]))
    axis = axis / np.linalg.norm(axis) if is_turn else np.array([0.0, 0.0, rng.choice([-1.0, 1.0])])
    point = rng.uniform(-1.0, 1.0, 3) * PAIR.bolt.major_diameter * (0.5, 0.5, 0.1)
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    set_motions(pose, is_turn, False, point, axis, bolt_motion, nut_motion)
    bolt, nut = PAIR.bolt.packed, PAIR.nut.packed
    return [
        (new_edge(bolt_motion, bolt, nut, new_kept(0)), PAIR.bolt),
        (new_edge(nut_motion, nut, bolt, new_kept(0)), PAIR.nut),
    ]


def lowest(edge: Edge, thetas: Floats, taus: Floats, is_turn: bool) -> float:
    """The least height above the plane, of these points at these times."""
    path, least = np.empty(PATH_SIZE), math.inf
    for theta in thetas.tolist():
        x, y, _, _ = edge_point(theta, edge.curve)
        set_path(x, y, edge.motion, path)
        least = min(least, *(edge.motion[M_SIGMA] * position(path, tau, is_turn)[2] for tau in taus.tolist()))
    return least


@pytest.mark.parametrize("is_turn", [False, True])
def test_what_is_dropped_stays_above_the_plane(is_turn: bool) -> None:
    rng = np.random.default_rng(19)
    boxes = np.zeros(BOXES_SIZE)
    above = dropped = looked_at = 0
    for _ in range(60):
        for edge, profile in random_edges(rng, is_turn=is_turn):
            since = 10.0 ** rng.uniform(-3.0, 0.0) if rng.random() < 0.5 else 0.0
            until = since + 10.0 ** rng.uniform(-4.0, math.log10(2.9))
            if not is_turn:
                since, until = since * profile.thread_pitch, until * profile.thread_pitch
            count = set_initial_boxes(since, until, boxes)
            every, half = boxes[X_THETA : X_THETA + count].copy(), boxes[X_HALF]
            left = boxes[X_THETA : X_THETA + drop_above(count, edge, boxes)].tolist()
            assert left == sorted(left) and set(left) <= set(every.tolist())
            assert set(boxes[X_START : X_START + len(left)]) <= {since}
            assert set(boxes[X_END : X_END + len(left)]) <= {until}
            for theta in every.tolist():
                least = lowest(edge, np.linspace(theta - half, theta + half, 9), np.linspace(since, until, 25), is_turn)
                above += least > 0.02 * profile.major_diameter
                looked_at += 1
                if theta not in left:
                    dropped += 1
                    assert least > 0.0
    assert looked_at == 60 * 2 * count
    assert dropped > 0.95 * above > 0.1 * looked_at


def test_heights_are_those_of_points_of_the_curves_plane() -> None:
    rng = np.random.default_rng(7)
    path = np.empty(PATH_SIZE)
    for is_turn in (False, True):
        for edge, _ in random_edges(rng, is_turn=is_turn):
            for tau in (0.0, 0.3, 2.0):
                heights = heights_at(tau, edge.motion)
                for x, y in ((0.0, 0.0), (0.1, -0.2), (-0.3, 0.05)):
                    set_path_from(x, y, 0.0, edge.motion, path)
                    assert heights[0] + x * heights[1] + y * heights[2] == pytest.approx(
                        position(path, tau, is_turn)[2], abs=1e-14
                    )
                    assert heights[3] + x * heights[4] + y * heights[5] == pytest.approx(
                        velocity(path, tau, is_turn)[2], abs=1e-14
                    )


def test_an_arc_that_dips_below_the_plane_within_the_span_is_not_dropped() -> None:
    """A bolt above the nut turns about its own y axis: by half of the turn its points at +x are lowest."""
    pose = np.zeros(12)
    rotation(0.0, 0.0, 0.0, pose)
    radius = PAIR.bolt.major_diameter / 2.0
    point, axis = np.array([0.0, 0.0, 2.0 * radius]), np.array([0.0, 1.0, 0.0])
    start = math.pi / 2.0 - 1.0
    bolt_motion, nut_motion = np.zeros(MOTION_SIZE), np.zeros(MOTION_SIZE)
    set_motions(pose, True, False, point, axis, bolt_motion, nut_motion)
    boxes = np.zeros(BOXES_SIZE)
    bolt_motion[11] = bolt_motion[15] = 0.8 * radius
    edge = new_edge(bolt_motion, PAIR.bolt.packed, PAIR.nut.packed, new_kept(0))
    count = set_initial_boxes(start, start + 2.0, boxes)
    half = boxes[X_HALF]
    ends = np.array([start, start + 2.0])
    assert lowest(edge, np.linspace(-half, half, 9), ends, True) > 0.0
    assert lowest(edge, np.linspace(-half, half, 9), np.linspace(start, start + 2.0, 9), True) < 0.0
    assert np.abs(boxes[X_THETA : X_THETA + drop_above(count, edge, boxes)]).min() <= half


def test_no_box_of_a_span_longer_than_half_a_turn_is_dropped() -> None:
    rng = np.random.default_rng(3)
    boxes = np.zeros(BOXES_SIZE)
    for is_turn in (False, True):
        edge, _ = random_edges(rng, is_turn=is_turn)[0]
        edge.motion[11] += 100.0 * PAIR.bolt.major_diameter
        count = set_initial_boxes(0.0, LONGEST + 0.1, boxes)
        assert drop_above(count, edge, boxes) == (count if is_turn else 0)
