"""Checks by the brute force: of two neighbouring states between which answers jump, and of single states.

It knows nothing of the solver: first heights by columns, components by rays, lifts by samples (``oracle``). Its
tolerances are inches on a 1/4-20. Beside a jump the two edges share a sliver a few thousandths of a degree wide, which
samples all round miss: there columns are dense about one place.
"""

from __future__ import annotations

import math
from enum import StrEnum

import numpy as np

from oracle import first_height as oracle
from oracle import lift as oracle_lift
from oracle.compiled import compiled
from oracle.first_height import first_height
from oracle.overlap import excluded_rows, free_component
from oracle.pose import pose_rotation
from oracle.profile import Floats, bolt_profile, nut_profile
from oracle.state_turns import Turn, deepest_near, earlier_appearance, spreads_from_contact, turns_of
from studies.certificate.exact import UncoveredError
from studies.stability.change import SolvedCase, allowed, change_between, leading_contacts, pivot_lever
from studies.stability.crossings import crossing_height
from threadstate.state.model import Contact, ContactState, FeaturePair, Flag
from threadstate.thread.pair import Pair

HALF_WIDTH_DEG = 0.1
SAMPLES = 20_001
"""At most 1e-5 deg apart."""
CROSSING_WIDTH_DEG = 5e-3
"""How far from a crossing of edges that may be about to part their overlap may be widest."""

_height, _zoom_curve = oracle._height, oracle._zoom_curve


@compiled
def _highest(feature: int, middle: float, half: float, rot: Floats, bolt: Floats, nut: Floats) -> float:
    step = 2.0 * half / (SAMPLES - 1)
    best, best_u = -1e9, middle
    for i in range(SAMPLES):
        u = middle - half + i * step
        h = _height(feature, u, 0.0, rot, bolt, nut)
        if h > best:
            best, best_u = h, u
    return max(best, _zoom_curve(feature, best_u, step, rot, bolt, nut)[0])


def first_height_near(
    pair: Pair, pose_deg: tuple[float, float, float], contact: Contact, from_deg: float = 0.0
) -> float:
    """Height of the bolt's origin (pose in degrees) at which either edge first touches near a contact's azimuths.

    Near is within ``HALF_WIDTH_DEG``, and no nearer than ``from_deg``. In the pair's unit.
    """
    bolt, nut, rot = bolt_profile(pair), nut_profile(pair), pose_rotation(*pose_deg)
    half, away = (0.5 * math.radians(HALF_WIDTH_DEG + sign * from_deg) for sign in (-1.0, 1.0))
    on_bolt, on_nut = (math.atan2(point[1], point[0]) for point in (contact.point_bolt, contact.point))
    rot = np.ascontiguousarray(rot)
    return max(
        float(_highest(feature, azimuth + side, half, rot, bolt, nut))
        for feature, azimuth in ((oracle.BOLT_EDGE, on_bolt), (oracle.NUT_EDGE, on_nut))
        for side in (-away, away)
    )


HEIGHT_TOLERANCE_INCH = 1e-9
LIFT_TOLERANCE_INCH = 1e-8
"""The brute force's lift is good to 1e-10 thread pitches where it is not zero, and a touch may be 1e-8 p deep."""
SPLIT_INCH = 1e-6
"""A component that is deeper when it is first seen, to 1e-5 deg, has split from an overlap and is no contact onset."""
PROBES_DEG = (1e-3, 1e-2, 5e-2)
"""How far after the end of the shorter turn the longer one is probed."""
SHORT_OF_END_DEG = 1e-4
LIMIT_DEG = 45.0
MAX_LIFTS = 40
BESIDE_PITCHES = 1e-3
LIFTS_BETWEEN = 20
STEPS = 14
"""Instants of a turn at which all of it is sampled."""


class Event(StrEnum):
    """What explains a jump between two poses that are next to each other."""

    FLAGGED = "flagged (tie, balanced, patch)"
    FIRST_REPLACED = "another first contact at equal height"
    FIRST_LOST = "first contact lost (jump)"
    LATER_REPLACED = "another later contact at equal turn"
    LATER_LOST = "later contact appears, vanishes or merges"
    SPLIT = "an overlap splits: no contact onset by decision 1"
    BALANCED = "the origin passes over the pivot axis: the third turn changes its sense"
    EMBEDMENT = "embedment jumps, confirmed by the brute force"
    STEEP = "steep, but continuous"


