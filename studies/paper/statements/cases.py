"""Statements on the first contact of a rolled or a pitched bolt: section 5, cases 1 to 4, figures 7 to 10."""

from studies.paper.claim import Statement

LEADING_CREST = Statement(
    "5, case 1",
    "A positive roll makes the crest of the bolt the leading edge.",
    "Region of the lowest point of the bolt's base outline at phase 0, for every roll. Agrees if it is the crest.",
)
ON_THE_SURFACE = Statement(
    "5, case 1",
    "The bolt contacts the surface of the nut for a majority of phase rotation.",
    "Share of phases with the first contact at the height of the nut's surface, for every roll. Agrees if each is "
    "above one half.",
)
CREST_SEQUENCE = Statement(
    "5, case 1",
    "As the bolt turns, its contacting region goes from positive crest fillet to crest to negative crest fillet.",
    "The bolt's regions in order, from the first contact at the surface after the fall to the last before it. "
    "Agrees if they are these three, for every roll.",
)
LEDGE_1 = Statement(
    "5, case 1",
    "The ledge before the clearance window is the nut's negative root fillet.",
    "The nut's region that holds most of the 30 deg of phase before the fall. Agrees if it is this, for every roll.",
)
NEGATIVE_SHIFT = Statement(
    "5, case 1; Fig. 7",
    "Eventually the bolt enters the clearance window and shifts down.",
    "Steepest fall within one step of phase over what the lead gives in it, beside the whole fall of its descent. "
    "Agrees if above 2 for every roll.",
)
SWITCH_1 = Statement(
    "5, case 1",
    "There the contact switches from the negative to the positive crest fillet.",
    "The bolt's regions before and after the fall. Agrees if they are these, for every roll.",
)
RISE = Statement(
    "5, case 1",
    "For the next several degrees the bolt rises at a constant rate given by the pitch (Eq. 1).",
    "Rates of the height after the fall, step by step while the contact is below the surface, over p / 360 deg. "
    "Agrees if all are within 1 % of 1.",
)
ARTEFACTS = Statement(
    "5, case 1; Fig. 7",
    "Variations of 45 microinches (roll 1) and 193 (roll 4) beside the fall are artefacts of the mesh.",
    "How much the exact height, contact at the surface, varies within 30 deg of the fall. Agrees if by less than "
    "the stated variation, which then can be nothing but an artefact; else undecided.",
)
NONLINEAR_SHIFT = Statement(
    "5, case 1",
    "The vertical shift varies nonlinearly with roll: a larger roll widens the window and lets the bolt drop deeper.",
    "Shift: whole fall of the main descent; window: phases with the contact below the surface. Agrees "
    "if the shift grows with every roll and not in proportion (by 10 %), and the window nowhere narrows and widens "
    "over all.",
)
STEADY_NORMALS = Statement(
    "5, case 1",
    "The contact normals do not vary significantly except in the very narrow range of the drop.",
    "Largest angle between the normals and their mean over the phases more than 30 deg from the fall. Agrees if "
    "below 10 deg for every roll.",
)
FILLET_RANGE = Statement(
    "5, case 1; Fig. 7",
    "The contacts are on fillets in no more than about 60 deg of phase.",
    "Phases with a fillet of bolt or nut in contact, for every roll. Agrees up to 66 deg.",
)
NOT_A_SAWTOOTH = Statement(
    "5, case 1; Fig. 7",
    "The depth change is not a sawtooth.",
    "Share of phases at which the height is the greatest of the revolution, to 1e-9 in. Agrees if above one half "
    "for every roll: a sawtooth has no such plateau.",
)
HELICES_CANCEL = Statement(
    "5, case 1",
    "The contacting surfaces change constantly from root to crest, and their helices cancel any vertical motion.",
    "Outside 60 deg around the fall: the range of the contact's azimuth on the bolt, and of the height. Agrees if "
    "the contact moves by more than 1 deg while the height varies by less than 10 microinches, for every roll.",
)
TWO_POINTS = Statement(
    "5, case 2",
    "A negative roll begins with the negative flank leading and two contacts at the surface; after 1 deg there is one.",
    "A tie of first contacts at phase 0, one of them on the bolt's negative flank, and no tie at the next phase, "
    "for every roll. Agrees if so; undecided if so at another phase.",
)
ROOT_SEQUENCE = Statement(
    "5, case 2",
    "The contact goes from negative flank to negative root fillet, on the bolt and on the nut.",
    "Phases with the negative flank and with the negative root fillet in contact, on either part. Agrees if all "
    "four occur for every roll.",
)
LEDGE_2 = Statement(
    "5, case 2",
    "The nut's negative root fillet is the ledge that keeps the bolt from contacts below the surface.",
    "The nut's region that holds most of the 30 deg of phase before the fall. Agrees if it is this, for every roll.",
)
SUBTLE = Statement(
    "5, case 2; Fig. 8",
    "The vertical transition is subtler than in case 1.",
    "Steepest fall beside that of the same roll, positive. Agrees if smaller for every roll.",
)
SEEKS_ROOT_FILLET = Statement(
    "5, case 2",
    "In the window the contact is on the positive root fillet, below the surface.",
    "Regions of the contact just after the fall, and its depth. Agrees if a positive root fillet of either part is "
    "in contact below the surface, for every roll.",
)
NO_TWO_POINTS = Statement(
    "5, case 3",
    "A positive pitch does not start with two contacts.",
    "Ties of the first contact at phase 0. Agrees if there is none for every pitch.",
)
NEGATIVE_FILLETS = Statement(
    "5, case 3",
    "The contact is between the negative crest fillets of bolt and nut.",
    "The pair of regions that is in contact over most of the phases more than 30 deg from the fall. Agrees if it is "
    "this pair for every pitch.",
)
ADVANCE = Statement(
    "5, case 3; Fig. 9",
    "In the window the contact advances by about 90 deg, to the positive flanks of bolt and nut.",
    "Largest jump of the contact's azimuth in one step, and the regions after it. Agrees if 75 to 105 deg, on these "
    "flanks, for every pitch.",
)
MINIMAL_DROP = Statement(
    "5, case 3; Fig. 9",
    "The bolt drops a minimal distance.",
    "Steepest fall beside that of case 1 at the same tilt. Agrees if smaller for every pitch.",
)
QUICK_RETURN = Statement(
    "5, case 3; Fig. 9",
    "The contact goes below the surface and is back within several degrees.",
    "Phases with the contact below the surface. Agrees if there are some, and at most 10 deg of them, for every pitch.",
)
MIRROR = Statement(
    "5, case 4; Fig. 10",
    "A negative pitch gives the mirror image of case 3.",
    "Share of phases at which the first contact mirrors (x to -x) that of the opposite pitch at the opposite phase, "
    "to 1 microinch. Agrees from 90 % on for every pitch.",
)
BELOW_4 = Statement(
    "5, case 4",
    "In the window the contact below the surface is between the bolt's crest and the nut's positive crest fillet.",
    "The pair of regions most often in contact below the surface. Agrees if it is this for every pitch.",
)
