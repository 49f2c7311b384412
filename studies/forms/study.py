"""Forms of threads at both ends of their tolerances: beside the brute force, and under perturbation.

All is in inches, in which the tolerances of the brute force are; every form is tried in a small size.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from oracle.first_height import first_height
from oracle.state_turns import begins_at, turns_of, within_brute_force
from studies.methods import Case, ExactMethod, PoseDeg, Refusal
from studies.stability.brute_force import missed_later
from studies.stability.change import SolvedCase
from studies.stability.laws import broken_laws
from studies.stability.place_study import Chunk, study
from studies.stability.tally import Tally
from studies.stability.trials import perturbations
from threadstate.state.model import ContactState, Flag
from threadstate.thread.catalogue import pair_by_designation
from threadstate.thread.pair import Pair
from threadstate.thread.regions import Region
from threadstate.units import LengthUnit

TILT_DEG = 4.0
NEAR_PHASE_DEG = 20.0
"""Every other pose is no farther than that from in phase, where threads meet."""
HEIGHT_PITCHES = 1e-9
LEAST_TURN_DEG = 1e-4
BESIDE_END_DEG = (1e-4, 1e-5, 1e-6)
NEAR_PITCHES = (1e-3, 1e-4)
"""A contact begins at the end of a turn if it does from so much before to so much after it, so near, in one of these.