class Fault(StrEnum):
    """A silent failure."""

    MISSED_FIRST = "a higher first contact is missed"
    MISSED_LATER = "an earlier second or third contact is missed"
    WRONG_EMBEDMENT = "embedment is not the least lift"
    LAW = "a law is broken"
    UNEXPLAINED = "an unexplained jump"
    CLASS = "the class flips though its margins exceed the change"


Explanation = Event | Fault


def explanation(one: SolvedCase, other: SolvedCase) -> Explanation:
    """Why the answers to two cases that are next to each other differ."""
    a, b = one.state, other.state
    height_allowed, rest_allowed = allowed(one.case, other.case)
    height_allowed += HEIGHT_TOLERANCE_INCH
    if abs(a.poses[0].translation[2] - b.poses[0].translation[2]) > height_allowed:
        upper, lower = sorted((one, other), key=lambda side: side.state.poses[0].translation[2], reverse=True)
        missed = missed_first(upper) or missed_first(lower) or _missed_beside(lower, upper)
        return Fault.MISSED_FIRST if missed else Event.FIRST_LOST
    if any(flag in state.flags for state in (a, b) for flag in (Flag.TIE, Flag.BALANCED)):
        return Event.FLAGGED
    here, there = leading_contacts(a), leading_contacts(b)
    if 1 not in here or 1 not in there:
        return Event.FLAGGED
    slack = rest_allowed + 1e-7
    if math.dist(here[1].point, there[1].point) > slack:
        return Event.FIRST_REPLACED
    for stage, turn, turn_too in ((2, a.lambda_deg, b.lambda_deg), (3, a.mu_deg, b.mu_deg)):
        longer = one if (turn or LIMIT_DEG) > (turn_too or LIMIT_DEG) else other
        short_turn = min(turn or LIMIT_DEG, turn_too or LIMIT_DEG)
        if turn is None and turn_too is None:
            break
        if stage == 3 and _passes_over(a, b, slack):
            return Event.BALANCED
        if turn is None or turn_too is None or math.radians(abs(turn - turn_too)) * one.case.reach > slack:
            return _later(longer, stage, short_turn)
        if (stage in here) != (stage in there):
            return Event.LATER_REPLACED
        if stage in here and math.dist(here[stage].point, there[stage].point) > slack:
            return Event.LATER_REPLACED
    change = change_between(one, other)
    if change is not None and change.number > slack:
        return Fault.WRONG_EMBEDMENT if wrong_embedment(one) or wrong_embedment(other) else Event.EMBEDMENT
    return Fault.UNEXPLAINED


def _passes_over(a: ContactState, b: ContactState, slack: float) -> bool:
    """Whether the origin is on the pivot axis between two states, to within the most that the axis may move."""
    lever, lever_too = pivot_lever(a), pivot_lever(b)
    return lever is not None and lever_too is not None and lever * lever_too <= 0.0 and abs(lever) <= slack


def _later(longer: SolvedCase, stage: int, short_turn: float) -> Explanation:
    """Why one turn goes on where its neighbour's ends: the brute force checks whether it passes a component."""
    turn = turns_of(longer.case.pair, longer.state)[stage - 2]
    end = turn.end_deg(LIMIT_DEG)
    probes = [short_turn + probe for probe in PROBES_DEG] + [0.5 * (short_turn + end)]
    if not any(_is_free(longer, turn, probe) for probe in probes if probe < end - SHORT_OF_END_DEG):
        return Event.LATER_LOST
    return Fault.MISSED_LATER if _passes_an_onset(longer, turn) else Event.SPLIT


def _is_free(solved: SolvedCase, turn: Turn, turn_deg: float) -> bool:
    rotation, translation = turn.pose_after(turn_deg)
    rotation = np.ascontiguousarray(rotation)
    excluded = excluded_rows(rotation, translation, turn.known)
    pair = solved.case.pair
    return free_component(rotation, translation, bolt_profile(pair), nut_profile(pair), excluded, True)[0] > 0.0


def _passes_an_onset(solved: SolvedCase, turn: Turn) -> bool:
    pair = solved.case.pair
    seen = earlier_appearance(pair, turn, LIMIT_DEG, STEPS)
    return seen is not None and seen.depth < SPLIT_INCH and not spreads_from_contact(pair, turn, seen)


