"""Jamming diagrams against Whitney's vertices, the verdicts of the statics and laws (forces, sections 3 and 6)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from oracle.statics import friction as witness
from oracle.statics.wrenches import Wrench
from tests.statics.test_check_values import hold
from tests.statics.test_friction import scenes
from threadstate.errors import InvalidValueError
from threadstate.state.model import ContactState
from threadstate.state.solve import solve_poses
from threadstate.statics._cone_kernel import boundary_step
from threadstate.statics.cone_slice import SliceKind
from threadstate.statics.jamming import JammingDiagram, Mode, Side, diagram_of_contacts, jamming_diagram, thinned
from threadstate.statics.load import Load
from threadstate.statics.solve import statics_of
from threadstate.statics.touching import touching
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

Floats = NDArray[np.float64]

PAIR = quarter_twenty_unc()
RADIUS = PAIR.nominal_diameter / 2.0
UP = (0.0, 0.0, 1.0)
MU = 0.3
TIP_LEFT, TIP_RIGHT = ((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)), ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0))
RIM_LEFT, RIM_RIGHT = ((-1.0, 0.0, 1.0), (1.0, 0.0, 0.0)), ((1.0, 0.0, 1.0), (-1.0, 0.0, 0.0))
"""Point and normal of a peg's contacts in Whitney's approximation, d = 10 and l = 5 mm, over the radius."""
Contact = tuple[tuple[float, float, float], tuple[float, float, float]]


@cache
def states() -> tuple[ContactState, ContactState, ContactState]:
    """A state of three contacts, one of two, and one that lies on a level patch."""
    three, two, patch = solve_poses(PAIR, [(1, -2, 10), (0, -4, 10), (4, 0, 185)])
    return three, two, patch


def diagram(contacts: Sequence[Contact], mu: float, *axes: str, **options: Any) -> JammingDiagram:
    """The diagram of contacts, given as pairs of point and normal."""
    points, normals = np.array(contacts).transpose(1, 0, 2)
    return diagram_of_contacts(points.copy(), normals.copy(), mu, axes or ("fx", "my"), **options)


def depth(vertices: Floats, point: Floats) -> float:
    """How deep a point lies inside a convex polygon, counter-clockwise; negative outside of one of its lines."""
    along = np.roll(vertices, -1, axis=0) - vertices
    to = point - vertices
    return float(((along[:, 0] * to[:, 1] - along[:, 1] * to[:, 0]) / np.hypot(*along.T)).min())


def farthest(found: JammingDiagram) -> Floats:
    """How far a polygon reaches in 64 directions."""
    angles = np.linspace(0.0, math.tau, 64, endpoint=False)
    reach: Floats = (found.vertices @ [np.cos(angles), np.sin(angles)]).max(axis=0)
    return reach


def test_a_pegs_states_have_whitneys_vertices() -> None:
    """Whitney's z points into the hole: his y, and with it his moment, is minus ours."""
    slope = 5.0 / (10.0 * MU)
    corners = {
        (TIP_RIGHT, RIM_LEFT): [(1 / MU, -1.0), (-1 / MU, 2 * slope + 1)],
        (TIP_LEFT, RIM_RIGHT): [(-1 / MU, 1.0), (1 / MU, -2 * slope - 1)],
        (TIP_RIGHT, RIM_RIGHT): [(1 / MU, -1.0), (1 / MU, -2 * slope - 1)],
        (TIP_LEFT, RIM_LEFT): [(-1 / MU, 1.0), (-1 / MU, 2 * slope + 1)],
    }
    assert slope == pytest.approx(5.0 / 3.0)
    for contacts, expected in corners.items():
        found = diagram(contacts, MU)
        assert (found.kind, found.dimension) == (SliceKind.UNBOUNDED, 2)
        (edge,) = (piece for piece in found.pieces if {one.side for one in piece.contacts} == {Side.UP})
        assert edge.straight
        assert [one.contact for one in edge.contacts] == [1, 2]
        assert found.gap < 1e-9
        # Inside Whitney's parallelogram the peg slides in: no state holds it.
        assert depth(found.vertices, np.zeros(2)) < -1.0
        ends = found.vertices[[edge.first, edge.last]] * [1.0, -1.0]
        assert np.abs(np.sort(ends, axis=0) - np.sort(np.array(expected), axis=0)).max() < 1e-9
        others = [piece for piece in found.pieces if not piece.window and piece is not edge]
        # Beyond its ends one contact alone carries the load: the peg tips about it.
        assert sorted(one.contact for piece in others for one in piece.contacts) == [1, 2]
        assert {one.mode for piece in others for one in piece.contacts} == {Mode.STICKS}


