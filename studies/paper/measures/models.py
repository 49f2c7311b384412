"""Measurements on the second and the third turn, over all orientations."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Iterator

import numpy as np

from studies.paper import statements
from studies.paper.claim import MAJORITY, NEAR_SURFACE, ON_SURFACE, SAME_PLACE, Finding, Outcome, Statement, unanimous
from studies.paper.measures.cases import in_every_reading
from studies.paper.revolution import Array
from studies.paper.study import Measure, Study, Survey
from threadstate.state.model import Contact, ContactState, StagePose

RARE = 0.01
"""What is at least this share of the states occurs."""

MOST_FREEDOMS = 2
"""The freedoms that the paper counts at most."""

NO_TURN_DEG = 1e-9
"""A second turn up to this is none: two contacts at once."""


def three_contacts(survey: Survey) -> Iterator[ContactState]:
    """The states that reach a third contact."""
    return (state for state in survey.states() if state.mu_deg is not None)


def of_stage(state: ContactState, stage: int) -> Contact:
    """The first listed contact of a stage."""
    return next(contact for contact in state.contacts if contact.stage == stage)


def out_of_plane(study: Study) -> Outcome:
    """Contacts below the surface, and out of a plane with the nut's axis."""
    below, skew, count = 0, 0, 0
    for state in three_contacts(study.declared):
        points = np.array([of_stage(state, stage).point for stage in (1, 2, 3)])
        count += 1
        below += bool(points[:, 2].min() < -ON_SURFACE)
        # In one plane with the axis all points have one direction across it.
        across = points[:, :2]
        skew += bool(np.linalg.svd(across, compute_uv=False)[1] > SAME_PLACE)
    return unanimous(
        f"one below the surface in {below / count:.1%}, not all in one plane with the axis in {skew / count:.1%} of "
        f"{count:,} states with three contacts",
        [below == count, skew == count],
        "out of which plane would have to be known: the nut's surface, or one through its axis",
    )


def corrects_the_tilt(survey: Survey) -> Finding:
    """Change of the angle between the axes over the second turn."""
    changes = np.array([_tilt_deg(s.poses[1]) - _tilt_deg(s.poses[0]) for s in survey.states() if len(s.poses) > 1])
    grown = int(np.count_nonzero(changes > NO_TURN_DEG))
    return Finding(
        f"grows in {grown:,} of {len(changes):,} poses, by up to {max(0.0, float(changes.max())):.2f} deg", grown == 0
    )


def _tilt_deg(pose: StagePose) -> float:
    (_, _, (zx, zy, zz)) = pose.rotation
    return math.degrees(math.atan2(math.hypot(zx, zy), zz))


def lowers_the_origin(survey: Survey) -> Finding:
    """Change of the origin's height over the second turn."""
    falls = np.array(
        [
            state.poses[0].translation[2] - state.poses[1].translation[2]
            for state in survey.states()
            if state.lambda_deg is not None and state.lambda_deg > NO_TURN_DEG
        ]
    )
    risen = int(np.count_nonzero(falls <= 0.0))
    return Finding(f"falls in {len(falls) - risen:,} of {len(falls):,} poses", risen == 0)


def two_freedoms(study: Study) -> Outcome:
    """Degrees of freedom under three meanings of maintained."""
    scale = study.pair.nominal_diameter
    sliding, pinned, held = [], [], []
    for state in three_contacts(study.declared):
        origin = np.array(state.poses[1].translation)
        contacts = [of_stage(state, stage) for stage in (1, 2)]
        arms = [(np.array(contact.point) - origin) / scale for contact in contacts]
        normals = [np.array(contact.normal) for contact in contacts]
        slide = np.array([np.concatenate([n, np.cross(arm, n)]) for n, arm in zip(normals, arms, strict=True)])
        pin = np.array([np.concatenate([axis, np.cross(arm, axis)]) for arm in arms for axis in np.eye(3)])
        sliding.append(slide)
        pinned.append(pin)
        held.append(np.concatenate([slide, np.eye(6)[:2]]))
    found = [_freedoms(np.array(rows)) for rows in (sliding, pinned, held)]
    names = ("the points slide", "they do not slide", "they slide while x and y are held")
    listed = ", ".join(
        f"{low if low == high else f'{low} to {high}'} if {name}"
        for (low, high), name in zip(found, names, strict=True)
    )
    return unanimous(
        listed,
        [high <= MOST_FREEDOMS for _, high in found],
        "what is maintained, and what the compliance holds, would have to be known",
    )


