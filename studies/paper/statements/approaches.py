"""Statements on the eight approaches and the three named poses: sections 7, 7.1, 7.1.1 to 7.1.3, figures 19 to 21."""

from studies.paper.claim import Statement

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