def random_points(found: JammingDiagram, count: int) -> Iterator[tuple[Floats, bool]]:
    """Points in and about a diagram, and whether they lie in it; none that are near its boundary."""
    low, high = found.vertices.min(axis=0), found.vertices.max(axis=0)
    rng = np.random.default_rng(5)
    for point in rng.uniform(low - 0.2 * (high - low), high + 0.2 * (high - low), (count, 2)):
        inside = depth(found.vertices, point)
        seen = found.window is None or (np.abs(point) <= found.window).all()
        if seen and abs(inside) > 2.0 * found.gap:
            yield point, inside > 0.0


def test_a_diagram_holds_what_the_statics_hold() -> None:
    three, two, _ = states()
    for mu, axes in ((0.3, ("fx", "my")), (0.5, ("my", "mz")), (1.2, ("fy", "mx"))):
        found = jamming_diagram(PAIR, three, mu, axes, tolerance=1e-3)
        outcomes = []
        for point, inside in random_points(found, 40):
            statics = statics_of(PAIR, three, load_at(axes, point), mu)
            assert (statics.hold.upper <= mu) == inside, (mu, axes, point)
            outcomes.append(inside)
        assert set(outcomes) == {False, True}
    segment = jamming_diagram(PAIR, two, 0.5)
    assert segment.kind is SliceKind.SEGMENT
    for share in (-0.01, 0.01, 0.5, 0.99, 1.01):
        point = (1.0 - share) * segment.vertices[0] + share * segment.vertices[1]
        statics = statics_of(PAIR, two, load_at(("fx", "my"), point), 0.5)
        assert (statics.hold.upper <= 0.5) == (0.0 < share < 1.0)


def test_a_patch_holds_what_the_witness_holds() -> None:
    patch = states()[2]
    touched = touching(PAIR, patch)
    rows = list(range(touched.own, len(touched.points), 15))
    x, y, z = touched.points[rows].mean(axis=0).tolist()
    points, normals = touched.points[rows] - [x, y, z], touched.normals[rows]
    for axes in (("fx", "my"), ("fx", "mx"), ("fy", "mz")):
        found = jamming_diagram(
            PAIR,
            patch,
            0.2,
            axes,
            load=Load(point=(x, y, z)),
            contacts=[row + 1 for row in rows],
            tolerance=1e-3,
        )
        outcomes = []
        for point, inside in random_points(found, 10):
            load = load_at(axes, point)
            bounds = witness.hold_friction(points, normals, Wrench.of(load.force, load.moment), RADIUS)
            assert (bounds.upper is not None and bounds.upper <= 0.2) == inside, (axes, point)
            outcomes.append(inside)
        assert set(outcomes) == {False, True}


def load_at(axes: Sequence[str], point: Floats) -> Load:
    """A push of 1 N with what a point of the diagram adds."""
    parts = dict.fromkeys(("fx", "fy", "mx", "my", "mz"), 0.0) | dict(zip(axes, point.tolist(), strict=True))
    moment = (parts["mx"] * RADIUS, parts["my"] * RADIUS, parts["mz"] * RADIUS)
    return Load((parts["fx"], parts["fy"], -1.0), moment)


