"""The slice of a cone of wrenches by a plane of loads: its kind, its boundary, and where it goes on for ever.

The slice is the set of (x, y) for which minus the load ``w0 + x a + y b`` lies in the cone (see ``cone_reduction``). Of
the cone of (s, x, y) the points with s = 0 are the directions in which the slice goes on for ever; a chart that holds
them too tells the kind, and a window cuts an unbounded slice to a bounded one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from threadstate.statics.cone_boundary import SAME_POINT, Edge, boundary, outer_gap
from threadstate.statics.cone_chart import Chart, bounded_chart
from threadstate.statics.cone_reduction import ACTIVE, CONSTANT, Block, Floats, Reduced, reduced, row_space

COARSE = 1e-2
"""Tolerance at which it is found out where a slice goes on for ever."""
FAR = 100.0
"""Corners that are so many times farther off than the nearest are not shown unasked."""
INFINITE = 1e-9
"""A load of norm 1 with less of the constant load is at infinity."""


class SliceKind(StrEnum):
    """What the slice of a cone by a plane of loads is."""

    EMPTY = "empty"
    POINT = "point"
    SEGMENT = "segment"
    BOUNDED = "bounded"
    """A bounded set with an inside."""
    UNBOUNDED = "unbounded"
    """A half-line, a line, or a set with an inside that goes on for ever but is not the plane."""
    PLANE = "plane"


@dataclass(frozen=True, slots=True)
class SliceEdge:
    """A part of the boundary of a slice, counter-clockwise from start to end; both are one at the end of a segment.

    Attributes:
        start, end: shape (2).
        straight: whether it is the line from start to end.
        window: whether it is a cut by the window, and no boundary of the slice.
        motion: shape (n); a motion that no block withstands and that does no work on the loads of the edge.
        forces: by owner of a block, how much its force has along the axis of its cone somewhere on the edge.
    """

    start: Floats
    end: Floats
    straight: bool
    window: bool
    motion: Floats
    forces: dict[int, float]


@dataclass(frozen=True, slots=True)
class Slice:
    """The slice of a cone by a plane of loads, within a window where it goes on for ever.

    Attributes:
        kind: what it is.
        dimension: 0, 1 or 2; None where it is empty.
        edges: its boundary; the ends of a segment; one for a point; none where it is empty, the plane, or not seen.
        rays: shape (0, 1 or 2, 2); the extreme directions, of norm 1, in which it goes on for ever.
        window: shape (2), half widths of what is looked at about (0, 0); None where the slice is bounded.
        gap: no point of the slice within the window is farther from the edges' polygon.
        sticking: owners of the blocks that wedge.
    """

    kind: SliceKind
    dimension: int | None
    edges: tuple[SliceEdge, ...]
    rays: Floats
    window: Floats | None
    gap: float
    sticking: frozenset[int]


def cone_slice(
    blocks: Sequence[Block], loads: Floats, tolerance: float, window: tuple[float, float] | None = None
) -> Slice:
    """The slice of the blocks' cone by a family of loads of shape (n, 3); see the module.

    ``tolerance`` is the gap that is aimed at, over the size of what is seen; ``window`` replaces the half widths that
    are chosen where the slice goes on for ever.
    """
    cone = reduced(*_extended(blocks, loads, None))
    if cone is None:
        return Slice(SliceKind.EMPTY, None, (), np.zeros((0, 2)), None, 0.0, frozenset())
    kind, rays, corners = _extent(cone)
    widths = None
    if kind in (SliceKind.UNBOUNDED, SliceKind.PLANE):
        widths = _wide_enough(corners) if window is None else np.array(window)
        seen = reduced(*_extended(blocks, loads, widths))
    else:
        seen = cone
    edges, gap = (
        _traced(seen, loads.shape[0], tolerance) if seen is not None and kind is not SliceKind.PLANE else ([], 0.0)
    )
    return Slice(kind, cone.family.shape[1] - 1, tuple(edges), rays, widths, gap, cone.sticking)


def _extent(cone: Reduced) -> tuple[SliceKind, Floats, Floats]:
    """The kind of a slice, the extreme directions in which it goes on for ever, and points to look at if it does."""
    across, along = row_space(cone.loads)
    lines = (cone.family @ along).T[:, 1:]
    dimension = cone.family.shape[1] - 1
    middle = cone.family @ cone.inner_load
    around = (middle[1:] / middle[0])[np.newaxis]
    if len(lines) == 2:
        return SliceKind.PLANE, np.zeros((0, 2)), np.zeros((1, 2))
    if dimension == 0:
        return SliceKind.POINT, np.zeros((0, 2)), around
    if across.shape[1] == 1:
        return SliceKind.UNBOUNDED, np.vstack([-lines, lines]), _nearest_of(around, lines)
    chart = bounded_chart(cone)
    if across.shape[1] == 2:
        seen = chart.loads(np.array([chart.support(np.array([side])).point for side in (-1.0, 1.0)]))
        points, rays = _points_and_rays(seen)
        if dimension == 2:
            return SliceKind.UNBOUNDED, np.vstack([-lines, lines]), _nearest_of(points, lines)
        return SliceKind.UNBOUNDED if len(rays) else SliceKind.SEGMENT, rays, points
    inwards = -chart.axes.T @ cone.family[0]
    edges = boundary(chart, np.asarray, COARSE, [inwards] if inwards.any() else [])
    points, rays = _points_and_rays(chart.loads(np.array([edge.start for edge in edges])))
    if len(rays) == 0:
        return SliceKind.BOUNDED, rays, points
    straight = [end for edge in edges if edge.straight for end in (edge.start, edge.end)]
    corners, _ = _points_and_rays(chart.loads(np.array(straight).reshape(-1, 2)))
    return SliceKind.UNBOUNDED, _extremes(rays), np.vstack([corners, points[np.argmin(np.hypot(*points.T))]])


def _traced(cone: Reduced, n: int, tolerance: float) -> tuple[list[SliceEdge], float]:
    """The boundary of a bounded slice, and how far it may be from the edges' polygon."""
    if cone.family.shape[1] == 1:
        middle = cone.family @ cone.inner_load
        point = middle[1:] / middle[0]
        forces = _forces(cone, cone.inner_forces / middle[0])
        return [SliceEdge(point, point, True, False, np.zeros(n), forces)], 0.0
    chart = bounded_chart(cone)
    if cone.family.shape[1] == 2:
        ends = [chart.support(np.array([side])) for side in (-1.0, 1.0)]
        outer = chart.places(np.array([end.value * end.direction for end in ends]))
        gap = float(np.hypot(*(outer - chart.places(np.array([end.point for end in ends]))).T).max())
        edges = [Edge(end.point, end.point, end, end, True) for end in ends]
        return [_slice_edge(chart, edge, edge, n) for edge in edges], gap
    edges = boundary(chart, chart.places, tolerance)
    found = [_slice_edge(chart, edge, after, n) for edge, after in zip(edges, edges[1:] + edges[:1], strict=True)]
    return found, outer_gap(edges, chart.places)


