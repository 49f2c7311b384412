"""The measured section of docs/success.md, and the maps of critical friction beside it."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from studies.pictures import FAINT, INK, picture
from studies.success.study import StudiedMap
from threadstate.device.assembly_model import AssemblyOutcome
from threadstate.device.model import SettledFlag
from threadstate.numbers import number_text
from threadstate.success.model import CriticalFriction
from threadstate.success.summary import grid_cells, map_counts, orientation_summary, tilt_area

HEADING = "## Measured: the default device\n"
NONE, OPEN = "#f4f1ea", "#bdbdbd"
SHADES = ("#bcd9e6", "#7db4d0", "#3f8fbf", "#0b5f99")
"""By the part of the starting phases that engages: up to a quarter, a half, three quarters, and all."""


def section(maps: Sequence[StudiedMap]) -> str:
    """The section in Markdown, from its heading on."""
    lines = [
        HEADING.rstrip("\n"),
        *_words(maps),
        "",
        *_counts(maps),
        "",
        *_needs(maps),
        "",
        *_reasons(maps),
        *_critical(maps),
        *_boundaries(maps),
    ]
    for one in pictured(maps):
        name = picture_name(one)
        lines += [
            "",
            f"![Share of the starting phases that engage, over roll and pitch, by {name}.](success/{name}.svg)",
        ]
    return "\n".join(lines) + "\n"


def pictured(maps: Sequence[StudiedMap]) -> list[StudiedMap]:
    """The maps that have a picture: the frictionless ones."""
    return [one for one in maps if one.inputs.frictions == (0.0,)]


def picture_name(one: StudiedMap) -> str:
    """The name of a map's picture, without its ending."""
    return one.inputs.strategy.value


