"""The audit of a box: what the kernels claim of it beside balls, which are halved until they agree or contradict."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum

from flint import arb

from studies.certificate.balls import Taylor, both, square
from studies.certificate.bounds import IN_MIDDLE, OVER_BOX, Claims
from studies.certificate.cases import Box
from studies.certificate.motions import Values
from threadstate.contact import _box_kernel as box

MOST_BALLS = 200
"""Balls that a box is cut into at most, before a claim counts as undecided."""

CORNERS = ((-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0), (0.0, 0.0))
PART = arb(0, 1)


class Outcome(StrEnum):
    """What the balls say of a claim."""

    HOLDS = "holds"
    FAILS = "fails"
    UNDECIDED = "undecided"


@dataclass(frozen=True)
class Audited:
    """The outcome of each claim of a box that is not proved, and how much of each range points of the box use.

    ``used`` is, of each quantity of ``OVER_BOX`` and ``IN_MIDDLE``, the distance from the middle of the claimed
    interval to the farthest value seen, over half the interval's length; of the depth it is 0.
    """

    open: dict[str, Outcome]
    used: tuple[float, ...]


Quantities = tuple[list[arb], ...]
"""Balls for the quantities of ``OVER_BOX``; of a second derivative that jumps one for each side."""

Part = tuple[float, float, float, float]
"""A part of a box: middle and half-width of theta, then of tau, in half-widths of the box."""


@dataclass(frozen=True)
class Evaluation:
    """phi, g and depth of a box's edge point over parts of it."""

    box: Box
    claims: Claims

    def quantities(self, part: Part) -> Quantities:
        """The quantities of ``OVER_BOX`` over a part of the box."""
        return _quantities(self.over(part))

    @property
    def ways(self) -> tuple[float, float]:
        """How far the point goes at most over the half-width of the box, and in half of its time."""
        radius = 0.5 * self.box.search.curve.major_diameter
        return self.claims.a * radius, self.claims.b * (radius if self.box.search.balls.is_turn else 1.0)

    def over(self, part: Part, *, sharp: bool = False) -> Values:
        """Balls over a part of the box; a part of no width is a point."""
        x, half_x, y, half_y = part
        c = self.claims
        theta = (arb(c.theta) + arb(c.a) * arb(x, half_x)) if half_x else arb(c.theta) + arb(c.a) * x
        tau = (arb(c.tau) + arb(c.b) * arb(y, half_y)) if half_y else arb(c.tau) + arb(c.b) * y
        return self.box.search.balls.over(theta, tau, sharp=sharp)

    def expanded(self, part: Part, *, known: Sequence[arb | None] = (), sharp: bool = False) -> Values:
        """The same, values and slopes sharpened by their expansion about the middle of the part.

        ``known`` holds enclosures of the first nine quantities of ``OVER_BOX`` over the whole box.
        """
        x, half_x, y, half_y = part
        over, middle = self.over(part, sharp=sharp), self.over((x, 0.0, y, 0.0))
        phi, g = over.phi, over.g
        if known:
            phi = _within(phi, (known[3], known[4], known[0], known[1], known[2]))
            g = _within(g, (known[8], None, known[5], known[6], known[7]))
        dx, dy = PART * (self.claims.a * half_x), PART * (self.claims.b * half_y)
        return Values(
            _sharpened(phi, middle.phi, dx, dy),
            _sharpened(g, middle.g, dx, dy),
            _sharpened(over.depth, middle.depth, dx, dy),
            over.phi_tt,
            over.g_tt,
        )


def _within(over: Taylor, known: tuple[arb | None, ...]) -> Taylor:
    """A function of whose five derivatives enclosures may be known."""
    found = [getattr(over, name) for name in Taylor.__slots__[1:]]
    return Taylor(over.value, *(a if b is None else both(a, b) for a, b in zip(found, known, strict=True)))


def _sharpened(over: Taylor, middle: Taylor, dx: arb, dy: arb) -> Taylor:
    value = (
        middle.value
        + middle.t * dx
        + middle.u * dy
        + (over.tt * square(dx) + over.uu * square(dy)) / 2
        + over.tu * dx * dy
    )
    by_theta = middle.t + over.tt * dx + over.tu * dy
    by_tau = middle.u + over.tu * dx + over.uu * dy
    return Taylor(both(over.value, value), both(over.t, by_theta), both(over.u, by_tau), over.tt, over.tu, over.uu)


def _halves(part: Part, by_theta: float, by_tau: float) -> list[Part]:
    """Halves of a part along the longer of its two ways, or along both where they are of one size."""
    x, half_x, y, half_y = part
    along, over = by_theta * half_x, by_tau * half_y
    cut_x, cut_y = along > 0.25 * over, over > 0.25 * along
    xs = [(x - 0.5 * half_x, 0.5 * half_x), (x + 0.5 * half_x, 0.5 * half_x)] if cut_x else [(x, half_x)]
    ys = [(y - 0.5 * half_y, 0.5 * half_y), (y + 0.5 * half_y, 0.5 * half_y)] if cut_y else [(y, half_y)]
    return [(*one, *other) for one in xs for other in ys]


