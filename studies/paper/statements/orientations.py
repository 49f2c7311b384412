"""Statements on the 81 orientations and on the three kinds of state: sections 7, 7.2, 8, figure 22."""

from studies.paper.claim import Statement

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
