"""The jamming diagram of a state at a friction (forces, section 3).

Loads are a push and, beside it, a force or a moment along two axes, all over the push; moments are over the nominal
radius too. The diagram is the set of those that the contacts can balance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from threadstate.errors import InvalidValueError
from threadstate.state.model import ContactState, Vector
from threadstate.statics.cone_reduction import ACTIVE, Block
from threadstate.statics.cone_slice import Slice, SliceEdge, SliceKind, cone_slice
from threadstate.statics.load import Load, checked_friction
from threadstate.statics.touching import touching
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

TOLERANCE = 1e-5
"""Gap, over the diagram's size, that is aimed at."""
FINEST, COARSEST = 1e-8, 0.1
LEAST_CORNERS = 3
"""Of a hull, whatever the tolerance."""


class Axis(StrEnum):
    """An axis of a jamming diagram: a force or a moment on the bolt, in the nut's frame."""

    FX = "fx"
    FY = "fy"
    MX = "mx"
    MY = "my"
    MZ = "mz"


_COMPONENTS = {Axis.MX: 0, Axis.MY: 1, Axis.MZ: 2, Axis.FX: 3, Axis.FY: 4}
DEFAULT_AXES = (Axis.FX, Axis.MY)


class Mode(StrEnum):
    """What a contact that carries a force does where the load begins to move the bolt."""

    STICKS = "sticks"
    SLIDES = "slides"


class Side(StrEnum):
    """Whither friction pushes the bolt, mostly: the side of the contact's friction cone, about the nut's axis."""

    UP = "up"
    DOWN = "down"
    OUT = "out"
    IN = "in"
    CCW = "ccw"
    CW = "cw"


@dataclass(frozen=True, slots=True)
class LoadedContact:
    """A contact that carries a force on a piece of the boundary.

    Attributes:
        contact: counts from 1: the state's contacts, then the hull of its patch.
        mode: where it slides its force is on the border of its friction cone.
        side: of the cone, half way along the piece; None where it sticks or has no friction.
        friction_start, friction_end: the directions of friction on the bolt at the piece's ends, of norm 1, in the
            nut's frame: the same on a straight piece.
    """

    contact: int
    mode: Mode
    side: Side | None
    friction_start: Vector | None
    friction_end: Vector | None


@dataclass(frozen=True, slots=True)
class Piece:
    """A piece of the boundary, counter-clockwise from a vertex to another; both are one at the end of a segment.

    Attributes:
        first, last: indices of vertices; ``last`` is less where the piece passes the last vertex.
        straight: whether it is a straight edge.
        window: whether it is a cut by the window, and no boundary of the diagram.
        contacts: that carry a force on it; all others carry none there.
    """

    first: int
    last: int
    straight: bool
    window: bool
    contacts: tuple[LoadedContact, ...]


@dataclass(frozen=True, slots=True)
class JammingDiagram:
    """The loads over their push that contacts can balance, in a plane of loads (forces, section 3).

    Attributes:
        axes: the axes of the plane; moments are over the nominal radius times the push.
        load: the load that lies in the plane, with the point about which moments are taken.
        load_at: where it lies.
        contacts: the numbers of those that are taken.
        kind, dimension: what the diagram is.
        vertices: shape (n, 2), read-only; counter-clockwise, of its boundary within the window.
        pieces: of the boundary; the ends of a segment.
        rays: shape (0, 1 or 2, 2), read-only; the extreme directions in which it goes on for ever.
        window: half widths, about (0, 0), of what is seen of an unbounded diagram.
        gap: the diagram reaches beyond the vertices' polygon by no more.
        wedged: contacts that can press against each other without any load.
        hull_gap: how far over the nominal radius the hull of a true patch may lie outside of the one of its contacts.
        penetrating: whether the solids overlap in the last pose: no forces can be real there.
    """

    mu: float
    axes: tuple[Axis, Axis]
    load: Load
    load_at: tuple[float, float]
    contacts: tuple[int, ...]
    kind: SliceKind
    dimension: int | None
    vertices: Floats
    pieces: tuple[Piece, ...]
    rays: Floats
    window: tuple[float, float] | None
    gap: float
    wedged: tuple[int, ...]
    hull_gap: float = 0.0
    penetrating: bool = False


