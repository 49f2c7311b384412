"""The page of what a push does: its tables and its words."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from studies.statics.study import KINDS, BeforeSnap, PushedState, VerdictCounts

MU = 0.15


def page(
    counts: Sequence[VerdictCounts],
    apart: Sequence[VerdictCounts],
    states: Sequence[PushedState],
    reactions: dict[str, list[float]],
    snaps: Sequence[BeforeSnap],
) -> str:
    """The page in Markdown."""
    return "\n".join([*_verdicts(counts, apart), *_classes(states), *_reactions(reactions), *_snaps(snaps)]) + "\n"


def _row(*cells: object) -> str:
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def _verdicts(counts: Sequence[VerdictCounts], apart: Sequence[VerdictCounts]) -> list[str]:
    lines = [
        "# What a push does to the contact states",
        "",
        "`make statics` writes this page for the default library: 1/4-20 UNC, 81 orientations, 360 phases. The load is",
        "a push along -z through the bolt's origin; its size does not matter. All numbers are defined in",
        "[forces, section 3](forces.md#3-numbers-of-a-state).",
        "",
        "## How many states stay",
        "",
        "Of all states, and of those whose solids do not overlap in the last pose (no forces can be real in the",
        "others):",
        "",
        _row("mu", "moves", "can stay", "can wedge", "undecided", "moves, no overlap", "can stay, no overlap"),
        _row(*["---"] * 7),
    ]
    for one, other in zip(counts, apart, strict=True):
        cells = (f"{one.mu:g}", one.moves, one.can_stay, one.can_wedge, one.undecided, other.moves, other.can_stay)
        lines.append(_row(*(f"{cell:,}" if isinstance(cell, int) else cell for cell in cells)))
    return [
        *lines,
        "",
        "No state is supported without friction, and none wedges at these frictions. More friction than 0.2 hardly",
        "holds more states: what 0.2 does not hold tips, whatever the friction.",
        "",
        "![Least friction that holds](statics/hold.svg)",
        "",
        "![Least friction that wedges](statics/wedge.svg)",
        "",
    ]


def _classes(states: Sequence[PushedState]) -> list[str]:
    lines = [
        "## What the classes are worth under a push",
        "",
        _row(
            "class",
            "states",
            "overlap",
            "supported",
            "no friction holds",
            f"hold at {MU:g}",
            "least friction to hold, median",
            "wedge from",
        ),
        _row(*["---"] * 8),
    ]
    for kind in KINDS:
        of_kind = [one for one in states if one.kind == kind]
        holds = [one.hold for one in of_kind if one.hold < math.inf]
        lines.append(
            _row(
                kind.replace("_", " "),
                f"{len(of_kind):,}",
                f"{sum(one.penetrating for one in of_kind):,}",
                f"{sum(one.margin >= 0.0 for one in of_kind):,}",
                f"{sum(one.hold == math.inf for one in of_kind):,}",
                f"{sum(one.hold <= MU for one in of_kind):,}",
                f"{np.median(holds):.3f}" if holds else "",
                f"{min((one.wedge for one in of_kind), default=math.inf):.3f}",
            )
        )
    flush = [one for one in states if one.kind == "flush"]
    nearest = max(one.margin for one in flush)
    return [
        *lines,
        "",
        "The paper's classes are geometry: where the bolt's origin lies beside the pivot axis, and how far it sinks.",
        "Under a push they say something else. The patch of a flush bolt is a crescent on one side of the nut's hole.",
        "It carries a push only within its hull, and in no state of the library does the hull reach the bolt's axis:",
        f"the nearest misses it by a support margin of {nearest:.4f}. The push tips the bolt into the hole, and since",
        "all normals of a patch are parallel no friction helps (the five flush states that some friction holds lie on",
        f"a strip of flank). What the paper calls quasi-stable holds at {MU:g} in every case. A stable state with",
        "three contacts does in half of the cases: its median lies there. An unstable state holds at all only with a",
        "third contact.",
        "",
    ]


def _reactions(reactions: dict[str, list[float]]) -> list[str]:
    lines = [
        f"## What a hand must supply at mu {MU:g}",
        "",
        "Of every tenth state that the contacts do not hold: the size of the least wrench (moments over the nominal",
        "radius) that must be added, over the push.",
        "",
        _row("class", "states", "least", "median", "nine of ten below", "most"),
        _row(*["---"] * 6),
    ]
    for kind, sizes in reactions.items():
        if sizes:
            shown = (min(sizes), float(np.median(sizes)), float(np.quantile(sizes, 0.9)), max(sizes))
            lines.append(_row(kind.replace("_", " "), f"{len(sizes):,}", *(f"{value:.3f}" for value in shown)))
    return [*lines, ""]


def _snaps(snaps: Sequence[BeforeSnap]) -> list[str]:
    held = [one for one in snaps if one.statics.hold.upper <= MU]
    flush = sum(one.state_class == "flush" for one in snaps)
    lines = [
        "## Just before the snap: which orientations hold the bolt?",
        "",
        f"A designer asks: at mu {MU:g} and under a push of 10 N, which of the 81 orientations hold the bolt just",
        f"before the snap, and what frees them? {len(snaps)} of the 81 snap when the bolt is turned counter-clockwise.",
        f"{flush} of them lie flush there, and tip whatever the friction. {len(held)} can hold the push, each barely:",
        f"their least friction is just below {MU:g}, and a force sideways of some thousandths of the push, in the",
        "right direction, frees them. So does a lubricant, and so does turning on: the torque for it is in the last",
        "column, over push times nominal radius.",
        "",
        _row(
            "roll",
            "pitch",
            "phase",
            "class",
            "holds from mu",
            f"at {MU:g}",
            "overlap",
            "freed by, of the push",
            "towards (deg)",
            "turns at",
        ),
        _row(*["---"] * 10),
    ]
    for one in snaps:
        statics = one.statics
        lines.append(
            _row(
                f"{one.roll_deg:g}",
                f"{one.pitch_deg:g}",
                f"{one.phase_deg:.3f}",
                one.state_class.replace("_", " "),
                "none" if statics.hold.value is None else f"{statics.hold.value:.4f}",
                statics.verdict.value.replace("_", " "),
                "yes" if statics.penetrating else "",
                "" if one.freed_by is None else f"{one.freed_by:.4f}",
                "" if one.freed_towards_deg is None else f"{one.freed_towards_deg:g}",
                "" if statics.turn_effort_ccw is None else f"{statics.turn_effort_ccw:.3f}",
            )
        )
    return lines
