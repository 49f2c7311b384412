"""The claims as a page of the documentation."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from studies.paper.claim import Claim, Verdict
from studies.paper.registry import Chapter
from studies.paper.study import Study, poses_to_solve
from studies.paper.table import counted
from studies.paper.text import CONVENTIONS, OPENING, UNTESTED

HEAD = "| where | the paper says | measured how, and rule | measured | verdict |\n|---|---|---|---|---|"

WIDTH = 118

Chapters = Sequence[tuple[Chapter, Sequence[Claim]]]


def page(chapters: Chapters, study: Study) -> str:
    """The whole page as Markdown."""
    claims = [claim for _, found in chapters for claim in found]
    parts = [OPENING, _summary(claims, study), _counts(chapters), CONVENTIONS]
    parts += [_table(chapter, found) for chapter, found in chapters]
    return "\n\n".join([*parts, UNTESTED]) + "\n"


def _summary(claims: Sequence[Claim], study: Study) -> str:
    by_order = [claim.holds_by_order for claim in claims if claim.holds_by_order]
    declared, turned_first = (sum(holds[i] for holds in by_order) for i in (0, 1))
    sentences = (
        f"**{counted(claims)}** {poses_to_solve(study.scale):,} poses were solved. Of {len(by_order)} statements "
        f"tested with both orders of the rotations (below) {declared} hold in the declared one and {turned_first} with "
        "the bolt turned before it is tilted."
    )
    return textwrap.fill(sentences, WIDTH)


def _counts(chapters: Chapters) -> str:
    lines = [f"| | {' | '.join(Verdict)} |", "|---|---|---|---|"]
    for chapter, claims in chapters:
        verdicts = [claim.verdict for claim in claims]
        lines.append(f"| {chapter.title} | {' | '.join(str(verdicts.count(verdict)) for verdict in Verdict)} |")
    return "\n".join(lines)


def _table(chapter: Chapter, claims: Sequence[Claim]) -> str:
    return "\n".join([f"## {chapter.title}", "", HEAD, *map(row, claims)])


def row(claim: Claim) -> str:
    """A claim as a line of a Markdown table."""
    verdict = f"**{claim.verdict}**" + (f": {claim.reason}" if claim.reason else "")
    cells = (claim.reference, claim.statement, claim.test, claim.measurement, verdict)
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"
