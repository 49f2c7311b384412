"""Statements on the second and the third turn: sections 1, 6.2, 6.3."""

from studies.paper.claim import Statement

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
