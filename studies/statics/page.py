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
    return (
        "\n".join([*_verdicts(counts, apart, states), *_classes(states), *_reactions(reactions), *_snaps(snaps)]) + "\n"
    )


def _row(*cells: object) -> str:
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def _verdicts(
    counts: Sequence[VerdictCounts], apart: Sequence[VerdictCounts], states: Sequence[PushedState]
) -> list[str]:
    supported = sum(one.margin >= 0.0 for one in states)
    steep = sum(counts[-1].mu < one.hold < math.inf for one in states)
    never = sum(one.hold == math.inf for one in states)
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
        f"{supported:,} states are supported without friction. From {counts[-2].mu:g} to {counts[-1].mu:g}",
        f"friction gains {counts[-1].can_stay - counts[-2].can_stay:,} states; {steep:,} more hold from some",
        f"friction above that, and {never:,} at none.",
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
        "It carries a push only within its hull: the margin that comes nearest to carrying it, or carries it most, is",
        f"{nearest:.4f}. Outside, the push tips the bolt into the hole, and since all normals of a patch are parallel",
        "no friction helps. What a strip of flank carries counts as flush, too.",
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
    tipping = sum(one.statics.hold.value is None for one in snaps)
    flush = sum(one.state_class == "flush" for one in snaps)
    lines = [
        "## Just before the snap: which orientations hold the bolt?",
        "",
        f"A designer asks: at mu {MU:g} and under a push of 10 N, which of the 81 orientations hold the bolt just",
        f"before the snap, and what frees them? {len(snaps)} of the 81 snap when the bolt is turned counter-clockwise.",
        f"{flush} of them lie flush there, {tipping} tip whatever the friction, and {len(held)} can hold the push. A",
        "force sideways frees these, of the size and in the direction that the table says; so does a friction below",
        "the least one, and so does turning on: the torque for it is in the last column, over push times nominal",
        "radius.",
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
