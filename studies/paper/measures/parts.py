"""Measurements on the parts and on the paper's own numbers."""

from __future__ import annotations

import math

import numpy as np

from studies.paper import statements
from studies.paper.claim import (
    A_FEW_MILLIONTHS,
    SAME_PLACE,
    WITHIN_A_FACTOR,
    Outcome,
    Statement,
    Verdict,
    decided,
    unanimous,
)
from studies.paper.measures.approaches import approaches
from studies.paper.revolution import Array, first_contact
from studies.paper.solids import Solids, to_bolt, to_nut
from studies.paper.study import Measure, Study
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag, StagePose, StateClass, Vector
from threadstate.units import MILLIMETRES_PER_INCH

ANGLE_CONTROL_DEG = 0.5
CHORD_HEIGHT = 1e-4
COARSE_STEP, FINE_STEP = 100e-6, 1e-6
STATED_REDUCTION = 0.0025
STEP_BY_SECTION = (("4.1", 1e-6), ("6.1", 10e-6), ("8", 1e-6))
CONVERSIONS = (
    ("0.047", "1.19"),
    ("0.046", "1.17"),
    ("0.001", "0.03"),
    ("0.004", "0.10"),
    ("0.0045", "0.11"),
    ("0.0013", "0.03"),
    ("0.000001", "0.0000254"),
)
"""Inches and millimetres as printed; the last is 1 microinch = 25.4e-9 m."""


def far_ends_stay_clear(study: Study) -> Outcome:
    """How often an outline of a far end is inside the other solid."""
    solids = Solids(study.pair)
    azimuths = np.radians(np.arange(0.0, 360.0, 5.0))
    top = solids.bolt_outline(azimuths, study.pair.thread_pitch)
    bottom = solids.nut_outline(azimuths, -study.pair.thread_pitch)
    reached, embedded = [0, 0, 0], 0
    seen = 0
    for state in study.declared.states():
        for stage, pose in enumerate(state.poses):
            deepest = max(
                float(solids.inside_nut(to_nut(pose, top)).max()),
                float(solids.inside_bolt(to_bolt(pose, bottom)).max()),
            )
            possible = stage < 2 or state.state_class is not StateClass.UNSTABLE_TWO_POINT
            seen += possible
            if deepest > SAME_PLACE:
                reached[stage] += possible
                embedded += not possible
    first, second, third = reached
    return Outcome(
        f"of {seen:,} poses {sum(reached)} (first contact {first}, second {second}, third {third}); besides, "
        f"{embedded} third poses that embed more than they drop",
        decided(not any(reached)),
    )


def surface_and_base_take_part(study: Study) -> Outcome:
    """Shares of contacts on the two flat faces."""
    states = list(study.declared.states())
    features = [one.features for state in states for one in state.contacts if one.features is not FeaturePair.FLUSH]
    surface, base = features.count(FeaturePair.EDGE_SURFACE), features.count(FeaturePair.BASE_EDGE)
    flush = sum(Flag.FLUSH in state.flags for state in states)
    return Outcome(
        f"of {len(features):,} contacts at a point {surface:,} on the surface, {base:,} on the base; in {flush:,} of "
        f"{len(states):,} states base lies on surface",
        decided(surface + flush > 0 and base + flush > 0),
    )


def tessellation_deviates_little(study: Study) -> Outcome:
    """Sagittas of the two controls."""
    radius = study.pair.nut.major_diameter / 2.0
    by_angle = radius * (1.0 - math.cos(math.radians(ANGLE_CONTROL_DEG) / 2.0))
    measurement = f"0.5 deg a chord: {by_angle * 1e6:.1f} microinches; chord height alone: {CHORD_HEIGHT * 1e6:.0f}"
    few = [deviation <= A_FEW_MILLIONTHS for deviation in (by_angle, CHORD_HEIGHT)]
    return unanimous(
        measurement,
        few,
        "holds if the angle control is a step in degrees, fails if the chord height governs; the modeller's own "
        "meaning of 0.5 would have to be known",
    )


def descent_step_is_one(study: Study) -> Outcome:
    """Whether the sections name one step."""
    del study
    steps = sorted({step for _, step in STEP_BY_SECTION})
    listed = ", ".join(f"{step * 1e6:g} in {section}" for section, step in STEP_BY_SECTION)
    return Outcome(
        f"microinches: {listed}", decided(len(steps) == 1), "" if len(steps) == 1 else "the paper differs with itself"
    )


