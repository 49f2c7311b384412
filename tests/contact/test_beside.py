"""Beside an earlier contact: differences from it and what excludes a second tangency, beside ball arithmetic."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import islice, pairwise

import numpy as np
import pytest
from flint import arb

from studies.certificate.cases import FORMS, Search, pair_of, random_search, state_searches
from studies.certificate.motions import edge_motion
from tests.contact.edges import new_edge, new_kept
from threadstate.contact import _beside_kernel as beside
from threadstate.contact import _box_kernel as box
from threadstate.contact import _edge_search_kernel as edge_search
from threadstate.contact import _flank_kernel as flank
from threadstate.contact._edge_kernel import Box, Edge
from threadstate.contact._geometry_kernel import PATH_SIZE, TWO_PI, edge_point, position, set_path
from threadstate.contact._initial_box_kernel import set_initial_boxes
from threadstate.contact._range_kernel import error_beside, size_numbers
from threadstate.contact._stage_kernel import rotation
from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import FeaturePair
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.thread import _profile_kernel as pk
from threadstate.thread.catalogue import pair_by_designation, quarter_twenty_unc

DISPLACED = 1.5e-14
"""Of the thread pitch: slopes are those of profiles displaced by up to that (docs/certificate.md, section 6)."""

SHARPEST_BEND = 8.0 / 4e-9
"""Largest second derivative over the thread pitch of the fillets that stand for sharp corners of Tr threads."""


@dataclass(frozen=True)
class Beside:
    """A turn about an earlier contact on the moving edge: its azimuth, whether it is on an edge, too, its end."""

    search: Search
    azimuth: float
    edges: bool
    kept: np.ndarray
    until: float


def kept_contact(azimuth: float, *, on_plane: bool, on_thread: bool, tangent: bool) -> np.ndarray:
    kept = new_kept(1)
    beside.keep(azimuth, on_plane, on_thread, kept)
    kept[0, beside.K_TANGENT] = 1.0 if tangent else 0.0
    return kept


@cache
def second_turns() -> tuple[Beside, ...]:
    """Second turns of random poses of every form, half of them about a contact of an edge on a thread, or of edges."""
    rng = np.random.default_rng(19)
    found: list[Beside] = []
    forms = (*FORMS, *4 * ["1/4-16 ACME-2G at minimum material"])
    while len(found) < 80:
        form = forms[rng.integers(len(forms))]
        tilt = 10.0 ** rng.uniform(-2.0, 0.7)
        roll, pitch = tilt * rng.uniform(-1.0, 1.0, 2)
        try:
            state = solve_pose(pair_of(form), float(roll), float(pitch), float(rng.uniform(-20.0, 20.0)))
        except UnresolvedPoseError:
            continue
        contact = state.contacts[0]
        moving = {FeaturePair.EDGE_THREAD: (0,), FeaturePair.THREAD_EDGE: (1,), FeaturePair.EDGE_EDGE: (0, 1)}
        turns = [search for search, _ in state_searches(form, state) if search.stage == "second turn"]
        for i in moving.get(contact.features, ()) if turns else ():
            search = turns[i]
            frame = np.array(search.motion[:9]).reshape(3, 3)
            x, y, _ = frame.T @ (np.array(contact.point) - search.motion[9:12])
            edges = contact.features is FeaturePair.EDGE_EDGE
            if sum(other.edges == edges for other in found) == 40:
                continue
            azimuth = math.atan2(y, x)
            kept = kept_contact(azimuth, on_plane=edges, on_thread=True, tangent=not edges)
            found.append(Beside(search, azimuth, edges, kept, math.radians(state.lambda_deg or 0.0)))
    return tuple(found)


def edge_of(one: Beside) -> Edge:
    """The moving edge, with the contact where it is."""
    edge = new_edge(one.search.motion, one.search.curve.packed, one.search.solid.packed, one.kept)
    beside.place_kept(edge)
    return edge


def exact_turn(one: Beside) -> tuple[Search, arb, arb]:
    """The turn about the exact edge point at the contact's azimuth; phi and g there."""
    balls, theta = one.search.balls, arb(one.azimuth)
    x, y, o = balls.columns_at(arb(0))
    radius = balls.curve.over(-balls.curve.advance * theta).radius
    sine, cosine = theta.sin_cos()
    point = tuple(radius * (cosine * a.value + sine * b.value) + c.value for a, b, c in zip(x, y, o, strict=True))
    turned = replace(balls, point=point)  # type: ignore[arg-type]
    at_contact = turned.over(theta, arb(0))
    return replace(one.search, balls=turned), at_contact.phi.value, at_contact.g.value