A crest without play overlaps its root in a film that comes from the first contact to within 1e-3 thread pitches of the
second before that begins.
"""
SEED = 418
METHOD = ExactMethod()


FORMS = tuple(
    f"{size}{end}"
    for size in (
        "1/4-20 UNC-2A/2B",
        "M6x1-6g/6H",
        "1/4-16 ACME-2G",
        "1/4-16 STUB ACME-2G",
        "Tr 8x1.5-7e/7H",
        "1/4-20 BSW-medium/normal",
        "M6x1-6g/6H LH",
        "Tr 8x1.5-7e/7H 2 starts",
        "1/4-16 ACME-2G with sharp corners",
        "Tr 8x1.5-7e/7H with sharp corners",
        "1/4-20 UNJC-3A/3B",
        "MJ6x1-4h6h/4H5H",
        "1/2-20 BUTT-2A/2B",
        "1/2-20 PUSH-BUTT-2A/2B",
    )
    for end in ("", " at minimum material")
)
"""Designations of the pairs."""


def pair_of(form: str) -> Pair:
    """The pair of a form, in inches."""
    return pair_by_designation(form).in_unit(LengthUnit.INCH)


@dataclass(frozen=True)
class Amount:
    """How much is done of each form: poses beside the brute force, how many of them with their turns, centres."""

    heights: int
    turns: int
    centres: int


@dataclass(slots=True)
class Found:
    """What was found of a form; two of them add up. Faults are poses and what is wrong, in words.

    ``proved`` heights are above the samples', which stepped over a narrow pocket: the contact lies on both surfaces.
    ``corners`` are the contacts on a fillet, or on the corner in its place, by part and region.
    """

    heights: int = 0
    refused: int = 0
    proved: int = 0
    contacts: int = 0
    turns: int = 0
    onsets: int = 0
    corners: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    perturbed: Tally = field(default_factory=Tally)

    def add(self, other: Found) -> None:
        """Add what was found in other poses."""
        for name in ("heights", "refused", "proved", "contacts", "turns", "onsets"):
            setattr(self, name, getattr(self, name) + getattr(other, name))
        self.corners.update(other.corners)
        self.faults += other.faults
        self.perturbed.add(other.perturbed)


def poses_of(number: int, count: int) -> list[PoseDeg]:
    """Random poses of the form with that number; every other one near in phase."""
    choose = np.random.default_rng([SEED, number])
    tilts = choose.uniform(-TILT_DEG, TILT_DEG, (count, 2))
    phases = choose.uniform(-180.0, 180.0, count)
    phases[::2] *= NEAR_PHASE_DEG / 180.0
    return [(float(roll), float(pitch), float(phase)) for (roll, pitch), phase in zip(tilts, phases, strict=True)]


@dataclass(frozen=True)
class Task:
    """Some poses of a form: beside the brute force, with turns or without, or as centres of perturbations."""

    form: int
    poses: tuple[PoseDeg, ...]
    first: int
    turns: int = 0
    perturb: bool = False


POSES_A_TASK = 25
CENTRES_A_TASK = 4


def tasks(amount: Amount, forms: tuple[str, ...] = FORMS) -> Iterator[Task]:
    """All of the work, form by form."""
    for number in range(len(forms)):
        poses = poses_of(number, amount.heights)
        for start in range(0, amount.heights, POSES_A_TASK):
            chosen = tuple(poses[start : start + POSES_A_TASK])
            yield Task(number, chosen, start, turns=max(0, min(amount.turns - start, len(chosen))))
        centres = poses_of(len(forms) + number, amount.centres)
        for start in range(0, amount.centres, CENTRES_A_TASK):
            yield Task(number, tuple(centres[start : start + CENTRES_A_TASK]), start, perturb=True)


def done(task: Task, forms: tuple[str, ...] = FORMS) -> Found:
    """What a task finds."""
    pair = pair_of(forms[task.form])
    cases = [Case(pair, pose) for pose in task.poses]
    if task.perturb:
        chunk = Chunk(forms[task.form], task.first, tuple(cases), tuple(perturbations(cases, task.first)))
        return Found(perturbed=study(METHOD, chunk))
    found = Found()
    for number, (case, answer) in enumerate(zip(cases, METHOD.answers(cases), strict=True)):
        if isinstance(answer, Refusal):
            found.refused += 1
            continue
        solved = SolvedCase(case, answer)
        _look_at(solved, found)
        if number < task.turns and not {Flag.TIE, Flag.BALANCED} & {*answer.flags}:
            _look_at_turns(solved, found)
    return found


def _look_at(solved: SolvedCase, found: Found) -> None:
    """The laws, and the height beside the brute force's."""
    case, state = solved.case, solved.state
    found.heights += 1
    found.contacts += len(state.contacts)
    found.corners.update(_corners(state))
    broken = broken_laws(METHOD, solved)
    found.faults += [f"{case.pose_deg}: {fault}" for fault in broken]
    above = state.poses[0].translation[2] - first_height(case.pair, *case.pose_deg).height
    slack = HEIGHT_PITCHES * case.pair.thread_pitch
    if above < -slack:
        found.faults.append(f"{case.pose_deg}: the height is too low by {-above:.2e} in")
    found.proved += above > slack and not broken


def _corners(state: ContactState) -> Iterator[str]:
    for contact in state.contacts:
        for part, region in (("bolt", contact.bolt_region), ("nut", contact.nut_region)):
            if region not in (Region.BASE, Region.SURFACE) and "fillet" in region.value:
                yield f"{part} {region.value.rpartition('_')[0]}"


def _look_at_turns(solved: SolvedCase, found: Found) -> None:
    """No turn passes a contact onset, and each ends where its contacts begin."""
    case = solved.case
    found.turns += 1
    if missed_later(solved):
        found.faults.append(f"{case.pose_deg}: a turn passes a contact onset")
    for turn in turns_of(case.pair, solved.state):
        if turn.turn_deg is None or turn.turn_deg < LEAST_TURN_DEG or not within_brute_force(turn):
            continue
        for contact in turn.found:
            if contact.features.value == "flush":
                continue
            found.onsets += 1
            point = np.array(contact.point)
            if not any(
                begins_at(case.pair, turn, point, beside, near) for near in NEAR_PITCHES for beside in BESIDE_END_DEG
            ):
                found.faults.append(f"{case.pose_deg}: no contact begins where turn {turn.stage} ends")