def _freedoms(rows: Array) -> tuple[int, int]:
    """The least and the largest number of freedoms that constraints of shape (n, k, 6) leave."""
    ranks = np.linalg.matrix_rank(rows, tol=1e-9)
    return 6 - int(ranks.max()), 6 - int(ranks.min())


def sense_of_third_turn(state: ContactState) -> int:
    """+1 where the third turn is positive about the axis from the first to the second contact, else -1."""
    before, after = (np.array(state.poses[i].rotation) for i in (1, 2))
    turn = after @ before.T
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]])
    along = np.array(of_stage(state, 2).point) - np.array(of_stage(state, 1).point)
    return 1 if axis @ along > 0.0 else -1


def sense_varies(survey: Survey) -> Finding:
    """Shares of the two senses."""
    senses = [sense_of_third_turn(state) for state in three_contacts(survey)]
    positive = senses.count(1) / len(senses)
    return Finding(
        f"positive in {positive:.1%}, negative in {1.0 - positive:.1%} of {len(senses):,}", RARE <= positive <= 1 - RARE
    )


Configuration = tuple[tuple[bool, bool], bool, bool]
"""Quadrant of the first contact (signs of x and y), whether the axis crosses +X, whether its slope is positive."""


def configuration(state: ContactState) -> Configuration | None:
    """The configuration of the pivot axis seen from above; None where it is parallel to one of the nut's axes."""
    (x0, y0, _), (x1, y1, _) = of_stage(state, 1).point, of_stage(state, 2).point
    if min(abs(x1 - x0), abs(y1 - y0)) < ON_SURFACE:
        return None
    slope = (y1 - y0) / (x1 - x0)
    return (x0 > 0.0, y0 > 0.0), x0 - y0 / slope > 0.0, slope > 0.0


def sense_by_quadrants(survey: Survey) -> Finding:
    """Combinations of quadrants, crossing and slope with one sense and with both."""
    senses: dict[tuple[Configuration, tuple[bool, bool]], list[int]] = defaultdict(list)
    for state in three_contacts(survey):
        where = configuration(state)
        x, y, _ = of_stage(state, 2).point
        if where is not None:
            senses[where, (x > 0.0, y > 0.0)].append(sense_of_third_turn(state))
    mixed = {key: found for key, found in senses.items() if len(set(found)) > 1}
    states = sum(map(len, mixed.values()))
    minority = sum(min(found.count(1), found.count(-1)) for found in mixed.values())
    return Finding(
        f"both senses in {len(mixed)} of {len(senses)} combinations, which hold {states:,} states; a fixed sense for "
        f"each would be wrong in at least {minority:,}",
        not mixed,
    )


def one_is_impossible(survey: Survey) -> Finding:
    """Configurations that occur for each quadrant of the first contact."""
    occurring: dict[tuple[bool, bool], set[tuple[bool, bool]]] = defaultdict(set)
    for state in three_contacts(survey):
        where = configuration(state)
        if where is not None:
            quadrant, crossing, slope = where
            occurring[quadrant].add((crossing, slope))
    counts = [len(found) for found in occurring.values()]
    return Finding(f"{_listed(counts)} of 4 in the {len(counts)} quadrants", counts == [3] * 4)


def _listed(counts: Iterable[int]) -> str:
    return ", ".join(map(str, sorted(counts)))


def at_or_near_the_surface(survey: Survey) -> Finding:
    """The share of contacts not deeper than a tenth of the thread pitch, stage by stage."""
    shares = []
    for stage in (1, 2, 3):
        depths = [contact.point[2] for state in survey.states() for contact in state.contacts if contact.stage == stage]
        shares.append(float(np.mean(np.array(depths) >= -NEAR_SURFACE)))
    return Finding(
        ", ".join(f"{name} {share:.1%}" for name, share in zip(("first", "second", "third"), shares, strict=True)),
        all(share > MAJORITY for share in shares),
    )


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.OUT_OF_PLANE, out_of_plane),
    (statements.CORRECTS, in_every_reading(corrects_the_tilt)),
    (statements.LOWERS, in_every_reading(lowers_the_origin)),
    (statements.TWO_FREEDOMS, two_freedoms),
    (statements.SENSE_VARIES, in_every_reading(sense_varies)),
    (
        statements.SENSE_BY_QUADRANTS,
        in_every_reading(sense_by_quadrants, "the paper's own list of directions is not printed"),
    ),
    (statements.IMPOSSIBLE, in_every_reading(one_is_impossible)),
    (statements.AT_OR_NEAR_SURFACE, in_every_reading(at_or_near_the_surface)),
)