def averaged_midpoints_vary(study: Study) -> Outcome:
    """Mean reduction of the variation of the averaged point by finer steps."""
    solids = Solids(study.pair)
    states = [state for revolution in approaches(study.declared) for state in revolution.states]
    found = [(_variations(solids, state, COARSE_STEP), _variations(solids, state, FINE_STEP)) for state in states]
    both = np.array([(coarse, fine) for coarse, fine in found if coarse is not None and fine is not None])
    (coarse_mean, coarse_far), (fine_mean, fine_far) = both.mean(axis=0)
    reduction, bound = coarse_mean - fine_mean, coarse_far - fine_far
    measurement = (
        f"over {len(both)} poses the mean of the edges moves by {coarse_mean:.4f} in with steps of 100, "
        f"{fine_mean:.4f} in with steps of 1; the farthest point that an average could give weight to, "
        f"{coarse_far:.4f} and {fine_far:.4f} in"
    )
    if STATED_REDUCTION / WITHIN_A_FACTOR <= reduction <= STATED_REDUCTION * WITHIN_A_FACTOR:
        return Outcome(measurement, Verdict.AGREES)
    if bound < STATED_REDUCTION:
        return Outcome(measurement, Verdict.DISAGREES)
    return Outcome(
        measurement,
        Verdict.UNDECIDED,
        "the paper's average counts pairs of triangles, wherever they happen to be; its meshes would have to be known",
    )


def _variations(solids: Solids, state: ContactState, step: float) -> tuple[float, float] | None:
    """Largest distances from the exact contact after overshoots up to ``step``: of the averaged point, of any averaged.

    None where no edge is inside the other solid.
    """
    contact = first_contact(state)
    exact = np.array(contact.point)
    largest = []
    for share in (0.25, 0.5, 0.75, 1.0):
        pose = state.poses[0]
        x, y, z = pose.translation
        lowered = StagePose(pose.rotation, (x, y, z - share * step))
        inside = _edges_inside(solids, lowered, contact)
        if inside is not None:
            points, weights = inside
            apart = np.linalg.norm(points - exact, axis=1)
            mean = np.average(points, axis=0, weights=weights)
            largest.append((float(np.linalg.norm(mean - exact)), float(apart.max())))
    return (max(mean for mean, _ in largest), max(far for _, far in largest)) if largest else None


def _edges_inside(solids: Solids, pose: StagePose, contact: Contact) -> tuple[Array, Array] | None:
    """Points of both edges inside the other solid, in the nut's frame, and the arc each stands for; None: none."""
    reach = np.geomspace(1e-7, np.pi, 300)
    offsets = np.concatenate([-reach[::-1], [0.0], reach])
    bolt = to_nut(pose, solids.bolt_outline(offsets + _azimuth(contact.point_bolt), 0.0))
    nut = solids.nut_outline(offsets + _azimuth(contact.point), 0.0)
    inside = np.concatenate([solids.inside_nut(bolt) > 0.0, solids.inside_bolt(to_bolt(pose, nut)) > 0.0])
    if not inside.any():
        return None
    return np.concatenate([bolt, nut])[inside], np.tile(np.gradient(offsets), 2)[inside]


def _azimuth(point: Vector) -> float:
    return math.atan2(point[1], point[0])


def conversions_are_right(study: Study) -> Outcome:
    """How many of the printed conversions are right."""
    del study
    wrong = [
        inches
        for inches, millimetres in CONVERSIONS
        if abs(float(inches) * MILLIMETRES_PER_INCH - float(millimetres)) > 0.5001 * _last_digit(millimetres)
    ]
    return Outcome(f"{len(CONVERSIONS) - len(wrong)} of {len(CONVERSIONS)} are right", decided(not wrong))


def _last_digit(number: str) -> float:
    return float(10.0 ** -len(number.partition(".")[2]))


def flanks_include_sixty(study: Study) -> Outcome:
    """The included angle of the declared flanks."""
    _, slope, _ = study.pair.bolt.derivatives(0.0)
    included = 2.0 * math.degrees(math.atan(1.0 / slope))
    return Outcome(f"{included:.6f} deg", decided(abs(included - 60.0) < 1e-9), "declared so: the unified form")


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.FAR_ENDS, far_ends_stay_clear),
    (statements.SURFACE_AND_BASE, surface_and_base_take_part),
    (statements.FLANK_ANGLE, flanks_include_sixty),
    (statements.TESSELLATION, tessellation_deviates_little),
    (statements.DESCENT_STEP, descent_step_is_one),
    (statements.AVERAGED_MIDPOINTS, averaged_midpoints_vary),
    (statements.CONVERSIONS, conversions_are_right),
)