@pytest.mark.parametrize(("contacts", "mu"), [(3, 0.4), (3, 1.0), (4, 0.2), (5, 0.4), (5, 2.0)])
def test_both_sides_of_the_boundary_of_random_contacts(contacts: int, mu: float) -> None:
    """A thousandth of its size inside a middle of an edge the load is held, outside it is not."""
    kinds = set()
    for points, normals, _ in scenes(6, contacts, seed=100 + contacts):
        found = diagram_of_contacts(points, normals, mu, tolerance=1e-4)
        kinds.add(found.kind)
        if found.dimension != 2 or not len(found.vertices):
            continue
        size = np.ptp(found.vertices, axis=0).max()
        assert found.gap <= 2e-4 * size
        for piece in found.pieces[:6]:
            start, end = found.vertices[piece.first], found.vertices[(piece.first + 1) % len(found.vertices)]
            along = (end - start) / math.dist(start, end)
            for side in (-1.0, 1.0):
                x, y = 0.5 * (start + end) + side * 1e-3 * size * np.array([along[1], -along[0]])
                if found.window is not None and (abs(x) > found.window[0] or abs(y) > found.window[1]):
                    continue
                _, _, upper = hold(np.array([0.0, y, 0.0, x, 0.0, -1.0]), points, normals)
                assert (upper <= mu) == (side < 0.0)
    assert SliceKind.BOUNDED in kinds or mu > 0.5


def test_it_grows_with_friction() -> None:
    three, _, patch = states()
    for state, axes in ((three, ("fx", "my")), (patch, ("fx", "mx"))):
        reach = [farthest(jamming_diagram(PAIR, state, mu, axes, tolerance=1e-3)) for mu in (0.2, 0.3, 0.45)]
        for less, more in pairwise(reach):
            assert (less <= more + 2e-3).all()
            assert less.sum() < more.sum() - 1e-2


def test_neither_the_order_of_contacts_nor_the_unit_matters() -> None:
    for points, normals, _ in scenes(4, 4, seed=31):
        given = diagram_of_contacts(points, normals, 0.5, tolerance=1e-4)
        other = diagram_of_contacts(points[::-1].copy(), normals[::-1].copy(), 0.5, tolerance=1e-4)
        assert given.kind is other.kind
        if given.kind is SliceKind.BOUNDED:
            assert np.abs(farthest(given) - farthest(other)).max() <= given.gap + other.gap
    load = Load((0.1, 0.2, -3.0), (0.01, 0.02, 0.03), (0.03, 0.01, 0.02))
    in_mm = Load(load.force, (0.254, 0.508, 0.762), (0.762, 0.254, 0.508))
    points, normals, _ = scenes(1, 5, seed=3)[0]
    inches = diagram_of_contacts(points, normals, 0.5, load=load, radius=0.125, tolerance=1e-4)
    assert inches.load_at == pytest.approx((0.1 / 3.0, 0.02 / 0.375))
    millimetres = diagram_of_contacts(points, normals, 0.5, load=in_mm, radius=3.175, tolerance=1e-4)
    assert inches.kind is millimetres.kind is SliceKind.BOUNDED
    assert np.abs(farthest(inches) - farthest(millimetres)).max() <= inches.gap + millimetres.gap


def test_mirrored_contacts_have_the_mirrored_diagram() -> None:
    mirror = np.array([-1.0, 1.0, 1.0])
    swapped = {Side.CW: Side.CCW, Side.CCW: Side.CW}
    points, normals, _ = scenes(1, 5, seed=3)[0]
    given = diagram_of_contacts(points, normals, 0.5)
    other = diagram_of_contacts(points * mirror, normals * mirror, 0.5)
    assert given.kind is SliceKind.BOUNDED
    assert np.abs(farthest(given) - np.roll(farthest(other), 32)).max() <= given.gap + other.gap
    labels = [
        {(one.contact, one.side) for piece in found.pieces if piece.straight for one in piece.contacts if one.side}
        for found in (given, other)
    ]
    assert labels[0]
    assert labels[0] == {(contact, swapped.get(side, side)) for contact, side in labels[1]}


