"""The success map of a report: pictures, tables, the worst approaches, every orientation."""

from __future__ import annotations

import math
from collections.abc import Iterator

from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.report.contents import FrictionPart, Report
from threadstate.report.html import figure, figures, paragraph, table
from threadstate.report.map_svg import Square, TiltMap, map_svg, shade_of
from threadstate.report.words import (
    NEWTON,
    NOTHING,
    counted,
    critical_words,
    exact,
    friction_words,
    name_of,
    pose_words,
    rounded,
)
from threadstate.success.model import OrientationMap
from threadstate.success.summary import OrientationSummary

MOST_ROWS = 12
"""Orientations of a list of the worst ones."""
SHARES = ("none", "\N{LESS-THAN OR EQUAL TO} 1/4", "\N{LESS-THAN OR EQUAL TO} 1/2", "< all", "all")


def map_section(report: Report) -> Iterator[str]:
    """A map of the share of phases for each friction, that of the critical friction, and what they sum up to."""
    grid = report.inputs.grid
    yield paragraph(
        f"{counted(len(report.orientations), 'orientation')}, {counted(grid.phase_count, 'starting phase')} each, "
        f"{counted(len(report.parts), 'friction')}. An orientation engages where all its phases do."
    )
    yield from _totals(report)
    parts = [
        figure(map_svg(share_map(report, part)), f"Starting phases that engage, {friction_words(part.mu)}.")
        for part in report.parts
    ]
    if report.inputs.frictions[-1] > 0.0:
        caption = (
            f"Critical friction: up to which friction an orientation engages from every phase. {NOTHING}: not even "
            "without friction. Hatched: a lower bound, as an undecided path ends it."
        )
        parts.append(figure(map_svg(critical_map(report)), caption))
    yield figures(parts)


def _totals(report: Report) -> Iterator[str]:
    """What engages and what that asks for, then how all paths end; a row for each friction."""
    unit = report.unit
    yield table(
        "What engages at each friction; torque, tilt and shift are the largest of the paths that engage",
        (
            *("friction", "orientations that engage", "connected with level", "largest connected", "its area (deg²)"),
            *("paths that engage", f"torque ({NEWTON}{unit})", "tilt (deg)", f"shift ({unit})"),
        ),
        [
            (
                exact(part.mu),
                f"{part.area.engaged} of {part.area.orientations}",
                str(part.area.around_level),
                str(part.area.largest),
                rounded(part.area.largest * part.area.cell_deg2),
                f"{part.engaged_paths} of {part.paths}",
                *(rounded(value, 3) for value in (part.torque, part.tilt_deg, part.shift)),
            )
            for part in report.parts
        ],
    )
    counts = [dict(part.counts.outcomes) for part in report.parts]
    outcomes = [outcome for outcome in AssemblyOutcome if any(outcome in found for found in counts)]
    yield table(
        "How the paths end at each friction",
        ("friction", *(name_of(outcome.value) for outcome in outcomes)),
        [
            (exact(part.mu), *(str(found.get(outcome, 0)) for outcome in outcomes))
            for part, found in zip(report.parts, counts, strict=True)
        ],
    )


def share_map(report: Report, part: FrictionPart) -> TiltMap:
    """The map of the share of starting phases that engage."""
    squares = []
    for one, summary in zip(report.orientations, part.orientations, strict=True):
        undecided = f", {summary.undecided} undecided" if summary.undecided else ""
        meaning = f"{pose_words(one)}: {summary.engaged} of {counted(summary.phases, 'phase')} engage{undecided}"
        squares.append(
            Square(
                one.roll_deg,
                one.pitch_deg,
                min(shade_of(summary.share), 4 if summary.all_engage else 3),
                _short(summary),
                meaning,
                summary.undecided > 0,
                _is_chosen(report, one),
            )
        )
    open_count = sum(square.undecided for square in squares)
    alternative = (
        f"Map over roll and pitch {friction_words(part.mu)}: {part.area.engaged} of {part.area.orientations} "
        f"orientations engage from every phase; of {open_count} not all is decided. The table of every orientation "
        "has the numbers."
    )
    phases = report.inputs.grid.phase_count
    what = "Whether the bolt engages" if phases == 1 else f"Phases that engage, of {phases}"
    title = f"{what}, μ = {exact(part.mu)}"
    name = f"share-{report.parts.index(part)}"
    shades = ("no", *SHARES[1:-1], "yes") if phases == 1 else SHARES
    return TiltMap(name, title, alternative, report.inputs.grid.tilts_deg, tuple(squares), shades)


def _short(summary: OrientationSummary) -> str:
    """How many phases engage; of a single one, whether it does."""
    if summary.phases == 1:
        return "?" if summary.undecided else "yes" if summary.engaged else "no"
    return f"{summary.engaged}{'?' if summary.undecided else ''}"