def test_differences_from_a_contact_are_within_their_error() -> None:
    rng = np.random.default_rng(20)
    most = 0.0
    for one in second_turns():
        exact, phi_0, g_0 = exact_turn(one)
        edge = edge_of(one)
        sizes = size_numbers(one.search.motion, one.search.curve.packed, one.search.solid.packed)
        for _ in range(12):
            way = float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-9.0, math.log10(0.099)))
            tau = float(10.0 ** rng.uniform(-8.0, -0.5))
            theta = one.azimuth + way
            g, phi, gap = beside.values_beside(theta, tau, edge)
            assert gap == pytest.approx(abs(way), rel=1e-6)
            error = error_beside(tau, sizes) * gap
            if one.search.form.endswith("sharp corners"):
                error += gap * DISPLACED * SHARPEST_BEND
            values = exact.balls.over(arb(theta), arb(tau))
            assert abs(values.phi.value - phi_0 - arb(phi)) < error
            most = max(most, float(abs(values.phi.value - phi_0 - arb(phi)).mid()) / error)
            if one.kept[1, beside.K_G]:
                assert abs(values.g.value - g_0 - arb(g)) < error
            else:
                assert math.isnan(g)
    assert most > 0.01  # the bound is no more than a hundred times what is seen


def test_half_a_small_angle_has_the_sine_and_cosine_of_the_library() -> None:
    for d in [0.0, *np.geomspace(1e-12, beside.BESIDE, 60).tolist()]:
        for way in (d, -d):
            sine, cosine = beside.half_angle(way)
            assert abs(sine - math.sin(0.5 * way)) <= 2.0**-51 * abs(0.5 * way)
            assert abs(cosine - math.cos(0.5 * way)) <= 2.0**-52


@pytest.mark.parametrize("turns", [-1, 0, 2])
def test_a_kept_contact_is_where_its_edge_point_is(turns: int) -> None:
    one = second_turns()[0]
    curve, motion = one.search.curve.packed, one.search.motion
    edge = new_edge(motion, curve, one.search.solid.packed, one.kept.copy())
    edge.kept[1, beside.K_THETA] += turns * TWO_PI
    beside.place_kept(edge)
    x, y, _, _ = edge_point(one.azimuth, curve)
    path = np.empty(PATH_SIZE)
    set_path(x, y, motion, path)
    at = position(path, 0.0, True)
    kept = edge.kept[1].tolist()
    radius = kept[beside.K_RADIUS]
    k = float(curve[pk.LEAD]) / TWO_PI
    place = at[2] - k * math.atan2(at[1], at[0])
    assert kept[beside.K_COSINE] * radius == pytest.approx(x, abs=1e-14)
    assert kept[beside.K_SINE] * radius == pytest.approx(y, abs=1e-14)
    assert kept[beside.K_PLACE_X : beside.K_POSITION + 1] == pytest.approx(
        [*at[:2], math.hypot(*at[:2]), place], abs=1e-14
    )


@pytest.mark.parametrize("form", FORMS)
def test_differences_of_a_profile_add_up_over_all_pieces(form: str) -> None:
    """Over every junction of flat, fillet and flank, beyond the middles of both flats, from 1e-15 of the pitch on."""
    rng = np.random.default_rng(21)
    for profile in (pair_of(form).bolt, pair_of(form).nut):
        p = profile.thread_pitch
        for _ in range(300):
            s, step = float(rng.uniform(-p, p)), float(rng.choice([-1.0, 1.0]) * p * 10.0 ** rng.uniform(-15.0, -0.4))
            found = beside.radius_difference(s, step, profile.packed)
            expected = profile.radius(s + step) - profile.radius(s)
            assert found == pytest.approx(expected, abs=2e-15 * p / 0.05)
        for _ in range(300):
            s, step = float(rng.uniform(-p, p)), float(p * 10.0 ** rng.uniform(-15.0, -6.0))
            slope = beside.radius_difference(s, step, profile.packed) / step
            sides = [profile.derivatives(at)[1] for at in (s, s + step)]
            slack = 1e-9 + 2.0 * abs(sides[1] - sides[0])
            assert min(sides) - slack <= slope <= max(sides) + slack