def test_every_kind_has_its_name() -> None:
    floor: Contact = ((0.5, 0.0, 0.0), UP)
    aside: Contact = ((0.5, 0.2, 0.0), UP)
    walls: list[Contact] = [((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)), ((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0))]
    legs: list[Contact] = [((1.0, 0.0, 0.0), UP), ((-0.5, 0.9, 0.0), UP), ((-0.5, -0.9, 0.0), UP)]
    middle: Contact = ((0.0, 0.0, 0.0), UP)
    above: Contact = ((0.0, 0.0, 0.0), (0.0, 0.0, -1.0))
    for contacts, mu, axes, kind, dimension in (
        ([aside], MU, ("fx", "my"), SliceKind.EMPTY, None),
        ([above], MU, ("fx", "my"), SliceKind.EMPTY, None),
        ([middle], 0.0, ("mx", "my"), SliceKind.POINT, 0),
        ([floor], 0.0, ("fx", "my"), SliceKind.POINT, 0),
        ([floor], MU, ("fx", "my"), SliceKind.SEGMENT, 1),
        (legs, 0.0, ("fx", "my"), SliceKind.SEGMENT, 1),
        (legs, 0.0, ("mx", "my"), SliceKind.BOUNDED, 2),
        ([middle], MU, ("fx", "fy"), SliceKind.BOUNDED, 2),
        ([*walls, middle], 0.0, ("fx", "my"), SliceKind.UNBOUNDED, 1),
        ([walls[0], middle], 0.0, ("fx", "my"), SliceKind.UNBOUNDED, 1),
        ([TIP_RIGHT, RIM_LEFT], MU, ("fx", "my"), SliceKind.UNBOUNDED, 2),
        ([*walls, *legs], 0.0, ("fx", "my"), SliceKind.UNBOUNDED, 2),
        ([TIP_RIGHT, RIM_LEFT], 0.6, ("fx", "my"), SliceKind.PLANE, 2),
    ):
        found = diagram(contacts, mu, *axes)
        assert (found.kind, found.dimension) == (kind, dimension), (contacts, mu, axes)
        assert np.isfinite(found.vertices).all()
        assert np.isfinite(found.gap)


def test_shapes_in_closed_form() -> None:
    assert diagram([((0.5, 0.0, 0.0), UP)], 0.0).vertices == pytest.approx(np.array([[0.0, 0.5]]), abs=1e-12)
    ends = diagram([((0.5, 0.0, 0.0), UP)], MU).vertices
    assert sorted(ends[:, 0].tolist()) == pytest.approx([-MU, MU], abs=1e-12)
    circle = diagram([((0.0, 0.0, 0.0), UP)], MU, "fx", "fy")
    assert np.abs(np.hypot(*circle.vertices.T) - MU).max() < 1e-9
    (piece,) = circle.pieces
    assert (piece.straight, [one.mode for one in piece.contacts]) == (False, [Mode.SLIDES])
    assert np.diff(farthest(circle)).max() <= circle.gap <= 1e-5 * 2.0 * MU
    line = diagram([((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)), ((0.0, 0.0, 0.0), UP)], 0.0)
    assert line.rays == pytest.approx(np.array([[1.0, 0.0]]), abs=1e-9)
    strip = diagram(
        [
            ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)),
            ((-1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
            *(((x, 0.0, 0.0), UP) for x in (-0.5, 0.7)),
        ],
        0.0,
    )
    assert strip.wedged == (1, 2)
    assert np.abs(strip.rays[:, 0]) == pytest.approx([1.0, 1.0])
    assert {round(float(y), 9) for y in strip.vertices[:, 1]} == {-0.5, 0.7}


