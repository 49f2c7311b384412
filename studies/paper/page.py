"""The claims as a page and as a table for people on a terminal."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from studies.paper.claim import Claim, Verdict
from studies.paper.registry import Chapter
from studies.paper.study import Study, poses_to_solve

OPENING = """\
# The paper's claims, measured

Every statement of S. Wiedmann and B. Sturges, *Spatial Kinematic Analysis of Threaded Fastener Assembly*, J. Mech.
Des. 128 (2006), that can be put to the test, with what the exact solver measures and the verdict that follows. `make
paper` computes this page; no verdict is typed in."""

CONVENTIONS = """\
## How the paper is read

- **Geometry.** The paper gives neither fit nor fillet radii, and its figures are not available. The pair is the default
  one: 1/4-20 UNC, 2A at maximum on 2B at minimum material, root fillets of the bolt and crest fillets of the nut
  0.108 p, the others 0.054 p. Statements of section 5, which hang on edges and fillets, are also tested on four other
  geometries: the fit in the middle and at the loose end of its tolerances, all fillets half as large, the root of the
  bolt rounded throughout. Lengths are in inches, angles in degrees.
- **Datum of phase.** Declared: in phase at phase 0, the crest of the bolt's base outline at azimuth 270. It makes a
  positive roll lead with the crest, as case 1 says. The paper's is unstated; where it decides, every datum is tried.
- **Order of the rotations.** Declared: `Rz(phase) Ry(pitch) Rx(roll)`, the tilt goes round with the phase. By the
  letter of Eqs. 2 and 3 (`P_F = T^-1 P_b`) the bolt is first turned about its own axis, then tilted about axes that
  stay: `Rx(roll) Ry(pitch) Rz(phase)`. Statements on turning are tested in both.
- **Sign of phase.** Growing phase turns counter-clockwise. By the letter of Eq. 2 with rotations of the body it turns
  clockwise; since the paper turns its bolt counter-clockwise, this matters only where it gives a phase as a number.
- **Regions.** As in section 3: positive where the radius grows with +z. The nut's crest is its smallest radius. A
  contact on an edge carries the region of the thread at that azimuth; "at the surface" means at the height z = 0 of
  the nut's flat face, "below" deeper than 1e-9 in.
- **Descent, steepest fall, snap.** Of the height of first contact, turning counter-clockwise. A descent is a longest
  stretch of phase over which it does not rise. The steepest fall is the largest within 3 deg of phase, or within
  another span where one is named; the main descent is the one that holds it. It is a snap where the steepest fall
  exceeds 5 % of the thread pitch, and its figure is the whole fall of the descent ([decision
  17](decisions/0017-falls.md)). All are those of the exact curve of height, the same as in [windows.md](windows.md);
  with the bolt turned before it is tilted, the curve is straight from step to step.
- **Before and after the fall.** Before and after the step of 1 deg over which the height falls most: it marks where
  the clearance window is entered.
- **Second turn.** About the tangent of the edge in contact. The paper says "a vector tangent to the surface of the
  nut".
- **Third contact.** A component of contact that holds neither of the first two. The paper's "three distinct contact
  states" of a mesh are not defined further.
- **Classes.** Unstable: no third contact, or a drop of at most the embedment (7.1). Quasi-stable: else, and the pivot
  axis passes the origin within 0.1 of the nominal radius; the paper says "at or near". Stable: else. A bolt that
  comes to lie flush has a patch of contact, which the paper does not foresee; it counts as stable, and statements on
  how frequent the classes are are also tested with it unstable.

**Verdicts.** A statement *agrees* if it holds on the declared geometry in the declared reading; where another one
contradicts, the last column says which. It *disagrees* if it holds in none of the readings and geometries that were
tried. Else it *cannot be decided*, and the last column says what would have to be known. Rules and tolerances stand
beside each statement."""

UNTESTED = """\
## What is not in the tables

- Whether the triangles of the bolt are smaller than those of the nut, how many pairs of triangles a contact has (four
  each in Fig. 21) and what their number does to the accuracy (4.1, 4.2): properties of meshes that are not given.
- The depth in Fig. 8 below what is possible, and its variability that grows with roll: read off single triangles.
- That a clockwise rotation after the snap assembles the parts (7): a motion that keeps contact, which no state
  describes.
- The annuli of Fig. 22 for roll -3, pitch 3: the figure alone holds them.
- The types of intersection of two triangles and the angles of Tables 1 to 3 (4.2): steps of a computation on meshes,
  which the exact method does not take.
- Definitions: Eq. 1, the nine regions, the frames and transforms of Eqs. 2 to 17."""


WIDTH_OF_A_FILE = 170
COLOURS = {Verdict.AGREES: "green", Verdict.DISAGREES: "red", Verdict.UNDECIDED: "yellow"}


def print_table(claims: Sequence[Claim]) -> None:
    """One row a claim, then how many of each verdict."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDTH_OF_A_FILE)
    table = Table(show_lines=True)
    for name, ratio in (("where", 2), ("the paper says", 5), ("measured", 6), ("verdict", 2), ("because", 6)):
        table.add_column(name, ratio=ratio)
    for one in claims:
        colour = COLOURS[one.verdict]
        table.add_row(one.reference, one.statement, one.measurement, f"[{colour}]{one.verdict}[/]", one.reason)
    console.print(table)
    console.print(counted(claims))


def counted(claims: Sequence[Claim]) -> str:
    """How many claims have each verdict, as a sentence."""
    counts = Counter(one.verdict for one in claims)
    return (
        f"Of {len(claims)} statements {counts[Verdict.AGREES]} agree, {counts[Verdict.DISAGREES]} disagree, and "
        f"{counts[Verdict.UNDECIDED]} cannot be decided."
    )


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
