"""The audit of the bounds that close boxes: it agrees with other evaluations, finds no fault, and finds those made."""

from __future__ import annotations

import inspect
import math
from collections import Counter
from collections.abc import Iterator
from functools import cache
from itertools import chain
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from flint import arb

from studies.certificate.audit import (
    CORNERS,
    Evaluation,
    Outcome,
    Quantities,
    audit,
    contradicted,
    middle_values,
)
from studies.certificate.bounds import COMPILED, Kernels, claims
from studies.certificate.cases import FORMS, STAGES, Box, pair_of, random_boxes, random_search, search_boxes
from studies.certificate.page import HEADING, section
from studies.certificate.profiles import ball_profile
from studies.certificate.study import Found, audit_boxes, failures
from tests.contact.edges import new_edge, new_kept
from threadstate.contact import _box_kernel as box
from threadstate.contact import _branchless_kernel, _curve_point_kernel, _range_kernel
from threadstate.contact import _onset_kernel as onset
from threadstate.contact._edge_kernel import Box as SearchBox
from threadstate.contact._geometry_kernel import M_COPLANAR, PATH_SIZE, motion_scale
from threadstate.contact._initial_box_kernel import drop_above, set_initial_boxes

FAULTS = {
    "a growth of less than e - 1, and of nothing": (
        "misaligned = (misaligned + sine * sine + change.by_time",
        "misaligned = 0.2 * (misaligned + sine * sine + change.by_time",
    ),
    "F' with a tenth of its term of r": (
        "+ r_bound * (misaligned * (1.0 + 3.0",
        "+ 0.1 * r_bound * (misaligned * (1.0 + 3.0",
    ),
    "H' with a third of its axial part": ("helical = sine *", "helical = 0.3 * sine *"),
    "directions that keep still by time": (
        "change_by_time = b * (turning + across_bound * inverse_r)",
        "change_by_time = 0.1 * b * (turning + across_bound * inverse_r)",
    ),
    "directions that turn by a twentieth of the azimuth": (
        "direction_change = a + turning * b + azimuth_change",
        "direction_change = 0.05 * a",
    ),
    "no change of X_theta tau along the axis": ("+ change.d_w_axial\n", "+ 0.0\n"),
    "no change of X_theta tau across the axis": (
        "turned = change.d_w_across + change.w_across * change.azimuth",
        "turned = 0.0 * change.w_across",
    ),
    "no change of V across the axis": ("        d_across + across * azimuth_change,\n", "        0.0 * across,\n"),
    "a slope held at nothing": (
        "slope, steep = change.d_t, change.d_v, abs(middle.f1), over.steep",
        "slope, steep = change.d_t, change.d_v, 0.0, over.steep",
    ),
    "half the change of f'": ("d_f1 = larger(slope_high", "d_f1 = 0.5 * larger(slope_high"),
    "half the reach by azimuth": (
        "reach = (abs(ts) + on_average) * a",
        "reach = 0.5 * (abs(ts) + on_average) * a",
    ),
    "no change of s_theta on the way": ("(abs(ts) + on_average) * a", "abs(ts) * a"),
    "half of what f differs from its tangent by": (
        "above, below = bend + profile_error - over.course.low, bend + profile_error + over.course.high",
        "above, below = bend + profile_error - 0.5 * over.course.low, bend + profile_error + 0.5 * over.course.high",
    ),
    "a third of what phi bends by, but for f": ("0.5 * tt * a * a", "0.1 * varied.tt * a * a"),
    "half of what f' differs by": (
        "product_range(over.course.slope_low, over.course.slope_high,",
        "product_range(0.5 * over.course.slope_low, 0.5 * over.course.slope_high,",
    ),
    "a tenth of the bend that changes phi_theta": (
        "return bend, tt * a + abs(along)",
        "return bend, 0.1 * tt * a + abs(along)",
    ),
    "half of f''": ("tt_high -= f2_low *", "tt_high -= 0.5 * f2_low *"),
    "no term of R1 in g'": ("(a * (r_bound + 3.0 * r1_bound)", "(a * r_bound"),
    "g's sine at the end of a turn in both planes": (
        "sine_g = smaller(g.sine + turning_moving * b, 1.0)",
        "sine_g = math.sqrt(edge.m1z * edge.m1z + edge.m2z * edge.m2z)",
    ),
    "a third of the change of V": (
        "speed_bound * direction_change + speed_bound - speed,",
        "0.3 * (speed_bound * direction_change + speed_bound - speed),",
    ),
    "a tenth of what phi_thetatheta varies by": (
        "whole_tt = smaller(near_r + steep * near_s, whole_tt) if near.aligned else whole_tt",
        "whole_tt = 0.1 * (smaller(near_r + steep * near_s, whole_tt) if near.aligned else whole_tt)",
    ),
    "products of velocities that keep still": (
        "mixed = inverse_r * (c1 * d_v + across * d_t + c1 * across * radius_change)",
        "mixed = 0.0 * inverse_r",
    ),
    "a radius that is never small": ("near_axis = radius - move < 0.5 * r_minor", "near_axis = False"),
    "a hundredth of the round-off": ("position_error = base_error", "position_error = 0.01 * base_error"),
    "a fortieth of the round-off of values": (
        "        gradient_bound * change.position_error,\n        theta_error,",
        "        0.025 * gradient_bound * change.position_error,\n        theta_error,",
    ),
}
"""Of the ranges' kernel, a text and the fault that replaces it."""


