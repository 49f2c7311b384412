"""Laws that hold for every state, whatever method computed it: from docs/method.md, with the geometry of the tests."""

from __future__ import annotations

import math

import numpy as np

from oracle.contact_rules import Touch, frame_gap, normal_faults, region_faults, surface_gaps
from oracle.pose import pose_rotation
from oracle.solids import Floats
from studies.methods import Method
from studies.stability.change import SolvedCase, leading_contacts
from threadstate.state.model import ContactState, Flag, StateClass

ROTATION_TOLERANCE = 1e-12
LEVEL = math.radians(2e-9)
"""A bolt that lies flush from the start may be tilted by no more than this, which its state ignores."""
TURN_TOLERANCE = 1e-9
"""Of an angle, in rad: a rotation's arc cosine is known to the root of round-off where it is small."""


def broken_laws(method: Method, solved: SolvedCase) -> list[str]:
    """The laws that a state breaks, in words; empty if there are none."""
    state = solved.state
    if not _all_finite(state):
        return ["a number that is not finite"]
    case = solved.case
    tolerance = method.declared_error(case.pair)
    if Flag.TIE in state.flags:
        tolerance += case.options.tie_tolerance * case.pair.thread_pitch
    return [
        *_pose_faults(solved, tolerance),
        *_contact_faults(solved, tolerance),
        *_number_faults(state, tolerance),
        *_class_faults(solved),
    ]


def _all_finite(state: ContactState) -> bool:
    numbers = [n for c in state.contacts for n in (*c.point, *c.point_bolt, *c.normal, c.bolt_margin, c.nut_margin)]
    numbers += [n for pose in state.poses for row in (*pose.rotation, pose.translation) for n in row]
    known = (state.lambda_deg, state.mu_deg, state.drop, state.embedment, state.pivot_offset)
    numbers += [n for n in known if n is not None]
    return all(map(math.isfinite, numbers))


def _pose_faults(solved: SolvedCase, tolerance: float) -> list[str]:
    """The first pose is the requested one; each turn keeps the contacts before it, and has the reported angle."""
    state = solved.state
    rotations = [np.array(pose.rotation) for pose in state.poses]
    translations = [np.array(pose.translation) for pose in state.poses]
    roll, pitch, phase = solved.case.pose_deg
    faults = []
    asked = pose_rotation(roll, pitch, phase)
    slack = LEVEL if Flag.FLUSH in state.flags and len(rotations) == 1 else ROTATION_TOLERANCE
    if np.abs(rotations[0] - asked).max() > slack + 2e-16 * abs(phase) or translations[0][:2].any():
        faults.append("the first pose is not the requested one")
    if any(np.abs(r @ r.T - np.eye(3)).max() > ROTATION_TOLERANCE for r in rotations):
        faults.append("a pose is no rotation")
    held = leading_contacts(state)
    for stage, turn_deg in ((2, state.lambda_deg), (3, state.mu_deg)):
        if len(rotations) < stage:
            continue
        before, after = rotations[stage - 2], rotations[stage - 1]
        for contact in (held[k] for k in range(1, stage) if k in held):
            origin = rotations[contact.stage - 1].T @ (np.array(contact.point) - translations[contact.stage - 1])
            if np.linalg.norm(after @ origin + translations[stage - 1] - contact.point) > tolerance:
                faults.append(f"stage {stage} loses the contact of stage {contact.stage}")
        if turn_deg is None or abs(_angle_between(before, after) - math.radians(turn_deg)) > TURN_TOLERANCE:
            faults.append(f"stage {stage} is not reached by its turn")
    return faults


def _angle_between(before: Floats, after: Floats) -> float:
    relative = after @ before.T
    sine = np.array([relative[2, 1] - relative[1, 2], relative[0, 2] - relative[2, 0], relative[1, 0] - relative[0, 1]])
    return math.atan2(float(np.linalg.norm(sine)), float(np.trace(relative)) - 1.0)


def _contact_faults(solved: SolvedCase, tolerance: float) -> list[str]:
    """Both points of a contact are one, on the surfaces that its features name; normal and regions are right."""
    faults = []
    for contact in solved.state.contacts:
        touch = Touch.of(solved.case.pair, contact, solved.state.poses[contact.stage - 1])
        gaps = {"the contact's two points": frame_gap(touch), **surface_gaps(touch)}
        where = f"stage {contact.stage} {contact.features.value}"
        faults += [f"{where}: off {name} by {gap:.1e}" for name, gap in gaps.items() if gap > tolerance]
        faults += [f"{where}: normal {fault}" for fault in normal_faults(touch)]
        faults += [f"{where}: {fault}" for fault in region_faults(touch, tolerance)]
    return faults


def _number_faults(state: ContactState, tolerance: float) -> list[str]:
    """Drop and pivot offset follow from the poses and contacts."""
    faults = []
    heights = [pose.translation[2] for pose in state.poses]
    if state.drop is not None and abs(heights[1] - heights[2] - state.drop) > tolerance:
        faults.append("drop is not that of the poses")
    held = leading_contacts(state)
    if state.pivot_offset is not None and {1, 2} <= held.keys():
        point, other = np.array(held[1].point), np.array(held[2].point)
        axis = (other - point) / np.linalg.norm(other - point)
        offset = np.linalg.norm(np.cross(axis, np.array(state.poses[1].translation) - point))
        if abs(offset - state.pivot_offset) > tolerance:
            faults.append("pivot offset is not that of the contacts")
    return faults


def _class_faults(solved: SolvedCase) -> list[str]:
    """The class is the one of the method's table."""
    state, case = solved.state, solved.case
    threshold = case.options.quasi_stable_fraction * case.pair.nominal_diameter / 2.0
    slack = case.options.embedment_tolerance * case.pair.thread_pitch
    if Flag.FLUSH in state.flags:
        expected = StateClass.STABLE_THREE_POINT
    elif (
        state.drop is None
        or state.embedment is None
        or state.pivot_offset is None
        or state.drop <= state.embedment > slack
    ):
        expected = StateClass.UNSTABLE_TWO_POINT
    elif state.pivot_offset <= threshold:
        expected = StateClass.QUASI_STABLE_TWO_POINT
    else:
        expected = StateClass.STABLE_THREE_POINT
    return [] if state.state_class is expected else [f"class {state.state_class.value}, should be {expected.value}"]
