"""The page of success maps beside the witness."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from harness.markdown import table
from oracle.outcomes import MOST_LINEAR_STEPS
from studies.success_witness.study import FRICTIONS, Compared
from threadstate.device.strategy import Strategy
from threadstate.numbers import number_text

HEAD = (
    "strategy",
    "mu",
    "cells",
    "decided by both",
    "agree",
    "undecided: solver",
    "witness",
    "with half its step: decided",
    "agree",
)


def page(cells: Sequence[Compared]) -> str:
    """The page as Markdown."""
    seconds = np.array([one.seconds for one in cells])
    steps = sum(one.witness.nearly + one.witness.loose for one in cells)
    rows = [
        _row(strategy, mu, [one for one in cells if one.strategy is strategy and one.mu == mu])
        for strategy in Strategy
        for mu in FRICTIONS
    ]
    return f"""# Success maps beside a witness

`make success-witness` writes this page: random cells of [success maps](success.md), orientations of the grid within
4 deg, starting phases of multiples of 15 deg, of the default pair and device. Each is computed by the solver and by a
[brute force](oracle.md) that is written apart from it (`oracle/follow.py`, `oracle/outcomes.py`): the hand moves by
0.5 deg, and contacts are peaks of sampled boundaries. The solver follows each path with half its step as well, as
maps do beside boundaries: one that ends otherwise then is undecided.

A step of the hand balances if no more than 1e-5 of the push is left of its damping, and no overlap beyond 1e-6 nominal
radii; after 25 linear steps 1e-2 and 1e-4 are enough, and the step is *nearly* balanced. One that would go farther than
0.009 nominal radii, or does not balance, is a fall: small steps at the same command, with a drag that is lowered as the
bolt slows down. With 20 *loose* ones in a row, that balance neither way, the witness says nothing of the end: its
linear steps know no curvature, and go to and fro where edges lie along each other; nor after {MOST_LINEAR_STEPS:,}
linear steps of a path. It confirms outcomes as far as its margins go; it is no bound.

Of the first {len(cells):,} cells {sum(one.is_decided for one in cells):,} have an outcome by both, of which
{sum(one.is_decided and one.agrees for one in cells):,} agree. In the others in which the solver has one the witness is
asked again, with half its step, 0.25 deg: {sum(one.is_decided_halved for one in cells):,} have an outcome by both then,
of which {sum(one.agrees_halved for one in cells):,} agree. A path takes the witness {np.median(seconds):.2g} s of
processor time (median), at most {seconds.max():.2g} s; of all its steps {steps:,} are nearly balanced or loose.

{table(HEAD, rows)}

## Cells that differ

Margins are what a rule allows less what is found, over what it allows; *snap* is the largest descent within 3 deg over
the one that is a snap. *Nearly* and *loose* are numbers of steps of the hand.

{_differing([one for one in cells if not one.agrees])}
"""


def _row(strategy: Strategy, mu: float, cells: Sequence[Compared]) -> list[str]:
    decided = [one for one in cells if one.is_decided]
    return [
        f"`{strategy.value}`",
        number_text(mu),
        str(len(cells)),
        str(len(decided)),
        str(sum(one.agrees for one in decided)),
        str(sum(one.solver == "undecided" for one in cells)),
        str(sum(one.witness.outcome == "undecided" for one in cells)),
        str(sum(one.is_decided_halved for one in cells)),
        str(sum(one.agrees_halved for one in cells)),
    ]


def _differing(cells: Sequence[Compared]) -> str:
    if not cells:
        return "None."
    head = (
        "strategy",
        "roll, pitch, phase",
        "mu",
        "solver",
        "witness",
        "with half its step",
        "lead",
        "play",
        "tilt",
        "snap",
        "nearly",
        "loose",
    )
    return table(head, [_listed(one) for one in cells])


def _listed(one: Compared) -> list[str]:
    end = one.witness
    margins = ["" if np.isnan(value) else f"{value:.2g}" for value in (end.lead, end.play, end.tilt, end.snap)]
    pose = ", ".join(number_text(angle) for angle in one.pose_deg)
    return [
        f"`{one.strategy.value}`",
        pose,
        number_text(one.mu),
        one.solver,
        end.outcome,
        one.halved or "",
        *margins,
        str(end.nearly),
        str(end.loose),
    ]