def nearly_coaxial(rng: np.random.Generator) -> Search:
    """A turn of nearly coaxial parts."""
    search = random_search(FORMS[rng.integers(len(FORMS))], "second turn", rng)
    tilt, motion = 10.0 ** rng.uniform(-9.0, -1.5), search.motion.copy()
    pose = np.zeros(12)
    rotation(*(tilt * rng.uniform(-1.0, 1.0, 2)), rng.uniform(0.0, TWO_PI), pose)
    return search if rng.random() < 0.2 else _moved(search, motion, pose, tilt * rng.normal(0.0, 0.05, 2))


def _moved(search: Search, motion: np.ndarray, pose: np.ndarray, offset: np.ndarray) -> Search:
    motion[:9], motion[9:11] = pose[:9], offset
    return replace(search, motion=motion, balls=edge_motion(motion, search.curve, search.solid))


def third_derivative(search: Search, theta: float, tau: float) -> arb:
    """phi_thetathetatheta from the second derivatives in balls, which are straight beside."""
    step = arb(2) ** -24
    later, before = (search.balls.over(arb(theta) + d, arb(tau)).phi.tt for d in (step, -step))
    return (later - before) / (2 * step)


def test_third_derivatives_keep_the_sign_that_excludes_a_tangency() -> None:
    rng = np.random.default_rng(22)
    excluded = 0
    for _ in range(1200):
        search = nearly_coaxial(rng)
        contact, way = float(rng.uniform(0.0, 6.0)), float(rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-7.0, -1.0))
        start = float(10.0 ** rng.uniform(-9.0, -2.0))
        end = start + float(10.0 ** rng.uniform(-13.0, -3.0))
        numbers = search.motion, search.curve.packed, search.solid.packed
        if flank.no_tangency_on_flanks(contact, way, start, end, *numbers)[0]:
            excluded += 1
            seen = [third_derivative(search, contact + x * way, t) for x in (0.01, 0.5, 0.99) for t in (start, end)]
            assert all(value > 0 for value in seen) or all(value < 0 for value in seen)
    assert excluded > 60


def test_third_derivatives_in_the_middle_are_those_of_balls() -> None:
    rng = np.random.default_rng(23)
    looked_at = 0
    for _ in range(200):
        deviation, tilt = (complex(*rng.normal(0.0, s, 2)) for s in (0.01, 0.001))
        mu = float(rng.normal(0.0, 0.1))
        radial, around = flank.third_derivatives(deviation, tilt, mu)
        step = 0.01
        t = step * np.arange(-4, 5)
        epsilon = deviation * np.exp(-1j * t) / (1.0 + mu * t) + tilt * np.exp(-2j * t)
        weights = np.array([-7.0, 72.0, -338.0, 488.0, 0.0, -488.0, 338.0, -72.0, 7.0]) / (240.0 * step**3)
        assert radial == pytest.approx(weights @ ((1.0 + mu * t) * np.abs(1.0 + epsilon)), abs=1e-8)
        assert around == pytest.approx(weights @ np.angle(1.0 + epsilon), abs=1e-8)
        looked_at += 1
    assert looked_at == 200