def _quantities(values: Values) -> Quantities:
    phi, g = values.phi, values.g
    single = phi.tu, phi.uu, phi.t, phi.u, g.tu, g.uu, g.t, phi.value, values.depth.value
    found = [[one] for one in single]
    return values.phi_tt, *found[:4], values.g_tt, *found[4:]


def _inside(values: list[arb], interval: tuple[float, float]) -> Outcome:
    """Whether all are in an interval, or one of them is outside whatever the true value in its ball is."""
    found = {_one_inside(one, interval) for one in values}
    if found == {Outcome.HOLDS}:
        return Outcome.HOLDS
    return Outcome.FAILS if found == {Outcome.FAILS} else Outcome.UNDECIDED


def _one_inside(value: arb, interval: tuple[float, float]) -> Outcome:
    low, high = interval
    if value.is_finite():
        if value.lower() >= low and value.upper() <= high:
            return Outcome.HOLDS
        if value.upper() < low or value.lower() > high:
            return Outcome.FAILS
    return Outcome.HOLDS if low == -float("inf") and high == float("inf") else Outcome.UNDECIDED


def _used(values: list[arb], interval: tuple[float, float]) -> float:
    low, high = interval
    middle, half = 0.5 * (low + high), 0.5 * (high - low)
    if not (0.0 < half < float("inf")):
        return 0.0
    return max(float(((value - arb(middle)) / half).abs_upper()) for value in values)


def audit(one: Box, claims: Claims) -> Audited:
    """Put the claims of the kernels about a box beside balls."""
    evaluation = Evaluation(one, claims)
    open_claims: dict[str, Outcome] = {}
    skipped = 5 if _near_axis(claims) else 0
    used = [0.0] * (len(OVER_BOX) + len(IN_MIDDLE))
    seen = [evaluation.quantities((x, 0.0, y, 0.0)) for x, y in CORNERS]
    for quantities in seen:
        for i, (value, interval) in enumerate(zip(quantities, claims.over_box, strict=True)):
            used[i] = max(used[i], _used(value, interval))
    centre = evaluation.over((0.0, 0.0, 0.0, 0.0))
    middle = middle_values(centre)
    for i, (value, interval) in enumerate(zip(middle, claims.in_middle, strict=True)):
        used[len(OVER_BOX) + i] = _used([one.mid() for one in value], interval)
    open_claims.update(dict.fromkeys(contradicted(claims, seen, middle), Outcome.FAILS))
    for name, outcome in _ranges(evaluation, claims).items():
        open_claims.setdefault(name, outcome)
    proved = [
        None if name in open_claims else interval for name, interval in zip(OVER_BOX, claims.over_box, strict=True)
    ]
    outcome = _class(evaluation, claims, [None] * len(proved) if skipped else proved)
    if outcome is not Outcome.HOLDS:
        open_claims[f"class {claims.box_class}"] = outcome
    return Audited(open_claims, tuple(used))


def contradicted(claims: Claims, seen: Iterable[Quantities], middle: Quantities = ()) -> Iterator[str]:
    """The claims that some point of a box contradicts: what is seen at points, and in the middle of its values.

    A slope in the middle is that of some displaced profile: its ball, which holds those of all, has to meet the claim.
    """
    near_axis = _near_axis(claims)
    for quantities in seen:
        for i, (value, interval) in enumerate(zip(quantities, claims.over_box, strict=True)):
            if _inside(value, interval) is Outcome.FAILS and not (near_axis and i < 5):
                yield OVER_BOX[i]
    for i, (value, interval) in enumerate(zip(middle, claims.in_middle, strict=False)):
        if _inside(value, interval) is Outcome.FAILS and not (near_axis and i < 3):
            yield IN_MIDDLE[i]


def middle_values(centre: Values) -> Quantities:
    """The quantities of ``IN_MIDDLE``."""
    phi, g = centre.phi, centre.g
    return tuple([one] for one in (phi.value, phi.t, phi.u, g.value, g.t, g.u))


def _near_axis(claims: Claims) -> bool:
    """Whether of phi only a bound from one side is claimed: the curve is near the solid's axis there."""
    low, high = claims.over_box[0]
    return (low == 0.0 and high == 0.0) or (low == -float("inf") and high == float("inf"))


