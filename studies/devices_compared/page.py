"""docs/devices-compared.md and its pictures."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from studies.devices_compared.study import (
    DEFAULT,
    DEFAULT_PAIR,
    FORCES,
    FRICTION_GRID,
    GRID,
    MORE_FORCE,
    MORE_FORCE_STRATEGY,
    MU,
    SHIFT_LIMIT_MM,
    TILT_LIMIT_DEG,
    Comparison,
    Row,
    Variant,
    comparisons,
    friction_comparison,
    like_outcomes,
    row,
    tilt_deg,
)
from studies.pictures import FAINT, INK, picture
from studies.success.study import StudiedMap
from threadstate.device.strategy import Strategy
from threadstate.numbers import number_text
from threadstate.success.summary import map_counts

WITHIN, BEYOND, OPEN = "#0b5f99", "#8fbfd8", "#ffffff"
"""Orientations that engage within the travel, beyond it, and those without a certain outcome."""
COLOURS = {Strategy.CCW_THEN_CW: "#4a5563", Strategy.CW: "#e08e45"}
"""Of the strategies, where both are in one plot."""
TRAVEL = f"{number_text(TILT_LIMIT_DEG)} deg and {number_text(SHIFT_LIMIT_MM)} mm"
ROW_IN, AROUND_IN = 0.44, 1.5
"""Heights of a row of a picture, and of what is around the rows (inches)."""
HASH_DIGITS = 12
ROUND_OFF_DEG = 1e-9
WIDTH = 118

Maps = Mapping[str, StudiedMap]
"""Maps by the hash of what they were computed from."""


class Measure(NamedTuple):
    """What the last plot of a picture shows: its axis, its value of a row, and the limit of the travel."""

    axis: str
    value: Callable[[Row], float | None]
    limit: float | None


SHIFT = Measure("largest shift (mm)", lambda one: one.shift, SHIFT_LIMIT_MM)
TORQUE = Measure("largest torque (N mm)", lambda one: one.torque, None)


def page(maps: Maps) -> str:
    """The page as Markdown; ``maps`` are those of ``all_inputs``."""
    sections = [_section(comparison, maps) for comparison in comparisons()]
    return "\n\n".join([_head(maps), *sections, _friction_section(maps)]) + "\n"


def pictures(maps: Maps) -> dict[str, str]:
    """The pictures as SVG, by name."""
    drawn = {
        comparison.name: bars(f"{comparison.title}, without friction", comparison.varied, rows(comparison, maps), SHIFT)
        for comparison in comparisons()
    }
    friction = friction_comparison()
    return {**drawn, friction.name: bars(friction.title, friction.varied, friction_rows(friction, maps), TORQUE)}


def rows(comparison: Comparison, maps: Maps) -> list[Row]:
    """What the maps of a comparison say, the strategies of a variant after each other."""
    return [
        row(variant.label, maps[variant.inputs(strategy).sha256])
        for variant in comparison.computed
        for strategy in comparison.strategies
    ]


def friction_rows(comparison: Comparison, maps: Maps) -> list[Row]:
    """What the maps with friction say at each of their frictions."""
    return [
        row(f"{variant.name}, mu {number_text(mu)}", maps[variant.inputs(strategy, with_friction=True).sha256], mu)
        for variant in comparison.computed
        for mu in (0.0, MU)
        for strategy in comparison.strategies
    ]


def bars(title: str, varied: str, found: Sequence[Row], last: Measure) -> str:
    """Counts of orientations by strategy, and one measure of all, as horizontal bars in SVG; ``varied`` is the axis."""
    names = list(dict.fromkeys(one.name for one in found))
    strategies = _strategies_of(found)

    def draw(figure: Figure) -> None:
        figure.suptitle(title, x=0.01, ha="left", fontweight="bold")
        plots = figure.subplots(1, len(strategies) + 1, sharey=True)
        for axes, strategy in zip(plots, strategies, strict=False):
            _count_bars(axes, [one for one in found if one.strategy is strategy])
            axes.set_title(f"by {strategy.value}")
        _measure_bars(plots[-1], found, last)
        plots[0].set_yticks(range(len(names)), names)
        plots[0].set_ylabel(varied)
        plots[0].set_ylim(len(names) - 0.4, -0.6)
        handles = [
            Patch(facecolor=WITHIN, label=f"engage within {TRAVEL}"),
            Patch(facecolor=BEYOND, label="engage with more travel"),
            Patch(facecolor=OPEN, edgecolor=FAINT, hatch="////", label="undecided"),
        ]
        if len(strategies) > 1:
            handles += [Patch(facecolor=COLOURS[strategy], label=strategy.value) for strategy in strategies]
        figure.legend(handles=handles, loc="outside lower center", ncols=len(handles), fontsize=8.0)

    return picture((10.0, AROUND_IN + ROW_IN * max(2, len(names))), title, draw)


def _count_bars(axes: Axes, found: Sequence[Row]) -> None:
    """How many orientations engage by one strategy, and how many of these within the travel."""
    total = max(one.paths for one in found)
    for place, one in enumerate(found):
        axes.barh(place, one.within, color=WITHIN, height=0.7)
        axes.barh(place, one.engaged - one.within, left=one.within, color=BEYOND, height=0.7)
        if one.undecided:
            axes.barh(place, one.undecided, left=one.engaged, color=OPEN, edgecolor=FAINT, hatch="////", height=0.7)
        axes.text(one.engaged + one.undecided + 0.02 * total, place, f"{one.engaged} ({one.within})", va="center")
    axes.set(xlim=(0.0, 1.15 * total), xlabel=f"engage (within the travel), of {total}")
    axes.grid(visible=False, axis="y")


def _measure_bars(axes: Axes, found: Sequence[Row], measure: Measure) -> None:
    """What the paths that engage ask for at most, a bar for each strategy."""
    largest = max((value for one in found if (value := measure.value(one)) is not None), default=1.0)
    strategies = _strategies_of(found)
    height = 0.72 / len(strategies)
    for number, strategy in enumerate(strategies):
        offset = height * (number - 0.5 * (len(strategies) - 1))
        for place, one in enumerate(one for one in found if one.strategy is strategy):
            value = measure.value(one)
            axes.barh(place + offset, value or 0.0, color=COLOURS[strategy], height=0.95 * height)
            text = "none engages" if value is None else f"{value:.3g}"
            axes.text((value or 0.0) + 0.02 * largest, place + offset, text, va="center", fontsize=8.0)
    if measure.limit is not None and measure.limit < 1.2 * largest:
        axes.axvline(measure.limit, color=INK, linestyle="--", linewidth=1.0)
    axes.set(xlim=(0.0, 1.25 * largest), xlabel=measure.axis)
    axes.set_title("of those that engage")
    axes.grid(visible=False, axis="y")


def table(varied: str, found: Sequence[Row], omitted: Sequence[str] = ()) -> str:
    """Rows as a table in Markdown; the names of those that are not computed at the end."""
    lines = [
        f"| {varied} | strategy | engage | within the travel | undecided | torque (N mm) | tilt (deg) | shift (mm) | "
        "map |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for one in found:
        needs = ["-" if need is None else f"{need:.3g}" for need in (one.torque, one.tilt_deg, one.shift)]
        lines.append(
            f"| {one.name} | `{one.strategy.value}` | {one.engaged} of {one.paths} | {one.within} | {one.undecided} | "
            f"{' | '.join(needs)} | `{one.content_sha256[:HASH_DIGITS]}` |"
        )
    lines += [f"| {name} | not computed | - | - | - | - | - | - | - |" for name in omitted]
    return "\n".join(lines)


def seen(found: Sequence[Row]) -> str:
    """What the rows of a comparison say, in sentences: the range of each count and of the shift, by strategy."""
    lines = []
    for strategy in _strategies_of(found):
        ours = [one for one in found if one.strategy is strategy]
        paths = ours[0].paths
        engaged = _range([(one.engaged, one.name) for one in ours], str)
        within = _range([(one.within, one.name) for one in ours], str)
        shifts = [(one.shift, one.name) for one in ours if one.shift is not None]
        words = f"- By `{strategy.value}`, of {paths} orientations, {engaged} engage; within the travel {within}."
        if shifts:
            words += f" The largest shift is {_range(shifts, lambda value: f'{value:.3g} mm')}."
        lines.append(words)
    return "\n".join(lines)


def _range(values: Sequence[tuple[float, str]], text: Callable[[float], str]) -> str:
    """From the least to the largest value, each with the names that have it; one number where all are alike."""
    low, high = min(values)[0], max(values)[0]
    if text(low) == text(high):
        return text(low)
    ends = [
        f"{text(end)} ({', '.join(name.removesuffix(' (default)') for value, name in values if value == end)})"
        for end in (low, high)
    ]
    return " to ".join(ends)


def _head(maps: Maps) -> str:
    one, more = (maps[variant.inputs(MORE_FORCE_STRATEGY).sha256] for variant in (DEFAULT, MORE_FORCE))
    alike = like_outcomes(one, more)
    errors = [
        abs(beside.torque / (FORCES * cell.torque) - 1.0) for cell, beside in alike if cell.torque and beside.torque
    ]
    little = sum(
        tilt_deg(GRID.orientation(index)) <= TILT_LIMIT_DEG + ROUND_OFF_DEG for index in range(GRID.orientation_count)
    )
    low, high = GRID.tilts_deg[0], GRID.tilts_deg[-1]
    what = (
        "`make compared` writes this page: what another strategy, [device](device.md#the-device) or pair changes of "
        "how many orientations assemble. Each row differs in one thing from the default device and "
        f"{DEFAULT_PAIR}, and has a [success map](success.md): {GRID.orientation_count} orientations (rolls and "
        f"pitches of {low:.0f} to {high:.0f} deg), starting phase 0, no friction. What holds from one starting phase "
        "need not hold from another one. The hand turns by `ccw_then_cw` where nothing else is said."
    )
    scale = (
        "Parts are rigid and slow, so that only the ratio of stiffnesses and push matters: half the push does what "
        f"twice all stiffnesses do. With push and stiffnesses {number_text(FORCES)} times the default ones, "
        f"{len(alike)} of {GRID.orientation_count} paths by `{one.inputs.strategy.value}` end as they do with the "
        f"default ones, with {number_text(FORCES)} times their torque to {max(errors):.0e}; map "
        f"`{more.content_sha256[:HASH_DIGITS]}`."
    )
    return f"""# Devices compared