def undecided_beside(one: Beside) -> Iterator[tuple[float, float, float, float]]:
    """Boxes of a search beside a contact that the bend of phi excludes: middle, half-width, start, end."""
    boxes, scratch = np.zeros(box.BOXES_SIZE), np.zeros(box.BOXES_SIZE)
    edge = edge_of(one)
    level = [edge_search.box_at(i, boxes) for i in range(set_initial_boxes(0.0, one.until, boxes))]
    for _ in range(40):
        parts: list[Box] = []
        for first in range(0, len(level), edge_search.BATCH):
            taken = level[first : first + edge_search.BATCH]
            for i, wanted in enumerate(taken):
                edge_search.set_box_at(wanted, i, boxes)
            edge_search.evaluate_boxes(edge_search.pad_boxes(len(taken), boxes), edge, boxes)
            for i, (theta, half, start, end) in enumerate(taken):
                kind = int(boxes[box.X_CLASS + i])
                gap = edge_search.contact_distance(theta, one.kept)
                if kind <= box.EXCLUDED or not (half < gap < beside.BESIDE or kind >= box.PEAK_EDGE):
                    continue
                bends = float(boxes[box.X_BEND_LOW + i]), float(boxes[box.X_BEND_HIGH + i])
                if (
                    half < gap < beside.BESIDE
                    and boxes[box.X_G_LOW + i] > 0.0
                    and edge_search.no_onset_from_contact(Box(theta, half, start, end), bends, edge, scratch)[0]
                ):
                    yield theta, half, start, end
                elif len(parts) < 200:
                    by_time = bool(boxes[box.X_BY_TIME + i])
                    parts += [edge_search.part_of(taken[i], by_time, part, 0.5) for part in range(2)]
        level = parts


def test_no_tangency_is_where_the_bend_from_the_contact_excludes_it() -> None:
    """Newton's method for phi = phi_theta = 0, in numbers of 29 digits, ends in none of these boxes."""
    looked_at = 0
    for one in second_turns():
        exact, phi_0, _ = exact_turn(one)
        for theta, half, start, end in islice(undecided_beside(one), 20):
            looked_at += 1
            for x, y in ((0.0, 0.5), (-0.9, 0.1), (0.9, 0.9)):
                root = newton(exact, phi_0, theta + x * half, start + y * (end - start))
                assert root is None or abs(root[0] - theta) > half or not start <= root[1] <= end
    assert looked_at > 40


def newton(search: Search, phi_0: arb, theta: float, tau: float) -> tuple[float, float] | None:
    """The place and time at which phi is ``phi_0`` and phi_theta is zero that Newton's method ends in, if it does."""
    t, u = arb(theta), arb(tau)
    for _ in range(12):
        phi = search.balls.over(t, u).phi
        det = phi.t * phi.tu - phi.u * phi.tt
        if det.contains(0):
            return None
        value = phi.value - phi_0
        dt, du = (phi.t * phi.u - value * phi.tu) / det, (value * phi.tt - phi.t * phi.t) / det
        t, u = (t + dt).mid(), (u + du).mid()
        if not (abs(dt) < 0.3 and abs(du) < 0.3):
            return None
    return (float(t), float(u)) if abs(dt) < 1e-9 and abs(du) < 1e-12 else None


def test_contacts_beside_an_earlier_one_are_found() -> None:
    """Third contacts that bounds with round-off alone had missed, 1e-6 in and less from the second one."""
    unc = quarter_twenty_unc()
    state = solve_pose(unc, -2.0394603099715543, 0.5403767150976275, 33.918066966823574)
    assert [contact.features for contact in state.contacts][2] is FeaturePair.EDGE_THREAD
    bsw = solve_pose(pair_by_designation("1/4-20 BSW"), 1.8722161937451327, -1.6314067209813796, 19.206346424686437)
    assert len(bsw.contacts) == 3


def test_features_beside_a_contact_do_not_flicker() -> None:
    phases = np.linspace(33.7424, 33.7431, 701)
    states = solve_poses(quarter_twenty_unc(), [(-2.0, 1.0, float(phase)) for phase in phases])
    features = [[contact.features for contact in state.contacts] for state in states]
    assert sum(a != b for a, b in pairwise(features)) == 1


def test_a_contact_that_round_off_puts_beside_all_boxes_is_found() -> None:
    """Second contacts 5e-6 in beside the first one, at phases where a box ends within round-off of their time."""
    phases = (6.631293009, 6.633276808, 6.639479753)
    states = solve_poses(quarter_twenty_unc(), [(-4.0, -3.0, phase) for phase in phases])
    assert [len(state.contacts) for state in states] == [3, 3, 3]
