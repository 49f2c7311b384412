"""``docs/stability.md``: what was found, in words and tables, and the fixed prose."""

from __future__ import annotations

from studies.stability import page_exact, page_methods
from studies.stability.agreement import Outcome
from studies.stability.findings import Findings
from studies.stability.maps import DECADE_MAP, MAPS

CRITERIA = """\
An answer fails silently where something that knows nothing of the solver says that it is wrong:

- **Laws.** Numbers are finite; the first pose is the requested one; both points of a contact are one, to 1e-9 in on
  the surfaces that its features name and in both closed solids; normals and regions are right; a turn keeps its
  contacts and has the reported angle; drop, pivot offset and class follow from the rest. Checked for every answer.
- **Continuity.** Every perturbed answer is joined to its centre's by steps in which nothing happens. Where there is no
  such path the interval between the two is halved until doubles end or the method refuses, and the two neighbours are
  checked by the brute force of `oracle`: a height may fall only where columns, dense about the lost contact, find no
  higher one (where two edges cross their overlap is taken to fifty digits: doubles cannot tell one of 1e-17 in from
  none), a turn may pass a neighbour's contact only where rays find no component that appears on the way, an
  embedment may jump only as the lift does.
- **Margins.** A class that flips while the contacts stay must have a margin that changes its sign and is no larger
  than the perturbation can change it.
- **Brute force alone.** Heights and embedments of all centres, turns of one in twenty-four, and a sample of the
  perturbed poses; so are answers whose path from the centre crosses more events than are followed.
- **The same input.** Another size of all lengths, whole turns of phase and other tolerances must change nothing but
  what they are about."""

RIVALS = """\
Wrong / refused / total. The exact method's answers are checked as the section on it says. A mesh's answer is right
where it agrees with the exact answer to its case, to one of fourteen poses so near that no point of the bolt moves
much farther than the error that the mesh method declares itself (how far the edges of both meshes deviate, and the
final step), or to a bolt whose surface is off by that error. So a mesh that resolves 5e-4 in may take either side of
an event that is nearer than that. Answers agree where heights are within the declared error, where each stage ends
alike (in a patch, in nothing, in a contact) with turn and place within a tenth of a thread pitch at most, less where
the tilt bounds what the error can do, and where the class is the same. Safe meshes are checked by a second
tessellation, which refuses what the two do not agree on; decades are as printed, unchecked."""

WRONG = """\
A wrong answer is counted at its first wrong stage: later ones follow from it. A class that flips between right answers
flips within margins where one of them is no larger than the declared error can make it."""

CHANGES = """\
The exact method's numbers are of all hard places together, as those of the meshes, which follow a perturbation only in
steps of their final step and facets: below that size their change per change of the input has no bound."""

DESCENTS = """\
Every pose of the grid, the height of first contact by both descents of the mesh method. A height is wrong where it
differs from the exact one by more than the declared error. A wrong height is beside a jump where it lies between the
exact heights of poses and of bolts' surfaces that are off by no more than that error: there heights are steep, and
the meshes lose their highest contact up to a degree of phase earlier or later than the threads do, as any model does
that is off by as much; no step of a descent can avoid it. The others are tunnelled where they are too low: the contact
is there, and a step has skipped it. Wrong heights are computed again with finer meshes."""

EVENTS = """\
Each pair of neighbours was examined once for its centre. Where two contacts are at one height, or at one turn, one
replaces the other with no change of that number; a jump and a contact onset change it at once."""

STEEPNESS = """\
The largest change of an answer per change of its input, where the contacts stay: a height, a turn times the bolt's
reach (0.134 in) or a contact point, over the largest displacement of a point of the bolt or profile. These are ratios
of lengths, so that no unit matters; they are taken from changes of 1e-7 and more. Contact points and turns follow the
direction of the tilt, so that they are as steep as the tilt is small."""

LEFT_OUT = """\
- Feature changes (an edge that comes to meet an edge instead of a thread) are approached to 1e-7 deg. Nearer, the exact
  method's search takes longer: roll 1.5075738445675206, pitch -0.8886286081671697, phase 2.661266877535354 some 0.3 s,
  two thousand times as long as most.
- The brute force resolves components deeper than 1e-7 in and turns to 1e-4 deg; it covers tilts of up to 25 deg.
- Perturbations are of roll, pitch, phase, the six diameters and the thread pitch; the form's angle and fillets stay.
- A tangent along +z or -z does not occur: both parts' edges are cut across their axes. Those directions are in
  the table of the angles alone.
- A height that is too great is left to the laws: the reported contact lies in both solids there.
- The meshes are given few centres of each place, and the coarse preset most of them: a pose takes them 0.1 to 15 s.
  Turns end at 10 deg for them, and for the exact answers that theirs are compared with.
- Changes of a turn or point below 1e-8 in, and jumps below 1e-6 in, count as none."""


