"""Case 1: positive roll, no pitch (section 5, figures 6 and 7)."""

from __future__ import annotations

import math

import numpy as np

from studies.paper import statements
from studies.paper.claim import (
    A_FEW_MILLIONTHS,
    ABOUT_SIXTY,
    CONSTANT_RATE,
    MAJORITY,
    NARROW,
    NONLINEAR,
    ON_SURFACE,
    SHIFT,
    SIGNIFICANT_NORMAL,
    Finding,
    Outcome,
    Read,
    Statement,
    Verdict,
    settled,
)
from studies.paper.measures.cases import (
    Case,
    by_tilt,
    in_every_geometry,
    region_before_fall,
    revolutions,
    runs,
    word,
    words,
)
from studies.paper.readings import Reading, declared_angles
from studies.paper.revolution import Array, Revolution, first_contact
from studies.paper.study import Measure, Study, Survey
from threadstate.thread.pair import Pair
from threadstate.thread.regions import BOLT_REGIONS, Region

STATED_ARTEFACTS = {1: 45e-6, 4: 193e-6}
"""The variation (in) that the paper ascribes to the mesh, by roll."""

FILLETS = frozenset((Region.ROOT_FILLET_POS, Region.ROOT_FILLET_NEG, Region.CREST_FILLET_POS, Region.CREST_FILLET_NEG))


def crest_leads(study: Study) -> Outcome:
    """The region of the lowest point of the base outline at phase 0."""

    def test(reading: Reading) -> Finding:
        regions = [
            _lowest_region(study.pair, *declared_angles(reading, roll, 0, 0))
            for roll in study.scale.tilts_deg
            if roll > 0
        ]
        return Finding(words(dict.fromkeys(regions)), set(regions) == {Region.CREST})

    turned_first = Read(Reading.TURN_FIRST.value, test(Reading.TURN_FIRST))
    return settled(test(Reading.DECLARED), [turned_first], "the declared datum was chosen for it: no evidence")


def _lowest_region(pair: Pair, roll_deg: float, pitch_deg: float, phase_deg: float) -> Region:
    del phase_deg  # it turns the tilted outline about the vertical
    thetas = np.radians(np.arange(0.0, 360.0, 0.1))
    axial = -pair.thread_pitch * thetas / (2.0 * math.pi)
    radii = np.array([pair.bolt.radius(s) for s in axial.tolist()])
    roll, pitch = math.radians(roll_deg), math.radians(pitch_deg)
    heights = radii * (math.cos(pitch) * math.sin(roll) * np.sin(thetas) - math.sin(pitch) * np.cos(thetas))
    index, _ = pair.bolt.region_index(float(axial[np.argmin(heights)]))
    return BOLT_REGIONS[index]


def at_the_surface(survey: Survey) -> Finding:
    """The share of phases with the contact at the surface."""
    shares = [(one, 1.0 - float(one.below.mean())) for one in revolutions(survey, Case.ONE)]
    return Finding(
        by_tilt((one, f"{share:.1%}") for one, share in shares), all(share > MAJORITY for _, share in shares)
    )


def crest_sequence(survey: Survey) -> Finding:
    """The bolt's regions in order while the contact is at the surface."""
    wanted = (Region.CREST_FILLET_POS, Region.CREST, Region.CREST_FILLET_NEG)
    found = [
        (one, runs([one.bolt_regions[i] for i in one.from_fall if not one.below[i]]))
        for one in revolutions(survey, Case.ONE)
    ]
    return Finding(
        by_tilt((one, words(regions)) for one, regions in found), all(regions == wanted for _, regions in found)
    )


def ledge(survey: Survey) -> Finding:
    """The nut's region before the fall."""
    return region_before_fall(survey, Case.ONE, Region.ROOT_FILLET_NEG)


def shifts_down(study: Study) -> Outcome:
    """The steepest fall within a step over what the lead gives in it, and the descent that holds it."""

    def test(survey: Survey) -> Finding:
        found, holds = [], True
        for one in revolutions(survey, Case.ONE):
            falls = one.falls(one.step_deg)
            if falls.steepest is None:
                found.append((one, "never goes down"))
                holds = False
                continue
            ratio = falls.steepest.fall / _lead(study.pair, one)
            whole = falls.descents[falls.steepest.descent].fall
            found.append(
                (
                    one,
                    f"{falls.steepest.fall:.6f} in from phase {falls.steepest.start_deg:.2f} on, {ratio:.1f} times the "
                    f"lead, of {whole:.6f} in",
                )
            )
            holds &= ratio > SHIFT
        return Finding(by_tilt(found), holds)

    return in_every_geometry(test)(study)


def _lead(pair: Pair, revolution: Revolution) -> float:
    """What the thread advances in a step of phase."""
    return pair.thread_pitch * revolution.step_deg / 360.0


def switch(survey: Survey) -> Finding:
    """The bolt's regions on either side of the fall."""
    found = [
        (one, (one.bolt_regions[one.before_fall], one.bolt_regions[one.after_fall]))
        for one in revolutions(survey, Case.ONE)
    ]
    wanted = (Region.CREST_FILLET_NEG, Region.CREST_FILLET_POS)
    listed = by_tilt((one, f"from {word(before)} to {word(after)}") for one, (before, after) in found)
    return Finding(listed, all(regions == wanted for _, regions in found))


def rises_with_the_lead(study: Study) -> Outcome:
    """Rates after the fall over the lead's."""

    def test(survey: Survey) -> Finding:
        found, holds = [], True
        for one in revolutions(survey, Case.ONE):
            rates = _rates_below(one) / _lead(study.pair, one)
            listed = (
                f"{rates.min():.4f} to {rates.max():.4f} over {len(rates) * one.step_deg} deg"
                if len(rates)
                else "no rise"
            )
            found.append((one, listed))
            holds &= bool(len(rates)) and bool(np.all(np.abs(rates - 1.0) < CONSTANT_RATE))
        return Finding(by_tilt(found), holds)

    return in_every_geometry(test)(study)