{_paragraph(what)}

- **Engage**: the orientations of which the path ends engaged.
- **Within the travel**: those of them that ask the device for no more than {TRAVEL}. The command itself is tilted by
  at most {number_text(TILT_LIMIT_DEG)} deg in {little} of the {GRID.orientation_count} orientations.
- **Undecided**: those without a certain outcome; they do not count as engaged.
- **Torque, tilt, shift**: the largest that those which engage ask for.
- **Map**: the first digits of its content hash.

{_paragraph(scale)}"""


def _section(comparison: Comparison, maps: Maps) -> str:
    found = rows(comparison, maps)
    omitted = {variant.name: variant.omission for variant in comparison.variants if variant.omission is not None}
    parts = [f"## {comparison.title}", table(comparison.varied, found, list(omitted))]
    parts += [_paragraph(f"{name} is not computed: {reason}.") for name, reason in omitted.items()]
    if len(comparison.variants) == 1:
        parts.append(_strategies(comparison.variants[0], maps))
    else:
        parts.append(seen(found))
    parts += [WORDS[comparison.name]] if comparison.name in WORDS else []
    parts.append(_picture_link(comparison.title, comparison.name))
    return "\n\n".join(parts)


def _strategies(variant: Variant, maps: Maps) -> str:
    """How all paths end by either strategy, and which orientations engage by one alone."""
    lines, engaging = [], []
    for strategy in Strategy:
        one = maps[variant.inputs(strategy).sha256]
        counts = map_counts(one.orientations, one.inputs.grid, 0.0)
        outcomes = ", ".join(f"{count} {outcome.value.replace('_', ' ')}" for outcome, count in counts.outcomes)
        lines.append(f"- By `{strategy.value}` of {len(one.orientations)} paths end {outcomes}.")
        engaging.append({found.index for found in one.orientations if all(cell.engages for cell in found.cells)})
    first, second = engaging
    lines.append(
        f"- {len(first & second)} orientations engage by both, {len(first - second)} by the first alone, "
        f"{len(second - first)} by the second alone."
    )
    return "\n".join(lines)


def _friction_section(maps: Maps) -> str:
    comparison = friction_comparison()
    found = friction_rows(comparison, maps)
    tilts = ", ".join(f"{tilt:.0f}" for tilt in FRICTION_GRID.tilts_deg)
    with_friction = [
        row(variant.name, maps[variant.inputs(strategy, with_friction=True).sha256], MU)
        for variant in comparison.computed
        for strategy in comparison.strategies
    ]
    words = _paragraph(
        "The default, a loose pair, a device that is stiff against tilt and one that turns farther until the snap, at "
        f"mu = {number_text(MU)}, of {FRICTION_GRID.orientation_count} orientations: rolls and pitches of {tilts} deg, "
        "from starting phase 0. "
        "The rows without friction are those of the same orientations. No other device or pair was computed with "
        "friction here; the default one has been, by both strategies and at three frictions, for [its success "
        "maps](success.md#measured-the-default-device)."
    )
    ends = f"With mu = {number_text(MU)}:\n\n{seen(with_friction)}"
    parts = [
        f"## {comparison.title}",
        words,
        table(comparison.varied, found),
        ends,
        _picture_link(comparison.title, comparison.name),
    ]
    return "\n\n".join(parts)


def _strategies_of(found: Sequence[Row]) -> list[Strategy]:
    """The strategies of rows, in their order."""
    return list(dict.fromkeys(one.strategy for one in found))


def _picture_link(title: str, name: str) -> str:
    what = "orientations that engage, and what they ask the device for"
    return f"![{title}: {what}.](devices-compared/{name}.svg)"


def _paragraph(text: str) -> str:
    return textwrap.fill(text, WIDTH, break_long_words=False, break_on_hyphens=False)


WORDS = {
    "sizes": "Scaled devices have lengths in proportion to the nominal diameter at the same push: `k_lateral` is\n"
    "divided by the ratio of diameters, `k_tilt` multiplied by it. The travel allowed is not scaled.",
    "about": "`nut` turns the tilt round with the phase, `bolt` leaves it in space.",
    "ccw-turn": "A turn that ends before the snap leaves the bolt on the nut, however well it is held. From phase 0\n"
    "snaps that come soon after a whole turn are missed by 360 deg.",
}
"""What a reader needs beside the numbers."""
