"""Cases 2 to 4: negative roll, positive pitch, negative pitch (section 5, figures 8 to 10)."""

from __future__ import annotations

from collections import Counter

import numpy as np
from numpy.typing import NDArray

from studies.paper import statements
from studies.paper.claim import (
    MIRRORED_SHARE,
    NARROW,
    QUARTER_TURN,
    SAME_PLACE,
    SEVERAL_DEGREES,
    Finding,
    Outcome,
    Read,
    Statement,
    settled,
)
from studies.paper.measures.cases import Case, by_tilt, in_every_geometry, region_before_fall, revolutions, word
from studies.paper.readings import Reading
from studies.paper.revolution import Revolution
from studies.paper.study import Measure, Study, Survey
from threadstate.state.model import ContactState, Flag
from threadstate.thread.regions import Region


def first_contacts_tie(state: ContactState) -> bool:
    """Whether the bolt meets the nut at two places at once."""
    return Flag.TIE in state.flags and (
        sum(contact.stage == 1 for contact in state.contacts) > 1 or state.lambda_deg == 0.0
    )


def _begins_with_two(one: Revolution, at: int) -> bool:
    state = one.states[at]
    following = one.states[(at + 1) % len(one.states)]
    flanks = {contact.bolt_region for contact in state.contacts[:2]}
    return first_contacts_tie(state) and Region.FLANK_NEG in flanks and not first_contacts_tie(following)


def two_points_at_first(study: Study) -> Outcome:
    """Ties at phase 0; where there is none, at which other phases every roll has one."""

    def common(survey: Survey) -> list[int]:
        turns = revolutions(survey, Case.TWO)
        return [
            i * study.scale.phase_step_deg
            for i in range(len(study.scale.phases_deg))
            if all(_begins_with_two(one, i) for one in turns)
        ]

    def found(survey: Survey, datum: int) -> Finding:
        phases = common(survey)
        return Finding(f"at phase {', '.join(map(str, phases)) or 'none'}", datum in phases)

    data = [Read(f"phase counts from {datum} deg", found(study.declared, datum)) for datum in common(study.declared)]
    turned_first = Read(Reading.TURN_FIRST.value, found(study.turned_first, 0))
    return settled(found(study.declared, 0), [*data, turned_first])


def flank_to_root_fillet(survey: Survey) -> Finding:
    """Phases on negative flank and negative root fillet, on bolt and nut."""
    found, holds = [], True
    for one in revolutions(survey, Case.TWO):
        spans = [
            regions.count(region) * one.step_deg
            for regions in (one.bolt_regions, one.nut_regions)
            for region in (Region.FLANK_NEG, Region.ROOT_FILLET_NEG)
        ]
        found.append(
            (
                one,
                f"bolt: flank {spans[0]}, root fillet {spans[1]}; nut: flank {spans[2]}, root fillet {spans[3]} deg "
                "of phase",
            )
        )
        holds &= all(spans)
    return Finding(by_tilt(found), holds)


def ledge(survey: Survey) -> Finding:
    """The nut's region before the fall."""
    return region_before_fall(survey, Case.TWO, Region.ROOT_FILLET_NEG)


def _smaller_fall(survey: Survey, case: Case) -> Finding:
    """The case's steepest falls beside those of case 1; holds if each is smaller."""
    pairs = zip(revolutions(survey, case), revolutions(survey, Case.ONE), strict=True)
    falls = [(one, one.steepest_fall, first.steepest_fall) for one, first in pairs]
    listed = by_tilt((one, f"{fall:.6f} in, case 1 {first:.6f} in") for one, fall, first in falls)
    return Finding(listed, all(fall < first for _, fall, first in falls))


def subtle_transition(survey: Survey) -> Finding:
    """The steepest fall beside case 1's."""
    return _smaller_fall(survey, Case.TWO)


def contact_in_the_window(survey: Survey) -> Finding:
    """The contact just after the fall."""
    found, holds = [], True
    for one in revolutions(survey, Case.TWO):
        i = one.after_fall
        where = "below the surface" if one.below[i] else "at the surface"
        found.append((one, f"bolt {word(one.bolt_regions[i])}, nut {word(one.nut_regions[i])}, {where}"))
        holds &= bool(one.below[i]) and Region.ROOT_FILLET_POS in (one.bolt_regions[i], one.nut_regions[i])
    return Finding(by_tilt(found), holds)


def no_two_points(survey: Survey) -> Finding:
    """Ties at phase 0."""
    ties = [(one, first_contacts_tie(one.states[0])) for one in revolutions(survey, Case.THREE)]
    return Finding(
        by_tilt((one, "two contacts" if tie else "one contact") for one, tie in ties), not any(t for _, t in ties)
    )