def share_picture(one: StudiedMap) -> str:
    """A map over roll and pitch at its first friction, as SVG: shares of phases, marked where one is undecided."""
    grid, mu = one.inputs.grid, one.inputs.frictions[0]
    title = f"{one.inputs.strategy.value}: starting phases that engage, mu = {number_text(mu)}"

    def draw(figure: Figure) -> None:
        axes = figure.add_subplot()
        axes.set_title(title)
        axes.grid(visible=False)
        half = 0.5 * grid.tilt_step_deg
        for orientation in one.orientations:
            summary = orientation_summary(orientation, grid, mu)
            corner = (orientation.pitch_deg - half, orientation.roll_deg - half)
            colour = NONE if summary.engaged == 0 else SHADES[-(-4 * summary.engaged // summary.phases) - 1]
            axes.add_patch(Rectangle(corner, 2.0 * half, 2.0 * half, facecolor=colour, edgecolor="white"))
            text = f"{summary.engaged}" + ("?" if summary.undecided else "")
            place = (orientation.pitch_deg, orientation.roll_deg)
            axes.text(*place, text, ha="center", va="center", color="white" if summary.share > 0.5 else INK)
        reach = grid.tilt_max_deg + half
        axes.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal", xlabel="pitch (deg)", ylabel="roll (deg)")
        phases = grid.phase_count
        figure.text(0.02, 0.005, f"Of {phases} phases; ? where the outcome from one or more is undecided.", color=FAINT)

    return picture((6.4, 6.6), title, draw)


def critical_words(critical: CriticalFriction) -> str:
    """The interval of a critical friction in words."""
    if critical.first is None:
        return f"at least {number_text(critical.last or 0.0)}"
    why = str(critical.outcome).replace("_", " ")
    if critical.last is None:
        return f"none: {why} without friction"
    return f"{number_text(critical.last)} to {number_text(critical.first)} ({why})"


def _words(maps: Sequence[StudiedMap]) -> list[str]:
    """What was computed."""
    lines = ["1/4-20 UNC and the [default device](device.md#the-device); `make success` writes this section.", ""]
    for one in maps:
        grid = one.inputs.grid
        phases = f"{grid.phase_count} starting phases" if grid.phase_count > 1 else "one starting phase"
        frictions = _listed(one.inputs.frictions)
        lines.append(
            f"- {one.name}, mu {frictions}: {len(one.orientations)} orientations, {phases}, "
            f"at most {one.inputs.point_limit:,} points a turn; content hash `{one.content_sha256[:12]}`"
            f"{one.duration and f'; {one.duration}'}."
        )
    return lines


def _counts(maps: Sequence[StudiedMap]) -> list[str]:
    lines = [
        "| strategy | mu | orientations | engage from every phase | around level | largest connected | "
        "from some phase | every phase decided |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for one in maps:
        for mu in one.inputs.frictions:
            area = tilt_area(one.orientations, one.inputs.grid, mu)
            summaries = [orientation_summary(found, one.inputs.grid, mu) for found in one.orientations]
            some = sum(summary.engaged > 0 for summary in summaries)
            decided = sum(summary.undecided == 0 for summary in summaries)
            numbers = (area.orientations, area.engaged, area.around_level, area.largest, some, decided)
            lines.append(f"| {one.name} | {number_text(mu)} | {' | '.join(map(str, numbers))} |")
    return lines


def _needs(maps: Sequence[StudiedMap]) -> list[str]:
    unit = maps[0].inputs.pair.unit.value
    lines = [
        "The paths that engage ask of the device, at most:",
        "",
        f"| strategy | mu | paths | torque (N {unit}) | tilt (deg) | shift ({unit}) |",
        "|---|---|---|---|---|---|",
    ]
    for one in maps:
        for mu in one.inputs.frictions:
            cells = [cell for found in one.orientations for cell in grid_cells(found, one.inputs.grid, mu)]
            engaged = [cell for cell in cells if cell.engages]
            needs = [
                max((value for value in values if value is not None), default=None)
                for values in (
                    [cell.torque for cell in engaged],
                    [cell.tilt_deg for cell in engaged],
                    [cell.shift for cell in engaged],
                )
            ]
            texts = ["-" if need is None else f"{need:.3g}" for need in needs]
            lines.append(f"| {one.name} | {number_text(mu)} | {len(engaged)} of {len(cells)} | {' | '.join(texts)} |")
    return lines


def _reasons(maps: Sequence[StudiedMap]) -> list[str]:
    lines = [
        "How all paths end, and why those without a certain answer have none:",
        "",
        "| strategy | mu | outcomes | of the undecided |",
        "|---|---|---|---|",
    ]
    for one in maps:
        for mu in one.inputs.frictions:
            counts = map_counts(one.orientations, one.inputs.grid, mu)
            outcomes = ", ".join(f"{count} {outcome.value.replace('_', ' ')}" for outcome, count in counts.outcomes)
            reasons = [f"{count} `{flag}`" for flag, count in counts.flags]
            reasons += [f"{counts.bounded} bounded"] if counts.bounded else []
            undecided = dict(counts.outcomes).get(AssemblyOutcome.UNDECIDED, 0)
            words = ", ".join(reasons) if undecided else "-"
            lines.append(f"| {one.name} | {number_text(mu)} | {outcomes} | {words} |")
    return lines


def _critical(maps: Sequence[StudiedMap]) -> list[str]:
    with_friction = [one for one in maps if len(one.inputs.frictions) > 1]
    if not with_friction:
        return []
    rows = zip(*(one.orientations for one in with_friction), strict=True)
    return [
        "",
        "Critical friction, from the frictions of the maps:",
        "",
        f"| roll | pitch | {' | '.join(one.name for one in with_friction)} |",
        f"|{'---|' * (2 + len(with_friction))}",
        *(
            f"| {number_text(row[0].roll_deg)} | {number_text(row[0].pitch_deg)} | "
            f"{' | '.join(critical_words(found.critical) for found in row)} |"
            for row in rows
        ),
    ]


def _boundaries(maps: Sequence[StudiedMap]) -> list[str]:
    lines = [
        "",
        "Boundaries of outcome whose both sides end so with half the step, and paths beside boundaries that do not:",
        "",
        "| strategy | mu | boundaries | paths that end otherwise |",
        "|---|---|---|---|",
    ]
    for one in maps:
        for mu in one.inputs.frictions:
            boundaries = [boundary for found in one.orientations for boundary in found.boundaries if boundary.mu == mu]
            certain = sum(
                AssemblyOutcome.UNDECIDED not in (boundary.outcome_before, boundary.outcome_after)
                for boundary in boundaries
            )
            otherwise = sum(
                cell.mu == mu and SettledFlag.STEP_DEPENDENT in cell.flags
                for found in one.orientations
                for cell in found.cells
            )
            lines.append(f"| {one.name} | {number_text(mu)} | {certain} | {otherwise} |")
    return lines


def _listed(frictions: Sequence[float]) -> str:
    return ", ".join(map(number_text, frictions))
