"""Statements on the parts, their meshes and the paper's figures as numbers: sections 3, 4, 4.1, 6.1, 7.1."""

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