def _ranges(evaluation: Evaluation, claims: Claims) -> dict[str, Outcome]:
    """What is not proved of the ranges over the box."""
    skipped = 5 if _near_axis(claims) else 0
    last = len(OVER_BOX) - (1 if _depth_holds(evaluation, claims) else 0)
    parts: deque[tuple[Part, list[int]]] = deque([((0.0, 1.0, 0.0, 1.0), list(range(skipped, last)))])
    found: dict[str, Outcome] = {}
    balls = 0
    while parts:
        part, wanted = parts.popleft()
        balls += 1
        left = wanted
        for sharp in (False, True):
            quantities = _quantities(evaluation.expanded(part, sharp=sharp))
            left = [i for i in left if _inside(quantities[i], claims.over_box[i]) is not Outcome.HOLDS]
            if not left or left[0] >= 5:
                break
        if not left:
            continue
        inner = _quantities(evaluation.over((part[0], 0.0, part[2], 0.0)))
        for i in left:
            if _inside(inner[i], claims.over_box[i]) is Outcome.FAILS:
                found[OVER_BOX[i]] = Outcome.FAILS
        left = [i for i in left if OVER_BOX[i] not in found]
        if balls > MOST_BALLS:
            for i in left:
                found[OVER_BOX[i]] = Outcome.UNDECIDED
        elif left:
            parts += [(half, left) for half in _halves(part, *evaluation.ways)]
    return found


def _depth_holds(evaluation: Evaluation, claims: Claims) -> bool:
    """Whether the least depth is proved by its expansion over the whole box.

    As a value over parts of the box it could not be: that it is taken at a corner is a matter of much less than the
    radius of a ball is known to.
    """
    depth = evaluation.over((0.0, 1.0, 0.0, 1.0)).depth
    middle = evaluation.over((0.0, 0.0, 0.0, 0.0)).depth
    a, b = arb(claims.a), arb(claims.b)
    left = middle.value - abs(middle.t) * a - abs(middle.u) * b - arb(claims.over_box[-1][0])
    return bool((abs(depth.tt) * a * a + 2 * abs(depth.tu) * a * b + abs(depth.uu) * b * b) / 2 < left)


def _class(evaluation: Evaluation, claims: Claims, proved: list[tuple[float, float] | None]) -> Outcome:
    """Whether the class of a box is proved; the ranges that balls have proved count, too."""
    known = [None if one is None else arb(one[0]).union(arb(one[1])) for one in proved[:9]]
    kind = claims.box_class
    if kind == box.UNDECIDED_BOX:
        return Outcome.HOLDS
    parts: list[Part] = [(0.0, 1.0, 0.0, 1.0)]
    balls = 0
    while parts:
        part = parts.pop()
        values = evaluation.expanded(part, known=known)
        phi, g, depth = values.phi, values.g, values.depth
        balls += 1
        if kind in (box.ALL_OUTSIDE, box.EXCLUDED):
            holds = holds_no_onset(phi, g, depth.value, claims.thread_pitch, outside=kind == box.ALL_OUTSIDE)
        else:
            holds = has_one_peak(kind, phi, g)
        if holds:
            continue
        if balls > MOST_BALLS:
            return Outcome.UNDECIDED
        parts += _halves(part, *evaluation.ways)
    return Outcome.HOLDS


def holds_no_onset(phi: Taylor, g: Taylor, depth: arb, thread_pitch: float, *, outside: bool) -> bool:
    """Whether no onset is in a part of a box over which phi and g take no values but those.

    An onset has min(g, phi) = 0, and no point with g > 0 and phi > 0 beside it at that time or just before: not the
    case if some direction (x, -1) or (x, 0) makes both grow.
    """
    if phi.value < 0 or g.value < 0 or depth > thread_pitch:
        return True
    if outside:
        return False
    if phi.value > 0 and g.value > 0:
        return True
    on_edge = phi.value.contains(0) and g.value.contains(0)
    on_thread = phi.value.contains(0) and not g.value <= 0
    on_plane = g.value.contains(0) and not phi.value <= 0
    fall = phi.t - g.t
    sinks = (g.u * phi.t - phi.u * g.t) * fall < 0
    opposite = phi.t * g.t < 0
    return (
        (not on_edge or bool(phi.t * g.t > 0) or bool(opposite and sinks))
        and (not on_thread or not phi.t.contains(0) or bool(phi.tt > 0) or bool(phi.u < 0))
        and (not on_plane or not g.t.contains(0) or bool(g.tt > 0) or bool(g.u < 0))
    )


def has_one_peak(kind: int, phi: Taylor, g: Taylor) -> bool:
    """Whether the signs that make the peak of a box unique, and its onset, hold."""
    if kind in (box.ONE_EDGE, box.PEAK_EDGE):
        certain = not phi.t.contains(0) and not g.t.contains(0)
        return certain and (kind == box.PEAK_EDGE or not (g.u * phi.t - phi.u * g.t).contains(0))
    if kind in (box.ONE_THREAD, box.PEAK_THREAD):
        certain = bool(g.value > 0) and bool(phi.tt < 0)
        return certain and (kind == box.PEAK_THREAD or not phi.u.contains(0))
    certain = bool(phi.value > 0) and bool(g.tt < 0)
    return certain and (kind == box.PEAK_PLANE or not g.u.contains(0))