@cache
def some_boxes() -> list[Box]:
    return [*random_boxes(11, 1000), *search_boxes(11, 1500)]


@cache
def at_corners(i: int) -> tuple[list[Quantities], Quantities]:
    """What the balls say at the corners and in the middle of a box."""
    one = some_boxes()[i]
    evaluation = Evaluation(one, claims(one))
    seen = [evaluation.quantities((x, 0.0, y, 0.0)) for x, y in CORNERS]
    return seen, middle_values(evaluation.over((0.0, 0.0, 0.0, 0.0)))


def with_fault(text: str, fault: str) -> Kernels:
    """The kernels in plain Python, with a text of ``ranges`` replaced."""
    source = inspect.getsource(_range_kernel)
    assert source.count(text) == 1
    module = ModuleType("faulty")
    plain = source.replace(text, fault).replace("@kernel(contract=True, forceinline=True)\n", "")
    exec(compile(plain, "faulty", "exec"), vars(module))
    for other in (_branchless_kernel, _curve_point_kernel):
        for name, function in vars(other).items():
            if hasattr(function, "py_func") and hasattr(module, name):
                setattr(module, name, function.py_func)
    return module.ranges, COMPILED[1]


@pytest.mark.parametrize("form", FORMS)
def test_the_profile_in_balls_is_the_profile(form: str) -> None:
    rng = np.random.default_rng(291)
    for profile in (pair_of(form).bolt, pair_of(form).nut):
        balls = ball_profile(profile)
        for s in rng.uniform(-2.0, 2.0, 200) * profile.thread_pitch:
            r, slope, second = profile.derivatives(float(s))
            jet = balls.over(arb(float(s), 1e-14 * profile.thread_pitch))
            assert abs(jet.radius - arb(r)) < 1e-13 * profile.thread_pitch
            assert abs(jet.slope - arb(slope)) < 1e-10
            assert float(jet.low) - 1e-8 * abs(second) <= second <= float(jet.high) + 1e-8 * abs(second)


@pytest.mark.parametrize("stage", STAGES)
def test_balls_agree_with_the_derivatives_of_newtons_method(stage: str) -> None:
    rng = np.random.default_rng(292)
    path, jet = np.empty(PATH_SIZE), np.empty(onset.JET_SIZE)
    for _ in range(20):
        search = random_search(FORMS[rng.integers(5)], stage, rng)
        theta, tau = float(rng.uniform(0.0, 6.0)), float(rng.uniform(0.0, 0.2))
        onset.set_jet(theta, tau, search.motion, search.curve.packed, search.solid.packed, path, jet)
        for sharp in (False, True):
            found = search.balls.over(arb(theta), arb(tau), sharp=sharp)
            phi, g = found.phi, found.g
            assert (search.motion[M_COPLANAR] != 0.0) == stage.endswith("both planes")
            expected = {
                onset.J_G: g.value,
                onset.J_G_THETA: g.t,
                onset.J_G_TAU: g.u,
                onset.J_G_THETA_THETA: g.tt,
                onset.J_G_THETA_TAU: g.tu,
                onset.J_PHI: phi.value,
                onset.J_PHI_THETA: phi.t,
                onset.J_PHI_TAU: phi.u,
                onset.J_PHI_THETA_THETA: phi.tt,
                onset.J_PHI_THETA_TAU: phi.tu,
            }
            for column, ball in expected.items():
                assert float(ball) == pytest.approx(jet[column], rel=1e-9, abs=1e-11)


def test_second_derivatives_by_time_are_those_of_the_first_ones() -> None:
    rng = np.random.default_rng(293)
    step = arb(2) ** -30
    for _ in range(20):
        search = random_search(FORMS[0], "third turn", rng)
        theta, tau = arb(float(rng.uniform(0.0, 6.0))), arb(float(rng.uniform(0.0, 0.2)))
        later, before = (search.balls.over(theta, tau + d).phi for d in (step, -step))
        slope = (later.u - before.u) / (2 * step)
        assert float(search.balls.over(theta, tau).phi.uu) == pytest.approx(float(slope), rel=1e-5, abs=1e-6)


