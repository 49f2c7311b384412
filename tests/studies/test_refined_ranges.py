"""Ranges about middles in sums of two doubles, beside ball arithmetic: they hold, and faults in them are found."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import chain

import numpy as np
import pytest
from flint import arb

from studies.certificate.audit import CORNERS, Evaluation, Outcome, Quantities, audit, contradicted, middle_values
from studies.certificate.bounds import COMPILED, Claims, Kernels, claims
from studies.certificate.cases import FORMS, STAGES, Box, Search, random_box, random_search
from studies.certificate.placements import cross
from studies.certificate.profiles import BallProfile, profile_half
from tests.contact.edges import new_edge, new_kept
from threadstate.contact import _refined_edge_kernel as refined
from threadstate.contact._edge_kernel import Edge
from threadstate.contact._geometry_kernel import M_ROUNDED
from threadstate.contact._wide_kernel import WIDE_MOTION_SIZE
from threadstate.thread import _profile_kernel as pk
from threadstate.thread.profile import Profile

WIDEST = 2.0**-3
"""Half-width (rad) of the widest boxes of a search."""


def two_doubles(number: arb) -> tuple[float, float]:
    """The nearest sum of two doubles."""
    high = float(number.mid())
    return high, float((number - arb(high)).mid())


def packed_in_balls(profile: Profile) -> BallProfile:
    """A profile in balls with the flanks that the solver has: their slopes are doubles."""
    packed = profile.packed
    rising, falling = (profile_half(profile, 1 / arb(float(packed[pk.COT + half]))) for half in (0, pk.FALLING))
    return BallProfile(rising, falling, arb(profile.thread_pitch), arb(profile.lead) / (2 * arb.pi()))


def with_packed_profiles(search: Search) -> Search:
    """The same motion, in balls that hold the solver's thread."""
    curve, solid = packed_in_balls(search.curve), packed_in_balls(search.solid)
    return replace(search, balls=replace(search.balls, curve=curve, solid=solid))


def refined_edge(one: Box) -> Edge:
    """The edge of a box with the motion that the balls have, in sums of two doubles."""
    search = one.search
    x, y = search.balls.columns
    rows = np.array([[two_doubles(v) for v in vector] for vector in (x, y, cross(x, y))]).swapaxes(0, 1)
    wide = np.empty((WIDE_MOTION_SIZE, 2))
    wide[:9] = rows.reshape(9, 2)
    for i, vector in enumerate((search.balls.origin, search.balls.point, search.balls.axis)):
        wide[9 + 3 * i : 12 + 3 * i] = [two_doubles(v) for v in vector]
    motion = search.motion.copy()
    motion[M_ROUNDED] = 1.0
    edge = new_edge(motion, search.curve.packed, search.solid.packed, new_kept(0))
    return edge._replace(wide=wide)


def refined_claims(one: Box) -> Claims:
    """What is claimed of a box about its middle in sums of two doubles."""
    edge = refined_edge(one)

    def ranges(theta: float, a: float, tau: float, b: float, *_: object) -> object:
        place = refined.placement_at((tau, 0.0), edge.motion, edge.wide)
        return refined.refined_ranges(theta, a, tau, b, place, refined.NOT_THERE, edge)

    kernels: Kernels = (ranges, COMPILED[1])
    return claims(one, kernels)


def boxes(number: int, count: int) -> Iterator[Box]:
    """Boxes of random motions of every form and stage."""
    choose = np.random.default_rng([301, number])
    for i in range(count):
        search = with_packed_profiles(random_search(FORMS[i % len(FORMS)], STAGES[i % len(STAGES)], choose))
        one = random_box(search, choose)
        yield Box(search, one.theta, min(one.half, WIDEST), one.start, one.end, visited=False)


@cache
def some_boxes() -> list[Box]:
    return list(boxes(1, 300))


@cache
def seen(i: int) -> tuple[list[Quantities], Quantities]:
    """What the balls say at the corners and in the middle of a box."""
    one = some_boxes()[i]
    evaluation = Evaluation(one, claims(one))
    at_corners = [evaluation.quantities((x, 0.0, y, 0.0)) for x, y in CORNERS]
    return at_corners, middle_values(evaluation.over((0.0, 0.0, 0.0, 0.0)))


def test_no_range_is_contradicted() -> None:
    for i, one in enumerate(some_boxes()):
        assert not list(contradicted(refined_claims(one), *seen(i)))


def test_a_middle_in_doubles_is_contradicted() -> None:
    found = chain.from_iterable(
        contradicted(with_errors_of_sums(claims(one), refined_claims(one)), *seen(i))
        for i, one in enumerate(some_boxes())
    )
    assert next(found, None) is not None


def with_errors_of_sums(of_doubles: Claims, of_sums: Claims) -> Claims:
    """The claims of values in doubles, as exact as those in sums of two doubles."""
    return Claims(
        of_doubles.theta,
        of_doubles.a,
        of_doubles.tau,
        of_doubles.b,
        of_doubles.over_box,
        tuple(
            (0.5 * (low + high) - 0.5 * (last - first), 0.5 * (low + high) + 0.5 * (last - first))
            for (low, high), (first, last) in zip(of_doubles.in_middle, of_sums.in_middle, strict=True)
        ),
        of_doubles.box_class,
        of_doubles.thread_pitch,
    )


@pytest.mark.slow
def test_ranges_and_classes_hold() -> None:
    undecided = 0
    for one in boxes(2, 300):
        outcomes = audit(one, refined_claims(one)).open.values()
        assert Outcome.FAILS not in outcomes
        undecided += len(outcomes)
    assert undecided <= 10
