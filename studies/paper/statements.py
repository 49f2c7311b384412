"""Every statement of the paper that is tested: its section, the statement in short, what is measured and the rule."""

from __future__ import annotations

from studies.paper.claim import Statement

FAR_ENDS = Statement(
    "3",
    "The top of the bolt and the bottom of the nut will not come into contact.",
    "Poses of all orientations, at the first, second and third contact, with a point of the bolt's top outline or "
    "the nut's bottom outline (every 5 deg) more than 1 microinch inside the other solid. Third poses that embed "
    "more than they drop are no possible movement (7.1) and are counted apart. Agrees if there are none.",
)
SURFACE_AND_BASE = Statement(
    "3",
    "The nut's surface and the bolt's base have the potential to come into contact.",
    "Contacts on the nut's flat surface and on the bolt's flat base, at a point or with the bolt lying flush. "
    "Agrees if both occur.",
)
TESSELLATION = Statement(
    "4",
    'With a chord height of 1e-4 and an angle control of 0.5 the mesh deviated "by a few millionths of an inch".',
    "Sagitta of a chord on the nut's major circle, once with 0.5 deg a chord, once with the longest chord of 1e-4 in "
    "height. Agrees if both are at most 10 microinches, disagrees if neither is.",
)
DESCENT_STEP = Statement(
    "4.1, 6.1, 8",
    "The descent ends with steps of 1 microinch (4.1, 8); the final move is 10 microinches (6.1).",
    "Agrees if the three sections name one step.",
)
AVERAGED_MIDPOINTS = Statement(
    "4.1",
    "Steps of 1 instead of 100 microinches reduce the largest variation of the averaged contact point by 0.0025 in on "
    "average.",
    "The bolt is lowered below the exact first contact by 1/4, 2/4, 3/4 and 4/4 of a step; the averaged point is "
    "the mean of both edge curves inside the other solid, its variation the largest distance from the exact "
    "contact. Mean over the eight approaches. Agrees if less by 0.0025 in within a factor of 2; disagrees if not "
    "even the farthest point inside moves so far.",
)
CONVERSIONS = Statement(
    "7.1.1, 7.1.2, 8",
    "Seven lengths are given in inches and in millimetres.",
    "Agrees if every conversion is right to its last digit.",
)
FLANK_ANGLE = Statement(
    "4",
    "The thread's flanks include 60 deg.",
    "Twice the angle between flank and a plane across the axis, from the slope of the declared profile. Agrees "
    "within 1e-9 deg.",
)


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


OUT_OF_PLANE = Statement(
    "1",
    "A stable bolt, with three contacts, has an out-of-plane contact.",
    "Three contacts in a state: is one of them below the nut's surface; are they not all in one plane with the "
    "nut's axis? Agrees if both are so in every state, disagrees if neither is.",
)
CORRECTS = Statement(
    "1",
    "A negative turn about the tangent ensures that the bolt turns so as to correct its orientation.",
    "Angle between the axes of bolt and nut before and after the second turn, all orientations. Agrees if it grows "
    "in no pose.",
)
LOWERS = Statement(
    "6.2",
    "A negative turn about the counter-clockwise tangent turns the bolt towards the nut's surface.",
    "Height of the bolt's origin before and after the second turn, where it is longer than 1e-9 deg. Agrees if it "
    "falls in every pose.",
)
TWO_FREEDOMS = Statement(
    "6.2",
    "With both contacts maintained the bolt has at most two degrees of freedom.",
    "Six less the rank of the contacts' constraints at the second contact: points that slide; points that do not; "
    "points that slide with x and y of the origin held. Agrees if at most two in all three, disagrees if in none.",
)
SENSE_VARIES = Statement(
    "1, 6.3",
    "The direction of the third turn depends on where the two contacts are.",
    "Senses, about the axis from the first to the second contact, of the turns that lower the origin. Agrees if "
    "each occurs in at least 1 % of the states.",
)
SENSE_BY_QUADRANTS = Statement(
    "6.3",
    "The quadrants of both contacts, the half of the X axis that the pivot axis crosses and the sign of its slope "
    "determine that direction.",
    "Combinations of the four, and of these the ones in which both senses lower the origin in some state. Agrees if "
    "there are none.",
)
IMPOSSIBLE = Statement(
    "6.3",
    "For each quadrant of the first contact one configuration of crossing and slope is impossible.",
    "Configurations that occur, of the four of each quadrant. Agrees if three of each do.",
)
AT_OR_NEAR_SURFACE = Statement(
    "6.3",
    "A majority of the contact points occur at or near the surface.",
    "Share of first, second and third contacts not deeper than p / 10. Agrees if each is above one half.",
)