def _slice_edge(chart: Chart, edge: Edge, after: Edge, n: int) -> SliceEdge:
    """An edge of the boundary, with the one after it."""
    cone = chart.cone
    start, end = chart.places(np.array([edge.start, edge.end]))
    motion = cone.motions @ edge.support.motion
    window = bool(np.abs(motion[:n]).max() <= ACTIVE * np.abs(motion).max())
    # Along a straight edge forces pass from those at its start to those at its end.
    forces = 0.5 * (edge.corner.forces + after.corner.forces) if edge.straight else edge.support.forces
    return SliceEdge(start, end, edge.straight, window, motion[:n], _forces(cone, forces))


def _forces(cone: Reduced, forces: Floats) -> dict[int, float]:
    heads = np.cumsum([0, *cone.sizes[:-1]])
    return {block.owner: float(forces[head]) for block, head in zip(cone.blocks, heads, strict=True)}


def _nearest_of(points: Floats, lines: Floats) -> Floats:
    """The points nearest to (0, 0) of lines through points, all along one direction."""
    return points - (points @ lines.T) @ lines


def _wide_enough(corners: Floats) -> Floats:
    """Half widths of a window that shows the corners but those far off."""
    distances = np.hypot(*corners.T)
    near = np.abs(corners[distances <= FAR * (1.0 + distances.min())]).max(axis=0)
    return 1.5 * np.maximum(near, max(0.5 * near.max(), 0.5))


def _extremes(rays: Floats) -> Floats:
    """The two of some directions within a half turn that are farthest apart; one if all are the same."""
    i, j = np.unravel_index(np.argmin(rays @ rays.T), (len(rays), len(rays)))
    if rays[i] @ rays[j] >= 1.0 - SAME_POINT:
        return rays[:1]
    return rays[[i, j]] if rays[i, 0] * rays[j, 1] > rays[i, 1] * rays[j, 0] else rays[[j, i]]


def _extended(blocks: Sequence[Block], loads: Floats, window: Floats | None) -> tuple[list[Block], Floats]:
    """The blocks with those that keep s from being negative and x and y within a window: each a wrench of its own."""
    bounds = [[-1.0, 0.0, 0.0]]
    if window is not None:
        bounds += [[-window[0], 1.0, 0.0], [-window[0], -1.0, 0.0], [-window[1], 0.0, 1.0], [-window[1], 0.0, -1.0]]
    n, more = loads.shape[0], len(bounds)
    units = np.eye(n + more)[n:]
    extended = [Block(block.owner, np.hstack([block.rows, np.zeros((len(block.rows), more))])) for block in blocks]
    extended += [Block(CONSTANT - i, row[np.newaxis]) for i, row in enumerate(units)]
    return extended, np.vstack([loads, bounds])


def _points_and_rays(loads: Floats) -> tuple[Floats, Floats]:
    """Of loads (s, x, y) the points (x, y) over s, and the directions of those at infinity."""
    far = loads[:, 0] <= INFINITE * np.linalg.norm(loads, axis=1)
    rays = loads[far, 1:]
    return loads[~far, 1:] / loads[~far, :1], rays / np.linalg.norm(rays, axis=1)[:, np.newaxis]
