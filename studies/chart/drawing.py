"""The chart: every contestant by the time a pose takes it and how far it is off.

``python -m studies.chart.drawing`` draws it again from the stored numbers.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import EngFormatter

from studies.chart.contestant import ONE_MICROINCH, Series
from studies.chart.errors import FLOOR_INCH
from studies.chart.findings import front
from studies.pictures import FAINT, picture

DOCS = Path(__file__).parent.parent.parent / "docs"
TITLE = "Speed against accuracy"
NOTE = (
    "A line goes from coarse to finest meshes at a final step of 1 microinch; points beside it have 10 or 0.1.\n"
    "CPU time of one thread, set-up apart. Dashed: the Pareto front of what is shown; shaded: what it beats."
)
STYLES = {
    Series.EXACT: ("exact method", "*", "#0b5fa5"),
    Series.CURVES: ("edge curves, no mesh", "o", "#1a8a5a"),
    Series.EDGES: ("meshes, fine at edges", "p", "#c2410c"),
    Series.FULL: ("meshes, full solids", "s", "#7c3aed"),
    Series.BAND: ("meshes, no walls", "D", "#b08900"),
    Series.DECADES: ("decade descent", "X", "#be185d"),
    Series.COAL: ("coal in place of fcl", "^", "#475569"),
}
"""Name, marker and colour."""


@dataclass(frozen=True)
class Point:
    """A contestant: seconds per pose (median), and errors that 95 of 100 poses stay below; nan where there are none.

    ``on_line`` is whether it is one of those that a series' line joins: one final step, ever finer meshes.
    """

    series: Series
    on_line: bool
    seconds: float
    height: float
    turn_deg: float


def points(numbers: dict[str, Any]) -> Iterator[Point]:
    """The contestants of the study's document."""
    for one in numbers["contestants"]:
        height, turn_deg = (
            math.nan if one[name]["p95"] is None else max(one[name]["p95"], FLOOR_INCH) for name in ("height", "turn")
        )
        on_line = one["label"].endswith(ONE_MICROINCH)
        yield Point(Series(one["series"]), on_line, one["seconds"]["median"], height, turn_deg)


def drawing(document: str) -> str:
    """The chart of a study's document (JSON) as SVG."""
    numbers = json.loads(document)
    found = list(points(numbers))
    sampled = [point for point in found if point.series is not Series.EXACT]
    height, turn = (f"error of the {name}, 95 of 100 poses" for name in ("height", "turns"))

    def draw(figure: Figure) -> None:
        panels = figure.subplot_mosaic([["all", "all"], ["heights", "turns"]])
        _panel(panels["all"], found, [point.height for point in found], f"{height} ({numbers['unit']})")
        _panel(panels["heights"], sampled, [point.height for point in sampled], f"{height} ({numbers['unit']})")
        _panel(panels["turns"], sampled, [point.turn_deg for point in sampled], f"{turn} (deg)")
        count = len(numbers["poses"])
        panels["all"].set_title(
            f"{TITLE}: all contacts of {count} poses of {numbers['pair']}, half on the grid, half off it.\n"
            "Down and to the left is better."
        )
        panels["heights"].set_title("The upper right corner: all that samples")
        handles, labels = panels["all"].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside right upper")
        figure.supxlabel(NOTE, x=0.01, ha="left", color=FAINT, fontsize="medium")

    return picture((11.8, 10.4), TITLE, draw)


def _panel(axes: Axes, shown: Sequence[Point], errors: Sequence[float], label: str) -> None:
    axes.set(xscale="log", yscale="log", xlabel="time per pose, median", ylabel=label)
    axes.xaxis.set_major_formatter(EngFormatter("s"))
    axes.xaxis.minorticks_off()
    axes.yaxis.minorticks_off()
    for series, (name, marker, colour) in STYLES.items():
        mine = [(point, error) for point, error in zip(shown, errors, strict=True) if point.series is series]
        line = [(point.seconds, error) for point, error in mine if point.on_line]
        if mine:
            axes.plot(*_columns(line), color=colour, alpha=0.5, linewidth=1.4)
            size = 13.0 if series is Series.EXACT else 7.5
            axes.plot(
                *_columns([(p.seconds, e) for p, e in mine]),
                marker,
                color=colour,
                label=name,
                markersize=size,
                markeredgecolor="white",
                linestyle="none",
            )
    _shade_beaten(axes, [(p.seconds, e) for p, e in zip(shown, errors, strict=True) if not math.isnan(e)])


def _shade_beaten(axes: Axes, costs: Sequence[tuple[float, float]]) -> None:
    """Draw the front, from the top down to each of its points and on to the right, and shade what is beyond."""
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    best = [costs[k] for k in front(costs)]
    times, errors = _columns([(best[0][0], top), *best, (right, best[-1][1])])
    axes.step(times, errors, where="post", color=FAINT, linestyle="--", linewidth=1.2, zorder=1.5)
    axes.fill_between(times, errors, top, step="post", color="#eef3f8", alpha=0.6, linewidth=0.0, zorder=0.5)
    axes.set(xlim=(left, right), ylim=(bottom, top))


def _columns(pairs: Sequence[tuple[float, float]]) -> tuple[list[float], list[float]]:
    return [first for first, _ in pairs], [second for _, second in pairs]


def main() -> None:
    """Draw the chart of the stored numbers."""
    (DOCS / "speed-accuracy.svg").write_text(drawing((DOCS / "speed-accuracy.json").read_text()))


if __name__ == "__main__":
    main()
