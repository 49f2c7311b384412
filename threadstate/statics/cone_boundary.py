"""The boundary of a plane convex set by its supports, from inside and from outside."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from threadstate.statics.cone_chart import FLAT, Chart, Support
from threadstate.statics.cone_reduction import NEGLIGIBLE, Floats

SAME_POINT = 1e-10
"""Part of a slice's size within which two points are one."""
MORE_OPEN = 10.0
"""How often what one program leaves open is what it leaves open in another."""
UNEVEN = 0.02
"""A point that parts a chord more unevenly than that lies near a straight edge that smoothly joins a curve."""
SHARP = 0.05
"""Sine of the angle from which on two edges meet at a corner."""
SHORT = 1e-6
NEARLY_FLAT = 1e-7
"""Parts of a slice's size: an edge that is shorter is none; edges that bend by less may be one straight edge."""
BENT = 4.0
"""Bend of a curve's chord, over the gap of its halves, at which it need not be divided further."""
MOST_POINTS = 20_000

Place = Callable[[Floats], Floats]
"""From points (k, 2) of a chart to other coordinates of the plane; it takes lines to lines."""


@dataclass(frozen=True, slots=True)
class Edge:
    """A part of the boundary of a plane chart, counter-clockwise from start to end, in the chart's coordinates.

    ``support`` is one in a direction across it, ``corner`` one at its start; ``straight`` says that it is the line from
    start to end.
    """

    start: Floats
    end: Floats
    support: Support
    corner: Support
    straight: bool


def boundary(chart: Chart, place: Place, tolerance: float, first: Sequence[Floats] = ()) -> list[Edge]:
    """The boundary of a plane chart, refined until no part of it leaves the polygon by over ``tolerance`` of its size.

    Size and distances are those of the points' places. ``first`` are directions that are looked into before others.
    """
    angles = sorted({*(0.37 + math.pi / 2.0 * k for k in range(4)), *(math.atan2(y, x) % math.tau for x, y in first)})
    found = [chart.support(np.array([math.cos(angle), math.sin(angle)])) for angle in angles]
    points = np.array([support.point for support in found])
    scale = float(np.ptp(points, axis=0).max())
    allowed = 0.5 * tolerance * float(np.ptp(place(points), axis=0).max())
    edges: list[Edge] = []
    waiting: list[tuple[Support, Support] | Edge] = []
    waiting.extend(reversed(list(pairwise([*found, found[0]]))))
    asked = len(found)
    while waiting:
        item = waiting.pop()
        if isinstance(item, Edge):
            edges.append(item)
            continue
        a, b = item
        length, normal = _across(a.point, b.point)
        # Of one point that is found twice the difference is round-off, and has any direction.
        if length <= SAME_POINT * scale or _cross(a.direction, normal) <= 0.0 or _cross(normal, b.direction) <= 0.0:
            continue
        support = chart.support(normal)
        asked += 1
        height = support.value - float(normal @ a.point)
        straight = height <= FLAT * scale + MORE_OPEN * max(end.gap for end in (a, b, support))
        shares = [math.dist(support.point, end.point) / length for end in item]
        if straight or min(shares) <= SAME_POINT or asked >= MOST_POINTS:
            edges.append(Edge(a.point, b.point, support, a, straight))
            continue
        # A bend of many times the gap may be a corner: then both halves are straight edges with labels of their own.
        bend = _distance(*place(np.array([support.point, a.point, b.point])))
        near = bend <= BENT * allowed and max(shares) <= 1.0 - UNEVEN
        for start, end in ((support, b), (a, support)):
            done = near and _outer_gap(start, end, place) <= allowed
            waiting.append(Edge(start.point, end.point, support, start, False) if done else (start, end))
    return _sharpened(chart, _joined(chart, _sharpened(chart, edges, scale), scale), scale)


def _sharpened(chart: Chart, edges: list[Edge], scale: float) -> list[Edge]:
    """The edges without the shortest, and the vertices where they meet at an angle found again.

    A direction that is almost across an edge leaves open where along it a point lies; the one half way between two
    edges does not.
    """
    edges = [edge for edge in edges if math.dist(edge.start, edge.end) > SHORT * scale]
    corners = []
    for before, edge in zip(edges[-1:] + edges[:-1], edges, strict=True):
        middle = before.support.direction + edge.support.direction
        sharp = _cross(before.support.direction, edge.support.direction) > SHARP
        corners.append(chart.support(middle / math.hypot(*middle)) if sharp else edge.corner)
    return [
        replace(edge, start=corner.point, end=after.point, corner=corner)
        for edge, corner, after in zip(edges, corners, corners[1:] + corners[:1], strict=True)
    ]


def _joined(chart: Chart, edges: list[Edge], scale: float) -> list[Edge]:
    """The edges, those that are parts of one straight edge in one."""
    joined: list[Edge] = []
    # From a vertex on that is a corner, so that no straight edge is cut by the ends of the list.
    sharpest = max(range(len(edges)), key=lambda i: _cross(edges[i - 1].support.direction, edges[i].support.direction))
    for edge in edges[sharpest:] + edges[:sharpest]:
        if joined:
            length, normal = _across(joined[-1].start, edge.end)
            if length > 0.0 and abs(normal @ (edge.start - edge.end)) <= NEARLY_FLAT * scale:
                support = chart.support(normal)
                if support.value - float(normal @ edge.end) <= FLAT * scale + MORE_OPEN * support.gap:
                    joined[-1] = replace(joined[-1], end=edge.end, support=support, straight=True)
                    continue
        joined.append(edge)
    return joined


def outer_gap(edges: Sequence[Edge], place: Place) -> float:
    """How far the polygon of the supporting lines of edges reaches beyond that of the edges."""
    worst = 0.0
    for before, edge in zip([edges[-1], *edges[:-1]], edges, strict=True):
        corners = [_corner(before.support, edge.corner), _corner(edge.corner, edge.support)]
        first, vertex, last, *outer = place(np.array([before.start, edge.start, edge.end, *corners]))
        worst = max(worst, *(min(_distance(out, first, vertex), _distance(out, vertex, last)) for out in outer))
    return worst


def _outer_gap(a: Support, b: Support, place: Place) -> float:
    """How far the corner of two supporting lines is from the chord between their points."""
    start, end, corner = place(np.array([a.point, b.point, _corner(a, b)]))
    return _distance(corner, start, end)


def _corner(a: Support, b: Support) -> Floats:
    """Where two supporting lines meet; parallel ones: the point of one of them."""
    turn = _cross(a.direction, b.direction)
    if turn <= NEGLIGIBLE:
        return a.point + (a.value - a.direction @ a.point) * a.direction
    return (a.value * _right(b.direction) - b.value * _right(a.direction)) / turn


def _distance(point: Floats, start: Floats, end: Floats) -> float:
    """The distance of a point from the line between two others."""
    along = end - start
    squared = float(along @ along)
    share = min(max(float(along @ (point - start)) / squared, 0.0), 1.0) if squared > 0.0 else 0.0
    return math.dist(point, start + share * along)


def _across(start: Floats, end: Floats) -> tuple[float, Floats]:
    """The length of a chord, and the direction to its right; zero without length."""
    length = math.dist(start, end)
    return length, _right(end - start) / length if length > 0.0 else np.zeros(2)


def _right(vector: Floats) -> Floats:
    return np.array([vector[1], -vector[0]])


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