EIGHT = Statement(
    "7",
    "Roll and pitch of -4, 0 and 4 deg give eight approaches.",
    "Orientations of that grid that are tilted. Agrees if eight.",
)
SNAP = Statement(
    "7",
    "Turned counter-clockwise the bolt snaps: its height changes suddenly when it is in phase with the nut.",
    "Every tilted orientation of 7.2: does it snap, its steepest fall within 15 deg of phase 0; the whole fall of the "
    "snap. Agrees if every one does.",
)
ENTIRE_GAMUT = Statement(
    "7",
    "Phase steps of 5 deg in the eight approaches give the entire gamut of contact states.",
    "Kinds of state (stages, features and regions of all contacts) of the eight approaches at every degree of phase "
    "that steps of 5 deg do not show. Agrees if none.",
)
MOSTLY_EMBEDDED = Statement(
    "7.1.1",
    "In a majority of the runs the third contact was reached only by embedding: unstable.",
    "Share of unstable states over the eight approaches in steps of 5 deg, a bolt that comes to lie flush once "
    "stable, once unstable. Agrees if above one half.",
)
EACH_APPROACH = Statement(
    "7.1.3",
    "Stable three-point contact occurs in each of the approaches ...",
    "Stable states in every approach in steps of 5 deg, a bolt that comes to lie flush once stable, once unstable. "
    "Agrees if there are some in each.",
)
LEAST_OFTEN = Statement(
    "7.1.3",
    "... but it is the least frequent class.",
    "Counts of the three classes over the eight approaches in steps of 5 deg, a bolt that comes to lie flush once "
    "stable, once unstable. Agrees if the stable ones are fewest.",
)
QUASI_PRESENT = Statement(
    "7.1.2",
    "A quasi-stable case is present when roll and pitch are both positive.",
    "Quasi-stable states of roll 4, pitch 4 in steps of 5 deg. Agrees if there are some.",
)
CLASS_19 = Statement(
    "7.1.1; Fig. 19",
    "Roll 4, pitch 0, phase 185 is unstable.",
    "The class. Agrees if so as declared, disagrees if so with no datum of the phase in no reading; a bolt that "
    "comes to lie flush is stable.",
)
HEIGHT_19 = Statement(
    "7.1.1; Fig. 19",
    "There the origin moves from 0.047 to 0.046 in.",
    "Height of the origin at the second and at the third contact, with the origin in the bolt's base or in its top, "
    "to half the last digit. Rule as for its class.",
)
EMBEDMENT_19 = Statement(
    "7.1.1; Fig. 19",
    "It moves by 0.001 in and embeds by 0.004 in.",
    "Drop and embedment, to half the last digit. Rule as for its class.",
)
CLASS_20 = Statement(
    "7.1.2; Fig. 20",
    "Roll 4, pitch 4, phase 235 is quasi-stable.",
    "The class. Rule as for Fig. 19.",
)
DROP_20 = Statement(
    "7.1.2; Fig. 20",
    "There the origin drops by 0.0045 in and the interference is 0.0013 in.",
    "Drop and embedment, to half the last digit. Rule as for Fig. 19.",
)
AXIS_20 = Statement(
    "7.1.2; Fig. 20",
    "Its pivot axis passes near the bolt's origin.",
    "The pivot offset: near is 0.1 of the nominal radius. Rule as for Fig. 19.",
)
CLASS_21 = Statement(
    "7.1.3; Fig. 21",
    "Roll -4, pitch 0, phase 131 is stable with three contacts.",
    "The class. Rule as for Fig. 19.",
)
NO_EMBEDMENT_21 = Statement(
    "7.1.3; Fig. 21",
    "There the bolt does not embed itself.",
    "The embedment: none up to 1e-9 in. Rule as for Fig. 19.",
)
AT_SURFACE_21 = Statement(
    "7.1.3; Fig. 21",
    "All three contacts are at the nut's surface, and the origin drops slightly.",
    "Heights of the contacts, and a positive drop below p / 10. Rule as for Fig. 19.",
)
ONE_DATUM = Statement(
    "Figs. 19 to 21",
    "The three poses are unstable, quasi-stable and stable, in this order.",
    "The three classes, with one datum of the phase and one reading for all. Rule as for Fig. 19.",
)


EIGHTY_ONE = Statement(
    "7.2, 8; Fig. 22",
    "Roll and pitch in steps of 1 deg from -4 to 4 give 81 cases, each with its own set of contact points.",
    "Different sets of points of all contacts over a revolution, to 1 microinch. Agrees if there are 81.",
)
NOT_PARALLEL = Statement(
    "7.2",
    "When the third contact is obtained the bolt is not parallel to the nut's surface.",
    "States that end parallel to it (below 1e-6 deg), over all orientations but the level one. Agrees if there are "
    "none.",
)
EXHAUSTIVE = Statement(
    "7.2, 8",
    "The grid convinces by exhaustive examination that there are no other contact states.",
    "Kinds of state (stages, features and regions of all contacts) of 20,000 random poses within 4 deg that all "
    "orientations at every degree of phase do not show. Agrees if none.",
)
THREE_TYPES = Statement(
    "8",
    "There are three types of states: unstable, quasi-stable, stable.",
    "Counts of the classes over all orientations, and of states that the types do not describe: lying flush, no "
    "third contact. Agrees if all three classes occur.",
)