def _commonest_pair(one: Revolution, chosen: NDArray[np.bool_]) -> tuple[tuple[Region, Region], int] | None:
    """The regions of bolt and nut most often in contact at the chosen positions, and how often; None: none chosen."""
    pairs = Counter((one.bolt_regions[i], one.nut_regions[i]) for i in np.flatnonzero(chosen))
    return pairs.most_common(1)[0] if pairs else None


def _pair_holds(survey: Survey, case: Case, wanted: tuple[Region, Region], below: bool) -> Finding:
    """The commonest pair away from the fall, or below the surface; holds if it is ``wanted``."""
    found, holds = [], True
    for one in revolutions(survey, case):
        common = _commonest_pair(one, one.below if below else one.beyond_fall_deg > NARROW)
        if common is None:
            found.append((one, "no contact below the surface"))
        else:
            (bolt, nut), count = common
            found.append((one, f"bolt {word(bolt)}, nut {word(nut)} ({count * one.step_deg} deg)"))
        holds &= common is not None and common[0] == wanted
    return Finding(by_tilt(found), holds)


def negative_fillets(survey: Survey) -> Finding:
    """The pair of regions away from the fall."""
    wanted = (Region.CREST_FILLET_NEG, Region.CREST_FILLET_NEG)
    return _pair_holds(survey, Case.THREE, wanted, below=False)


def advances_a_quarter(survey: Survey) -> Finding:
    """The largest jump of the contact's azimuth."""
    found, holds = [], True
    for one in revolutions(survey, Case.THREE):
        azimuth = np.degrees(np.arctan2(one.points[:, 1], one.points[:, 0]))
        jumps = (np.roll(azimuth, -1) - azimuth + 180.0) % 360.0 - 180.0
        at = int(np.argmax(np.abs(jumps)))
        after = (at + 1) % len(jumps)
        found.append(
            (
                one,
                f"{abs(jumps[at]):.0f} deg at phase {at * one.step_deg}, to bolt {word(one.bolt_regions[after])}, "
                f"nut {word(one.nut_regions[after])}",
            )
        )
        low, high = QUARTER_TURN
        flanks = (one.bolt_regions[after], one.nut_regions[after]) == (Region.FLANK_POS, Region.FLANK_POS)
        holds &= bool(low <= abs(jumps[at]) <= high) and flanks
    return Finding(by_tilt(found), holds)


def drops_little(survey: Survey) -> Finding:
    """The steepest fall beside case 1's."""
    return _smaller_fall(survey, Case.THREE)


def returns_quickly(survey: Survey) -> Finding:
    """The range of phase below the surface."""
    spans = [(one, one.degrees(one.below)) for one in revolutions(survey, Case.THREE)]
    return Finding(
        by_tilt((one, f"{span} deg below the surface") for one, span in spans),
        all(0 < span <= SEVERAL_DEGREES for _, span in spans),
    )


def mirror_image(survey: Survey) -> Finding:
    """The share of phases whose first contact mirrors case 3's."""
    shares = []
    for three, four in zip(revolutions(survey, Case.THREE), revolutions(survey, Case.FOUR), strict=True):
        opposite = -np.arange(len(three.states)) % len(three.states)
        mirrored = three.points[opposite] * np.array([-1.0, 1.0, 1.0])
        apart = np.linalg.norm(four.points - mirrored, axis=1)
        shares.append((four, float(np.mean(apart < SAME_PLACE))))
    return Finding(
        by_tilt((one, f"{share:.1%}") for one, share in shares), all(share >= MIRRORED_SHARE for _, share in shares)
    )


def crest_below(survey: Survey) -> Finding:
    """The pair of regions below the surface."""
    return _pair_holds(survey, Case.FOUR, (Region.CREST, Region.CREST_FILLET_POS), below=True)


MEASURED: tuple[tuple[Statement, Measure], ...] = (
    (statements.TWO_POINTS, two_points_at_first),
    (statements.ROOT_SEQUENCE, in_every_geometry(flank_to_root_fillet)),
    (statements.LEDGE_2, in_every_geometry(ledge)),
    (statements.SUBTLE, in_every_geometry(subtle_transition)),
    (statements.SEEKS_ROOT_FILLET, in_every_geometry(contact_in_the_window)),
    (statements.NO_TWO_POINTS, in_every_geometry(no_two_points)),
    (statements.NEGATIVE_FILLETS, in_every_geometry(negative_fillets)),
    (statements.ADVANCE, in_every_geometry(advances_a_quarter)),
    (statements.MINIMAL_DROP, in_every_geometry(drops_little)),
    (statements.QUICK_RETURN, in_every_geometry(returns_quickly)),
    (
        statements.MIRROR,
        in_every_geometry(mirror_image, "where two edges touch it is exact; threads of one hand have no mirror image"),
    ),
    (statements.BELOW_4, in_every_geometry(crest_below)),
)