def missed_first(solved: SolvedCase) -> bool:
    """Whether the bolt touches the nut before it has come down to the reported height.

    A height that is too great needs no check: the laws have the reported contact lie in both solids there.
    """
    reported = solved.state.poses[0].translation[2]
    return first_height(solved.case.pair, *solved.case.pose_deg).height > reported + HEIGHT_TOLERANCE_INCH


def _missed_beside(lower: SolvedCase, upper: SolvedCase) -> bool:
    """Whether the lower of two neighbours still touches where the upper one does, before it has come down.

    Where that is a crossing of both edges, which may overlap by less than doubles can tell, it is decided in fifty
    digits, and what those do not decide counts as missed.
    """
    allowed_height = lower.state.poses[0].translation[2] + HEIGHT_TOLERANCE_INCH
    held = leading_contacts(upper.state)
    if 1 not in held:
        return False
    pair, pose_deg, contact = lower.case.pair, lower.case.pose_deg, held[1]
    if first_height_near(pair, pose_deg, contact) <= allowed_height:
        return False
    if contact.features is not FeaturePair.EDGE_EDGE:
        return True
    if first_height_near(pair, pose_deg, contact, CROSSING_WIDTH_DEG) > allowed_height:
        return True
    try:
        height = crossing_height(pair, pose_deg, contact, CROSSING_WIDTH_DEG)
    except UncoveredError:
        return True
    return height is not None and height > allowed_height


def missed_later(solved: SolvedCase) -> bool:
    """Whether the second or the third turn passes a contact onset."""
    if not _turns(solved.state):
        return False
    return any(_passes_an_onset(solved, turn) for turn in turns_of(solved.case.pair, solved.state))


def wrong_embedment(solved: SolvedCase) -> str:
    """What is wrong with the embedment, in words: it is not the least lift that frees the third pose; else empty.

    Beside the near-phase window the brute force's lift can creep on by its own resolution; it is followed no farther
    than ``MAX_LIFTS`` of its steps, and an embedment beyond is not checked. Its samples can step over a film of overlap
    beside a contact: there they are dense.
    """
    state = solved.state
    if state.embedment is None or len(state.poses) < 3:
        return ""
    pose = state.poses[2]
    lift, is_free = _lifted(solved.case.pair, np.array(pose.rotation), np.array(pose.translation))
    far = lift - state.embedment
    if abs(far) <= LIFT_TOLERANCE_INCH or (far < 0.0 and not is_free):
        return ""
    if far < 0.0 and _overlaps_beside_contacts(solved, lift, state.embedment - LIFT_TOLERANCE_INCH):
        return ""
    return f"embedment {state.embedment:.3g} in, least lift {lift:.3g} in, drop {state.drop or 0.0:.3g} in"


def _overlaps_beside_contacts(solved: SolvedCase, low: float, high: float) -> bool:
    """Whether the third pose overlaps beside one of its contacts at each of ``LIFTS_BETWEEN`` lifts in a range."""
    pair, pose = solved.case.pair, solved.state.poses[2]
    p = pair.thread_pitch
    return all(
        any(
            deepest_near(
                pair,
                np.array(pose.rotation),
                np.array(pose.translation) + np.array([0.0, 0.0, lift]),
                np.array(contact.point),
                BESIDE_PITCHES * p,
            )
            > oracle_lift.TOUCH * p
            for contact in solved.state.contacts
        )
        for lift in np.linspace(low, high, LIFTS_BETWEEN).tolist()
    )


def _lifted(pair: Pair, rotation: Floats, translation: Floats) -> tuple[float, bool]:
    """The brute force's least lift in the pair's unit and whether the solids are apart after it."""
    near = oracle_lift.NEAR * pair.thread_pitch
    bolt, nut = bolt_profile(pair), nut_profile(pair)
    lift = 0.0
    for _ in range(MAX_LIFTS):
        end = float(oracle_lift._greatest_end(lift, near, np.ascontiguousarray(rotation), translation, bolt, nut))
        if end <= lift + 1e-12:
            return lift, True
        lift = end
    return lift, False


def _turns(state: ContactState) -> bool:
    """Whether the state begins with one contact about which the bolt then turns."""
    return 1 in leading_contacts(state) and Flag.TIE not in state.flags and Flag.BALANCED not in state.flags
