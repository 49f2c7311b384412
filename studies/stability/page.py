"""``docs/stability.md``: what was found, in words and tables."""

from __future__ import annotations

from studies.stability import page_angles, page_exact, page_grid, page_methods, words
from studies.stability.agreement import Outcome
from studies.stability.findings import Findings
from studies.stability.maps import DECADE_MAP, MAPS

FOLDER = "stability"


def page(found: Findings) -> str:
    """The page as Markdown."""
    parts = [
        "# Where methods fail",
        _opening(found),
        "## Every method, place by place",
        words.RIVALS,
        page_methods.places_table(found),
        words.WRONG,
        page_methods.wrong_table(found),
        "Reasons given with the meshes' refusals:",
        page_methods.reasons_text(found),
        "### Ways to fail, one pose each",
        page_methods.demonstrations_table(found),
        "### What the collision library's pairs say as they come",
        page_methods.traps_text(found),
        "### How much answers change",
        words.CHANGES,
        *page_methods.change_tables(found),
        "## Descents over the whole grid",
        words.DESCENTS,
        page_grid.descents_text(found),
        page_grid.refusals_text(found),
        _picture(DECADE_MAP.title, DECADE_MAP.name),
        "## The exact method in the hard places",
        words.CRITERIA,
        page_exact.places_table(found),
        page_exact.answers_text(found),
        page_exact.answers_table(found),
        "### What lies between neighbouring answers",
        words.EVENTS,
        page_exact.events_table(found),
        "### Silent failures",
        page_exact.failures(found),
        "### How steep the answers are",
        words.STEEPNESS,
        page_exact.steep_table(found),
        *page_exact.decade_tables(found),
        "## The angles of Eqs. 7, 9 and 11",
        page_angles.angles_text(found),
        page_angles.axes_table(found),
        "## The grid",
        page_grid.grid_text(found),
        *(_picture(chart.title, chart.name) for chart in MAPS),
        "## What this leaves out",
        words.LEFT_OUT,
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
            f"- **{name[0].upper()}{name[1:]}**: of {tally.asked:,} poses in the hard places {wrong:,} wrong without a "
            f"word, {tally.outcomes[Outcome.REFUSED]:,} refused."
        )
    for number, method in enumerate(found.extent.descents):
        outcomes = [one for row in found.descents for one in row.outcomes(number)]
        beside = sum(look.beside_event for look in found.looks if look.wrong.method == method)
        tunnelled = outcomes.count(Outcome.HEIGHT) - beside
        lines.append(
            f"- **First heights of {method.name}** over the grid: {outcomes.count(Outcome.HEIGHT):,} of "
            f"{len(outcomes):,} wrong, {tunnelled:,} of them tunnelled and {beside:,} beside a jump that the meshes "
            f"have elsewhere; {outcomes.count(Outcome.REFUSED):,} refused ([descents.csv]({FOLDER}/descents.csv))."
        )
    return "\n".join(lines)