def test_a_patch_slides_as_a_whole_and_tips_about_its_hull() -> None:
    patch = states()[2]
    found = jamming_diagram(PAIR, patch, 0.1)
    assert np.sort(found.vertices[:, 0]) == pytest.approx([-0.1, -0.1, 0.1, 0.1], abs=1e-7)
    modes = [{one.mode for one in piece.contacts} for piece in found.pieces]
    assert sorted(map(sorted, modes)) == [[Mode.SLIDES], [Mode.SLIDES], [Mode.STICKS], [Mode.STICKS]]
    assert found.hull_gap > 0.0
    assert found.contacts[0] == len(patch.contacts) + 1


def test_corners_of_a_hull_are_left_out_within_the_tolerance() -> None:
    turns = np.linspace(0.0, 2.0 * math.pi, 180, endpoint=False)
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    for most in (1e-6, 1e-3, 1e-2):
        kept, outside = thinned(circle, most)
        corners = circle[kept]
        assert outside <= most
        assert min(depth(corners, point) for point in circle) == pytest.approx(-outside, abs=1e-12)
    assert thinned(circle, 1e-6) == (list(range(180)), 0.0)
    assert len(thinned(circle, 1e-2)[0]) == pytest.approx(math.pi / math.sqrt(2e-2), abs=2.0)
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    assert thinned(square, 0.5) == ([0, 1, 2, 3], 0.0)
    assert thinned(square[:3], 10.0) == ([0, 1, 2], 0.0)


def test_a_coarse_diagram_of_a_patch_lies_within_the_fine_one() -> None:
    _, _, patch = states()
    fine, coarse = (jamming_diagram(PAIR, patch, MU, ("mx", "my"), tolerance=one) for one in (1e-5, 1e-2))
    assert len(coarse.contacts) < len(fine.contacts) / 5
    assert coarse.hull_gap > fine.hull_gap
    assert all(depth(fine.vertices, point) > -1e-9 for point in coarse.vertices)
    assert all(depth(coarse.vertices, point) > -coarse.hull_gap - 1e-2 for point in fine.vertices)


def test_a_window_is_as_wide_as_asked() -> None:
    found = diagram([TIP_RIGHT, RIM_LEFT], MU, window=(2.0, 9.0))
    assert found.window == (2.0, 9.0)
    assert np.abs(found.vertices).max(axis=0) == pytest.approx([2.0, 9.0])
    assert sum(not piece.window for piece in found.pieces) == 1


def test_what_is_not_valid_is_named() -> None:
    three = states()[0]
    for options, message in (
        ({"mu": -0.1}, "mu is -0.1"),
        ({"mu": math.inf}, "mu is inf"),
        ({"axes": ("fx", "fx")}, "axes is 'fx,fx'; valid: two different ones of fx, fy, mx, my, mz"),
        ({"axes": ("fx", "fz")}, "axes is 'fx,fz'"),
        ({"contacts": (4,)}, "contact is 4; valid: 1 to 3"),
        ({"contacts": ()}, "contacts is 0"),
        ({"load": Load((0.0, 0.0, 1.0))}, "force is"),
        ({"window": (0.0, 1.0)}, "window is"),
        ({"tolerance": 1.0}, "tolerance is 1.0"),
    ):
        with pytest.raises(InvalidValueError) as raised:
            jamming_diagram(PAIR, three, **{"mu": 0.2, **options})  # type: ignore[arg-type]
        assert message in str(raised.value)


def test_a_step_through_the_apex_of_a_cone_ends_there() -> None:
    """By round-off the square of the half distance of both roots may be negative, where they coincide."""
    rng = np.random.default_rng(0)
    for _ in range(1000):
        point = np.array([rng.uniform(0.1, 10.0), *rng.normal(size=2) * 1e-19])
        direction = np.array([-rng.uniform(0.1, 10.0), *rng.normal(size=2) * 1e-19])
        assert boundary_step(point, direction, 0, 3) == pytest.approx(-point[0] / direction[0], rel=1e-6)