def jamming_diagram(
    pair: Pair,
    state: ContactState,
    mu: float,
    axes: Sequence[str] = DEFAULT_AXES,
    *,
    load: Load | None = None,
    contacts: Sequence[int] | None = None,
    window: tuple[float, float] | None = None,
    tolerance: float = TOLERANCE,
) -> JammingDiagram:
    """The jamming diagram of a state at a friction; see :class:`JammingDiagram`.

    Args:
        pair: bolt and nut.
        state: one of its states.
        mu: coefficient of friction of all contacts.
        axes: two of ``fx``, ``fy``, ``mx``, ``my``, ``mz``.
        load: lies in the plane of loads; it must push along -z. The default is a push through the bolt's origin.
        contacts: some of the state's, from 1; by default all, of a level patch corners of its hull, outside of which
            the others lie by at most the tolerance times the nominal radius.
        window: half widths of what is seen of an unbounded diagram, in place of those that show its corners.
        tolerance: the gap that is aimed at, over the diagram's size.

    Raises:
        InvalidValueError: the friction, the axes, the load, a contact, the window or the tolerance is not valid.
        UnresolvedPoseError: a contact has no certain normal.
    """
    found = touching(pair, state)
    first = found.own if found.patch else 0
    radius = pair.nominal_diameter / 2.0
    left_out = 0.0
    if contacts is not None:
        numbers = tuple(contacts)
        for number in numbers:
            if not first < number <= len(found.points):
                raise InvalidValueError("contact", number, f"{first + 1} to {len(found.points)}")
    elif found.patch:
        kept, left_out = thinned(found.points[first:, :2], tolerance * radius)
        numbers = tuple(first + 1 + index for index in kept)
    else:
        numbers = tuple(range(1, len(found.points) + 1))
    rows = [number - 1 for number in numbers]
    load = load or Load()
    diagram = diagram_of_contacts(
        found.points[rows] / radius,
        found.normals[rows],
        mu,
        axes,
        load=replace(load, point=load.point or found.origin),
        radius=radius,
        numbers=numbers,
        window=window,
        tolerance=tolerance,
    )
    return replace(diagram, hull_gap=(found.gap + left_out) / radius, penetrating=found.penetrating)


def thinned(corners: Floats, most: float) -> tuple[list[int], float]:
    """Some of a convex polygon's corners (k, 2) so that the others lie at most ``most`` outside of theirs.

    Returns:
        Their indices, and how far outside the others lie.
    """
    count = len(corners)
    kept, farthest, start = [0], 0.0, 0
    while start < count:
        end, outside = start + 1, 0.0
        while end < count:
            reach = _reach(corners, start, end + 1)
            if reach > most:
                break
            end, outside = end + 1, reach
        farthest = max(farthest, outside)
        start = end
        kept.append(start)
    kept = [index for index in kept if index < count]
    if len(kept) < LEAST_CORNERS:
        return list(range(count)), 0.0
    return kept, farthest


def _reach(corners: Floats, start: int, end: int) -> float:
    """How far corners between two others of a polygon lie from the line through these."""
    first, last = corners[start], corners[end % len(corners)]
    along = last - first
    across = np.array([along[1], -along[0]]) / max(float(np.hypot(*along)), 1e-300)
    return float(np.abs((corners[start + 1 : end] - first) @ across).max(initial=0.0))


def diagram_of_contacts(
    points: Floats,
    normals: Floats,
    mu: float,
    axes: Sequence[str] = DEFAULT_AXES,
    *,
    load: Load | None = None,
    radius: float = 1.0,
    numbers: Sequence[int] | None = None,
    window: tuple[float, float] | None = None,
    tolerance: float = TOLERANCE,
) -> JammingDiagram:
    """The jamming diagram of given contacts, as :func:`jamming_diagram`.

    Args:
        points: shape (k, 3), over ``radius``.
        normals: shape (k, 3), into the bolt, of norm 1.
        mu: as there.
        axes: as there.
        load: as there, but that its moment is about (0, 0, 0) unless it has a point.
        radius: the length unit of the points, in that of the load.
        numbers: of the contacts; by default from 1.
        window: as there.
        tolerance: as there.
    """
    checked_friction(mu)
    chosen = checked_axes(axes)
    load = load or Load(point=(0.0, 0.0, 0.0))
    if not load.force[2] < 0.0:
        raise InvalidValueError("force", load.force, "a push: z below 0")
    if len(points) == 0:
        raise InvalidValueError("contacts", 0, "one at least")
    if window is not None and not all(0.0 < width < math.inf for width in window):
        raise InvalidValueError("window", window, "two finite numbers above 0")
    if not FINEST <= tolerance <= COARSEST:
        raise InvalidValueError("tolerance", tolerance, f"{FINEST!r} to {COARSEST!r}")
    point = load.point or (0.0, 0.0, 0.0)
    push = -load.force[2]
    base = np.array([*(moment / (radius * push) for moment in load.moment), *(force / push for force in load.force)])
    family = np.zeros((6, 3))
    family[:, 0] = base
    for column, axis in enumerate(chosen, 1):
        family[_COMPONENTS[axis], 0] = 0.0
        family[_COMPONENTS[axis], column] = 1.0
    scene = _Scene(points, normals, points - np.array(point) / radius, mu, tuple(numbers or range(1, len(points) + 1)))
    found = cone_slice(scene.blocks(), family, tolerance, window)
    return JammingDiagram(
        mu=mu,
        axes=chosen,
        load=replace(load, point=point),
        load_at=(float(base[_COMPONENTS[chosen[0]]]), float(base[_COMPONENTS[chosen[1]]])),
        contacts=scene.numbers,
        kind=found.kind,
        dimension=found.dimension,
        vertices=_read_only(np.array([edge.start for edge in found.edges]).reshape(-1, 2)),
        pieces=_pieces(found, scene),
        rays=_read_only(found.rays),
        window=None if found.window is None else (float(found.window[0]), float(found.window[1])),
        gap=found.gap,
        wedged=tuple(scene.numbers[owner] for owner in sorted(found.sticking)),
    )