def test_ranges_and_classes_hold() -> None:
    found = audit_boxes([*random_boxes(21, 200), *search_boxes(21, 150)])
    assert failures(found) == 0, found.faults
    assert sum(found.outcomes.values()) <= 5
    assert sum(count for (kind, _), count in found.boxes.items() if kind == "made") == 350


@pytest.mark.slow
def test_ranges_and_classes_of_many_boxes_hold() -> None:
    found = audit_boxes([*random_boxes(22, 800), *search_boxes(30, 1200)])
    assert failures(found) == 0, found.faults
    # Beside the border of a fillet displaced profiles are on either side of it: no cutting decides which is meant.
    assert sum(found.outcomes.values()) <= 30
    assert {stage for (kind, stage) in found.boxes if kind == "stage"} == set(STAGES)
    assert {form for (kind, form) in found.boxes if kind == "form"} == set(FORMS)
    assert len([1 for (kind, _) in found.boxes if kind == "class"]) >= 7


@pytest.mark.slow
@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_contradicted(name: str) -> None:
    kernels = with_fault(*FAULTS[name])
    contradictions = chain.from_iterable(
        contradicted(claims(one, kernels), *at_corners(i)) for i, one in enumerate(some_boxes())
    )
    assert next(contradictions, None) is not None


def test_no_fault_is_not_contradicted() -> None:
    kernels = with_fault("GROWTH = 1.72", "GROWTH = 1.72")
    for i, one in enumerate(some_boxes()[:200]):
        assert not list(contradicted(claims(one, kernels), *at_corners(i)))


def dropped(one: Box, *, kind: int) -> Outcome | None:
    """What balls say of the class of a box that is made out to be of that class."""
    claimed = claims(one)
    made_out = claims(one, (COMPILED[0], lambda *_: (kind, 0.0)))
    assert made_out.over_box == claimed.over_box
    return audit(one, made_out).open.get(f"class {kind}")


def onset_boxes() -> Iterator[Box]:
    """Narrow boxes of searches that may have an onset, with the one that Newton's method finds inside."""
    jet = np.empty(onset.JET_SIZE)
    for one in search_boxes(31, 15000):
        claimed = claims(one)
        if 2 <= claimed.box_class <= 4:
            search = one.search
            edge = new_edge(search.motion, search.curve.packed, search.solid.packed, new_kept(0))
            wanted = SearchBox(one.theta, one.half, one.start, one.end)
            place, theta, tau = onset.newton_onset(claimed.box_class, wanted, edge, jet)
            if place == onset.ROOT_INSIDE and tau > 0.0:
                onset.set_jet_beside(theta, tau, edge, jet)
                if onset.rises(claimed.box_class, jet):
                    yield Box(search, theta, 1e-6, tau - 1e-7, tau + 1e-7, visited=False)


@pytest.mark.slow
def test_a_dropped_box_with_an_onset_is_not_proved() -> None:
    boxes = list(onset_boxes())
    assert len(boxes) >= 5
    for one in boxes:
        assert dropped(one, kind=1) is Outcome.UNDECIDED


@pytest.mark.slow
def test_arcs_that_stay_above_the_plane_are_outside() -> None:
    """Initial boxes that are dropped before their ranges are evaluated, in balls."""
    rng = np.random.default_rng(74)
    boxes = np.zeros(box.BOXES_SIZE)
    said: Counter[Outcome | None] = Counter()
    for i in range(60):
        search = random_search(FORMS[i % len(FORMS)], STAGES[rng.integers(len(STAGES))], rng)
        since, until = sorted(rng.uniform(0.0, 0.4, 2) * motion_scale(search.motion, search.solid.packed))
        edge = new_edge(search.motion, search.curve.packed, search.solid.packed, new_kept(0))
        count = set_initial_boxes(since, until, boxes)
        every, half = boxes[box.X_THETA : box.X_THETA + count].tolist(), boxes[box.X_HALF]
        left = boxes[box.X_THETA : box.X_THETA + drop_above(count, edge, boxes)].tolist()
        for theta in set(every) - set(left):
            said[dropped(Box(search, theta, half, since, until, visited=False), kind=int(box.ALL_OUTSIDE))] += 1
    assert said[Outcome.FAILS] == 0
    assert said[Outcome.UNDECIDED] < 0.01 * said[None]
    assert said[None] > 200


def test_the_page_has_what_was_found(repository_root: Path) -> None:
    text = (repository_root / "docs" / "certificate.md").read_text()
    assert text.count(HEADING) == 1
    written = text[text.index(HEADING) :]
    assert "**0 claims were contradicted" in written
    found = audit_boxes(list(random_boxes(23, 8)))
    assert section(found).splitlines()[:2] == [HEADING, ""]
    assert math.isfinite(max(case.size for case in found.used.values()))
    both = Found()
    both.add(found)
    both.add(found)
    assert both.boxes["made", "at random"] == 16