FOLDER = "stability"


def page(found: Findings) -> str:
    """The page as Markdown."""
    parts = [
        "# Where methods fail",
        _opening(found),
        "## Every method, place by place",
        RIVALS,
        page_methods.places_table(found),
        WRONG,
        page_methods.wrong_table(found),
        "Reasons of the meshes' refusals:",
        page_methods.reasons_text(found),
        "### Ways to fail, one pose each",
        page_methods.demonstrations_table(found),
        "### What the collision library's unfiltered pairs give",
        page_methods.pitfalls_text(found),
        "### How much answers change",
        CHANGES,
        *page_methods.change_tables(found),
        "## Descents over the whole grid",
        DESCENTS,
        page_methods.descents_text(found),
        page_methods.refusals_text(found),
        _picture(DECADE_MAP.title, DECADE_MAP.name),
        "## The exact method in the hard places",
        CRITERIA,
        page_exact.places_table(found),
        page_exact.answers_text(found),
        page_exact.answers_table(found),
        "### Events between neighbouring answers",
        EVENTS,
        page_exact.events_table(found),
        "### Silent failures",
        page_exact.failures(found),
        "### How steep the answers are",
        STEEPNESS,
        page_exact.steep_table(found),
        *page_exact.decade_tables(found),
        "## The angles of Eqs. 7, 9 and 11",
        page_exact.angles_text(found),
        page_exact.axes_table(found),
        "## The grid",
        page_methods.grid_text(found),
        *(_picture(chart.title, chart.name) for chart in MAPS),
        "## What this leaves out",
        LEFT_OUT,
    ]
    return "\n\n".join(parts) + "\n"


def _picture(title: str, name: str) -> str:
    return f"![{title}]({FOLDER}/{name}.svg)"


def _opening(found: Findings) -> str:
    total = found.total
    neighbours = sum(row.neighbours for row in found.rows)
    broken = sum(len(row.broken) for row in found.rows)
    poses = sum(len(row.poses) for row in found.rows)
    flips = total.flips_by_margin + total.flips_at_events
    lines = [
        f"`make stability` writes this page. The exact method was given {total.trials:,} perturbed poses about "
        f"{total.centres:,} centres in {len(found.places)} hard places of 1/4-20 UNC, and {neighbours:,} neighbours "
        f"of the grid's {poses:,} poses; the collision of meshes, a thousand times slower, a share of them.",
        "",
        f"- **The exact method** fails silently in {len(total.failures):,} perturbed poses of the hard places and "
        f"{broken:,} of the grid; each is listed below or in [failures.csv]({FOLDER}/failures.csv) with what "
        f"reproduces it. It refuses {total.refused:,} of the perturbed poses.",
        f"- **Its classes** flip {flips:,} times: {total.flips_by_margin:,} with the contacts unchanged, each where a "
        f"margin of the class was small enough to say so; {total.flips_at_events:,} because other contacts took over, "
        f"which the margins of a class do not announce.",
    ]
    for name, tallies in found.rivals.items():
        tally = page_methods.all_places(tallies)
        wrong = sum(tally.outcomes[one] for one in Outcome if one.is_wrong)
        lines.append(
            f"- **{name[0].upper()}{name[1:]}**: of {tally.case_count:,} poses in the hard places {wrong:,} silently "
            f"wrong, {tally.outcomes[Outcome.REFUSED]:,} refused."
        )
    for number, method in enumerate(found.extent.descents):
        outcomes = [one for row in found.descents for one in row.outcomes(number)]
        beside = sum(one.beside_event for one in found.rechecks if one.wrong.method == method)
        tunnelled = outcomes.count(Outcome.HEIGHT) - beside
        lines.append(
            f"- **First heights of {method.name}** over the grid: {outcomes.count(Outcome.HEIGHT):,} of "
            f"{len(outcomes):,} wrong, {tunnelled:,} of them tunnelled and {beside:,} beside a jump that the meshes "
            f"have elsewhere; {outcomes.count(Outcome.REFUSED):,} refused ([descents.csv]({FOLDER}/descents.csv))."
        )
    return "\n".join(lines)