def critical_map(report: Report) -> TiltMap:
    """The map of the critical friction."""
    largest = report.inputs.frictions[-1]
    squares = []
    for one in report.orientations:
        last, first = one.critical.last, one.critical.first
        text = rounded(last, 2) if first is not None else f"\N{GREATER-THAN OR EQUAL TO}{rounded(last, 2)}"
        undecided = one in report.undecided_without_friction or _ends_undecided(one)
        squares.append(
            Square(
                one.roll_deg,
                one.pitch_deg,
                0 if last is None else max(shade_of(last / largest), 1),
                text + ("?" if undecided else ""),
                f"{pose_words(one)}: {critical_words(one.critical)}",
                undecided,
                _is_chosen(report, one),
            )
        )
    never = len(report.orientations) - len(report.without_friction)
    throughout = sum(one.critical.first is None for one in report.orientations)
    alternative = (
        f"Map of the critical friction over roll and pitch: {throughout} orientations engage at every friction of the "
        f"map, {never} do not without friction. The table of every orientation has the numbers."
    )
    shades = ("none", *(f"\N{LESS-THAN OR EQUAL TO} {rounded(largest * i / 4, 2)}" for i in range(1, 5)))
    title = "Critical friction"
    return TiltMap("critical", title, alternative, report.inputs.grid.tilts_deg, tuple(squares), shades)


def worst_section(report: Report) -> Iterator[str]:
    """The orientations of the lowest critical friction, and those that fail without any."""
    worst = report.worst[:MOST_ROWS]
    if worst:
        yield table(
            "The lowest critical frictions of orientations that engage without friction"
            + _of_all(len(worst), len(report.worst)),
            ("roll (deg)", "pitch (deg)", "engages up to", "not at", "from phase (deg)", "outcome there"),
            [(*_pose(one), rounded(one.critical.last), rounded(one.critical.first), *_failure(one)) for one in worst],
            heads=2,
            words={5},
        )
    elif report.inputs.frictions[-1] == 0.0:
        yield paragraph("Which orientations fail as friction grows was not computed: the map has none.")
    elif report.without_friction:
        yield paragraph("Every orientation that engages without friction engages at every friction of the map.")
    failing = report.failing_without_friction
    nearest = failing[:MOST_ROWS]
    if nearest:
        yield table(
            "The orientations that fail even without friction, nearest to level first"
            + _of_all(len(nearest), len(failing)),
            ("roll (deg)", "pitch (deg)", "tilt (deg)", "from phase (deg)", "outcome there"),
            [(*_pose(one), rounded(math.hypot(one.roll_deg, one.pitch_deg), 3), *_failure(one)) for one in nearest],
            heads=2,
            words={4},
        )
    unknown = report.undecided_without_friction
    if unknown:
        poses = "; ".join(map(pose_words, unknown[:MOST_ROWS]))
        count = counted(len(unknown), "orientation")
        shown = "" if len(unknown) <= MOST_ROWS else f", the first {MOST_ROWS} of which are"
        yield paragraph(f"Of {count} nothing is known, as a path without friction is undecided{shown}: {poses}.")


def _of_all(shown: int, count: int) -> str:
    return "" if shown == count else f": {shown} of {count}"


def _pose(one: OrientationMap) -> tuple[str, str]:
    return exact(one.roll_deg), exact(one.pitch_deg)


def _failure(one: OrientationMap) -> tuple[str, str]:
    """The phase and the outcome that end the critical friction."""
    critical = one.critical
    phase = NOTHING if critical.phase_deg is None else rounded(critical.phase_deg, 6)
    return phase, name_of(str(critical.outcome))


def orientations_section(report: Report) -> Iterator[str]:
    """A row for each orientation of the map."""
    headings = ["roll (deg)", "pitch (deg)", "engages up to", "not at", "outcome there"]
    headings += [f"phases that engage, {friction_words(part.mu)}" for part in report.parts]
    rows = []
    for i, one in enumerate(report.orientations):
        critical = one.critical
        outcome = NOTHING if critical.outcome is None else name_of(critical.outcome.value)
        rows.append(
            [
                *(*_pose(one), rounded(critical.last), rounded(critical.first), outcome),
                *(_engaged(part.orientations[i]) for part in report.parts),
            ]
        )
    caption = f"Every orientation of the map; {NOTHING}: not even without friction, or at every friction of the map"
    yield table(caption, headings, rows, heads=2, words={4})


def _engaged(summary: OrientationSummary) -> str:
    undecided = f", {summary.undecided} undecided" if summary.undecided else ""
    return f"{summary.engaged} of {summary.phases}{undecided}"


def _ends_undecided(one: OrientationMap) -> bool:
    return str(one.critical.outcome) == "undecided"


def _is_chosen(report: Report, one: OrientationMap) -> bool:
    return (one.roll_deg, one.pitch_deg) == (report.chosen.roll_deg, report.chosen.pitch_deg)
