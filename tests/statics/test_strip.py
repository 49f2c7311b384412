"""A level bolt in phase, which lies flank on flank along a helix (forces, section 2)."""

from __future__ import annotations

import math

import numpy as np
import pytest

from oracle.statics.friction import hold_friction, wedge_friction
from oracle.statics.loads import support_margin
from oracle.statics.wrenches import Wrench
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_pose, solve_poses
from threadstate.statics.extras import Extra, extras_of
from threadstate.statics.jamming import jamming_diagram
from threadstate.statics.load import Load
from threadstate.statics.rows import stored_statics
from threadstate.statics.solve import statics_of
from threadstate.statics.stretches import LoadedOrientation
from threadstate.statics.touching import STRIP_SAMPLES, strip_outline, touching
from threadstate.statics.verdict import Verdict
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = pytest.mark.slow

PAIR = quarter_twenty_unc()
RADIUS = PAIR.nominal_diameter / 2.0
IN_PHASE = (358.0, 359.0, 0.0, 1.0, 2.0)
LOADS = (
    Load(),
    Load(force=(0.1, 0.0, -1.0)),
    Load(point=(0.1, -0.02, 0.0)),
    Load((0.55, 0.05, -1.0), point=(0.1, -0.02, 0.0)),
)


def test_the_outline_lies_on_the_flanks_of_both_and_ends_at_the_corners() -> None:
    for phase in IN_PHASE:
        state = solve_pose(PAIR, 0.0, 0.0, phase)
        outline, gap = strip_outline(state.contacts)
        assert len(outline) == 2 * STRIP_SAMPLES
        ends = [outline[0], outline[STRIP_SAMPLES - 1], outline[STRIP_SAMPLES], outline[-1]]
        for contact in state.contacts:
            point, normal = min(ends, key=lambda one: math.dist(one[0], contact.point))
            assert point == pytest.approx(contact.point, abs=1e-15)
            assert normal == pytest.approx(contact.normal, abs=1e-14)
        # Along each curve the surface with these normals stays at its height.
        points, normals = (np.array(rows) for rows in zip(*outline, strict=True))
        for curve in (slice(0, STRIP_SAMPLES), slice(STRIP_SAMPLES, None)):
            steps = np.diff(points[curve], axis=0)
            middle = 0.5 * (normals[curve][1:] + normals[curve][:-1])
            assert np.abs(np.einsum("ka,ka->k", steps, middle)).max() < 1e-3 * np.linalg.norm(steps, axis=1).max()
        assert 0.0 < gap < 1e-3 * PAIR.nominal_diameter


def test_a_strip_is_held_by_its_whole_outline() -> None:
    state = solve_pose(PAIR, 0.0, 0.0, 0.0)
    found = touching(PAIR, state)
    # The witness takes every fourth point, and so a little less: what it holds the whole holds.
    every = [found.own + STRIP_SAMPLES * curve + k for curve in (0, 1) for k in range(0, STRIP_SAMPLES, 4)]
    points = (found.points[every] - np.array(found.origin)) / RADIUS
    normals = found.normals[every]
    wedge = wedge_friction(points, normals, 1.0)
    for load in LOADS:
        wrench = load.about(found.origin)
        witnessed = Wrench.of(wrench[3:], wrench[:3] / RADIUS)
        statics = statics_of(PAIR, state, load)
        hold, margin = hold_friction(points, normals, witnessed, 1.0), support_margin(points, normals, witnessed, 1.0)
        assert statics.support_margin >= margin.lower - 1e-9
        assert statics.support_margin == pytest.approx(margin.upper, abs=2e-3)
        assert hold.upper is not None
        assert statics.hold.lower <= hold.upper * (1.0 + 1e-9)
        assert statics.hold.upper == pytest.approx(hold.lower, rel=0.02)
        assert statics.wedge.lower <= (wedge.upper or math.inf)
        assert statics.wedge.upper == pytest.approx(wedge.lower, rel=1e-2)


def test_what_is_stored_is_of_the_whole_strip() -> None:
    states = solve_poses(PAIR, [(0.0, 0.0, phase) for phase in (*IN_PHASE, 30.0)])
    for state, stored in zip(states, stored_statics(PAIR, states), strict=True):
        statics = statics_of(PAIR, state)
        assert stored is not None
        assert (stored.support_margin, stored.mu_hold) == (statics.support_margin, statics.hold.value)
        assert stored.mu_wedge == statics.wedge.value


def test_along_the_phase_it_is_the_whole_strip() -> None:
    load = LOADS[3]
    solved = LoadedOrientation(PAIR, SolveOptions(), 0.0, 0.0, load)
    for phase, verdict in zip(IN_PHASE, solved.verdicts(IN_PHASE, 0.1), strict=True):
        assert verdict is Verdict.CAN_STAY
        assert statics_of(PAIR, solve_pose(PAIR, 0.0, 0.0, phase), load, 0.1).verdict is verdict


def test_its_forces_balance_and_its_diagram_holds_what_it_holds() -> None:
    state, load = solve_pose(PAIR, 0.0, 0.0, 1.0), LOADS[3]
    statics = statics_of(PAIR, state, load, 0.2)
    extras = extras_of(PAIR, state, statics, [Extra.WRENCHES, Extra.FORCES_RANGE, Extra.MODES])
    assert extras.wrenches is not None
    assert extras.modes is None
    assert extras.forces_range is not None
    assert extras.forces_range.internal_dimension is None
    assert extras.hull_gap > 0.0
    places = {one.contact: one for one in extras.wrenches}
    total = np.array([*load.moment, *load.force])
    for force in statics.forces:
        at = places[force.contact]
        vector = force.normal * np.array(at.normal) + np.array(force.tangential)
        assert np.linalg.norm(force.tangential) <= 0.2 * force.normal * (1.0 + 1e-9)
        total += np.concatenate([np.cross(np.array(at.point) - np.array(load.point), vector), vector])
    assert np.abs(total).max() < 1e-9
    diagram = jamming_diagram(PAIR, state, 0.2, load=load, tolerance=1e-3)
    assert diagram.load_at == pytest.approx((0.55, 0.0))
    xs = [vertex[0] for vertex in diagram.vertices.tolist()]
    assert min(xs) < 0.55 < max(xs)