def _rates_below(revolution: Revolution) -> Array:
    """Changes of the height, step by step after the fall, as long as both ends are below the surface."""
    below = revolution.below[revolution.from_fall]
    count = int(np.argmin(below))
    return np.diff(revolution.heights[revolution.from_fall[:count]])


def artefacts(study: Study) -> Outcome:
    """The exact height's own variation beside the fall."""
    measured = []
    for one in revolutions(study.declared, Case.ONE):
        stated = STATED_ARTEFACTS.get(one.roll_deg)
        if stated is None:
            continue
        beside = one.heights[(one.beyond_fall_deg <= NARROW) & ~one.below]
        measured.append((one, stated, float(np.ptp(beside))))
    listed = by_tilt((one, f"{own * 1e6:.0f} microinches, stated {stated * 1e6:.0f}") for one, stated, own in measured)
    if all(own < stated for _, stated, own in measured):
        return Outcome(listed, Verdict.AGREES)
    return Outcome(
        listed,
        Verdict.UNDECIDED,
        "the exact height gives way by more than the stated variation before the fall, where the nut's edge takes "
        "over from its surface; what of Fig. 7 the 45 and 193 microinches measure would have to be known",
    )


def shift_grows(survey: Survey) -> Finding:
    """Shift and window by roll."""
    turns = revolutions(survey, Case.ONE)
    shifts = [0.0 if one.main_descent is None else one.main_descent.fall for one in turns]
    windows = [one.degrees(one.below) for one in turns]
    proportional = shifts[0] * turns[-1].roll_deg / turns[0].roll_deg
    holds = (
        all(np.diff(shifts) > 0.0)
        and abs(shifts[-1] / proportional - 1.0) > NONLINEAR
        and all(np.diff(windows) >= 0)
        and windows[-1] > windows[0]
    )
    listed = by_tilt(
        (one, f"shift {shift:.6f} in, window {window} deg")
        for one, shift, window in zip(turns, shifts, windows, strict=True)
    )
    return Finding(listed, holds)


def normals_are_steady(survey: Survey) -> Finding:
    """How far the normals turn away from the fall."""
    spreads = []
    for one in revolutions(survey, Case.ONE):
        normals = one.normals[one.beyond_fall_deg > NARROW]
        mean = normals.mean(axis=0)
        cosines = normals @ mean / np.linalg.norm(mean)
        spreads.append((one, math.degrees(math.acos(min(1.0, float(cosines.min()))))))
    return Finding(
        by_tilt((one, f"{spread:.1f} deg") for one, spread in spreads),
        all(spread < SIGNIFICANT_NORMAL for _, spread in spreads),
    )


def fillets_are_few(survey: Survey) -> Finding:
    """The range of phase with a fillet in contact."""
    spans = [
        (
            one,
            one.degrees(
                np.array([b in FILLETS or n in FILLETS for b, n in zip(one.bolt_regions, one.nut_regions, strict=True)])
            ),
        )
        for one in revolutions(survey, Case.ONE)
    ]
    return Finding(by_tilt((one, f"{span} deg") for one, span in spans), all(span <= ABOUT_SIXTY for _, span in spans))


def has_a_plateau(survey: Survey) -> Finding:
    """The share of phases at the greatest height."""
    shares = [
        (one, float(np.mean(one.heights > one.heights.max() - ON_SURFACE))) for one in revolutions(survey, Case.ONE)
    ]
    return Finding(
        by_tilt((one, f"{share:.1%} at the greatest height") for one, share in shares),
        all(share > MAJORITY for _, share in shares),
    )


def helices_cancel(survey: Survey) -> Finding:
    """The ranges of the contact's azimuth on the bolt and of the height, outside 60 deg around the fall."""
    found, holds = [], True
    for one in revolutions(survey, Case.ONE):
        far = np.flatnonzero(one.beyond_fall_deg > NARROW)
        points = np.array([first_contact(one.states[i]).point_bolt for i in far])
        azimuth_deg = np.degrees(np.unwrap(np.arctan2(points[:, 1], points[:, 0])))
        moved, varied = float(np.ptp(azimuth_deg)), float(np.ptp(one.heights[far]))
        found.append((one, f"contact moves {moved:.1f} deg, height {varied * 1e6:.0f} microinches"))
        holds &= moved > 1.0 and varied < A_FEW_MILLIONTHS
    return Finding(by_tilt(found), holds)


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.LEADING_CREST, crest_leads),
    (statements.ON_THE_SURFACE, in_every_geometry(at_the_surface)),
    (statements.CREST_SEQUENCE, in_every_geometry(crest_sequence)),
    (statements.LEDGE_1, in_every_geometry(ledge)),
    (statements.NEGATIVE_SHIFT, shifts_down),
    (statements.SWITCH_1, in_every_geometry(switch)),
    (statements.RISE, rises_with_the_lead),
    (statements.ARTEFACTS, artefacts),
    (statements.NONLINEAR_SHIFT, in_every_geometry(shift_grows)),
    (statements.STEADY_NORMALS, in_every_geometry(normals_are_steady)),
    (statements.FILLET_RANGE, in_every_geometry(fillets_are_few)),
    (statements.NOT_A_SAWTOOTH, in_every_geometry(has_a_plateau)),
    (statements.HELICES_CANCEL, in_every_geometry(helices_cancel)),
)