def checked_axes(axes: Sequence[str]) -> tuple[Axis, Axis]:
    """The two axes of a diagram.

    Raises:
        InvalidValueError: they are not two different ones.
    """
    names = [axis.value for axis in Axis]
    if len(axes) != 2 or axes[0] == axes[1] or not set(axes) <= set(names):
        raise InvalidValueError("axes", ",".join(axes), f"two different ones of {', '.join(names)}")
    return Axis(axes[0]), Axis(axes[1])


@dataclass(frozen=True, slots=True)
class _Scene:
    """Contacts in the nut's frame and about the load's point, over the nominal radius."""

    points: Floats
    normals: Floats
    arms: Floats
    mu: float
    numbers: tuple[int, ...]

    def blocks(self) -> list[Block]:
        """The wrenches that the contacts can carry."""
        found = []
        for i, (arm, normal) in enumerate(zip(self.arms, self.normals, strict=True)):
            forces = [normal]
            if self.mu > 0.0:
                first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
                first /= np.linalg.norm(first)
                forces += [self.mu * first, self.mu * np.cross(normal, first)]
            found.append(Block(i, np.array([[*np.cross(arm, force), *force] for force in forces])))
        return found

    def frictions(self, edge: SliceEdge, sticking: frozenset[int]) -> dict[int, Floats | None]:
        """By contact that carries a force on an edge the direction of friction; zero without friction, None at rest."""
        velocities = edge.motion[3:] + np.cross(edge.motion[:3], self.arms)
        speeds = np.sqrt((velocities * velocities).sum(axis=1))
        forces = np.array([edge.forces.get(i, 0.0) for i in range(len(self.arms))])
        least = ACTIVE * forces.max()
        forces[list(sticking)] = math.inf
        found: dict[int, Floats | None] = {}
        for i in np.flatnonzero(forces > least).tolist():
            if self.mu == 0.0:
                found[i] = np.zeros(3)
            elif speeds[i] <= ACTIVE * speeds.max():
                found[i] = None
            else:
                across = velocities[i] - (velocities[i] @ self.normals[i]) * self.normals[i]
                found[i] = -across / math.hypot(*across)
        return found

    def side(self, contact: int, friction: Floats) -> Side:
        """The side of a contact's cone on which the force lies, by the direction of friction."""
        x, y, _ = self.points[contact]
        radial = math.hypot(x, y)
        outwards = np.array([x, y, 0.0]) / radial if radial > 0.0 else np.array([1.0, 0.0, 0.0])
        around = np.array([-outwards[1], outwards[0], 0.0])
        parts = [friction[2], friction @ outwards, friction @ around]
        most = int(np.argmax(np.abs(parts)))
        return ((Side.UP, Side.DOWN), (Side.OUT, Side.IN), (Side.CCW, Side.CW))[most][int(parts[most] < 0.0)]


def _pieces(found: Slice, scene: _Scene) -> tuple[Piece, ...]:
    """The edges in pieces: each straight edge is one, and so are the parts of a curve where the same contacts slide."""
    edges = found.edges
    if not edges:
        return ()
    frictions = [{} if edge.window else scene.frictions(edge, found.sticking) for edge in edges]
    if (found.dimension or 0) < 2:
        return tuple(_piece(scene, i, i, edge, frictions[i : i + 1]) for i, edge in enumerate(edges))
    labels = [
        (i if edge.straight else -1, edge.window, tuple((j, one is None) for j, one in friction.items()))
        for i, (edge, friction) in enumerate(zip(edges, frictions, strict=True))
    ]
    start = next((i for i in range(len(edges)) if labels[i] != labels[i - 1]), 0)
    order = [*range(start, len(edges)), *range(start)]
    pieces = []
    for _, run in groupby(order, key=lambda i: labels[i]):
        indices = list(run)
        last = (indices[-1] + 1) % len(edges)
        pieces.append(_piece(scene, indices[0], last, edges[indices[0]], [frictions[i] for i in indices]))
    return tuple(pieces)


def _piece(
    scene: _Scene, first: int, last: int, edge: SliceEdge, frictions: Sequence[dict[int, Floats | None]]
) -> Piece:
    contacts = []
    for i, start in frictions[0].items():
        middle, end = frictions[len(frictions) // 2][i], frictions[-1][i]
        if start is None or middle is None or end is None:
            contacts.append(LoadedContact(scene.numbers[i], Mode.STICKS, None, None, None))
        elif not middle.any():
            contacts.append(LoadedContact(scene.numbers[i], Mode.SLIDES, None, None, None))
        else:
            side = scene.side(i, middle)
            contacts.append(LoadedContact(scene.numbers[i], Mode.SLIDES, side, _vector(start), _vector(end)))
    return Piece(first, last, edge.straight, edge.window, tuple(contacts))


def _vector(row: Floats) -> Vector:
    x, y, z = row.tolist()
    return x, y, z


def _read_only(rows: Floats) -> Floats:
    array = np.array(rows, dtype=np.float64).reshape(-1, 2)
    array.setflags(write=False)
    return array
