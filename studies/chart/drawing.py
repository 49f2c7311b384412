"""The chart as SVG: every contestant by the time a pose takes it and how far it is off."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

from studies.chart.axes import Axes, decades, range_about, spread_out
from studies.chart.contestant import MICROINCH, ByMesh, Contestant, Series
from studies.chart.errors import FLOOR_INCH
from studies.chart.pareto import front
from studies.chart.study import Measured, Study

WIDTH, HEIGHT = 1180, 1110
INK, FAINT, GRID = "#1d2733", "#5c6875", "#e3e7ec"
COLOURS = {
    Series.EXACT: "#0b5fa5",
    Series.CURVES: "#1a8a5a",
    Series.EDGES: "#c2410c",
    Series.FULL: "#7c3aed",
    Series.BAND: "#b08900",
    Series.DECADES: "#be185d",
    Series.COAL: "#475569",
}
NAMES = {
    Series.EXACT: "exact method",
    Series.CURVES: "edge curves, no mesh",
    Series.EDGES: "meshes, fine at edges",
    Series.FULL: "meshes, full solids",
    Series.BAND: "meshes, no walls",
    Series.DECADES: "decade descent",
    Series.COAL: "coal in place of fcl",
}
MARKS = {
    Series.EXACT: "star",
    Series.CURVES: "circle",
    Series.EDGES: "circle",
    Series.FULL: "square",
    Series.BAND: "diamond",
    Series.DECADES: "cross",
    Series.COAL: "triangle",
}
LABEL_GAP = 19.0

Quantity = Callable[[Measured], float]


@dataclass(frozen=True)
class Point:
    """A contestant in the chart: milliseconds, and the error."""

    time: float
    error: float


def height_p95(one: Measured) -> float:
    """The error of the height of first contact that 95 of 100 poses stay below (length)."""
    return max(one.score.height.p95, FLOOR_INCH)


def turn_p95(one: Measured) -> float:
    """The same of the turns (deg)."""
    return max(one.score.turn.p95, FLOOR_INCH)


def points(found: Sequence[Measured], error: Quantity) -> list[Point]:
    """Contestants as points."""
    return [Point(1e3 * one.score.seconds.median, error(one)) for one in found]


def drawing(study: Study) -> str:
    """The whole chart."""
    sampled = [one for one in study.measured if one.run.contestant.series is not Series.EXACT]
    everything = points(study.measured, height_p95)
    overview = Axes(96, 112, 800, 380, _times(everything), range_about([point.error for point in everything], 0.7))
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" role="img"'
        ' font-family="system-ui, Segoe UI, Helvetica, Arial, sans-serif">',
        "<title>Speed against accuracy of contact states</title>",
        f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>',
        _text(40, 44, "Speed against accuracy", 26, INK, weight="600"),
        _text(
            40,
            72,
            f"All contacts of {study.scale.poses} poses of {study.pair.designation}, half on the grid, half off it. "
            "Down and to the left is better.",
            15,
            FAINT,
        ),
    ]
    unit = study.pair.unit.value
    parts += _panel(study, study.measured, height_p95, overview, f"error of the height, 95 of 100 poses ({unit})", 3)
    for k, (error, name) in enumerate(
        (
            (height_p95, f"error of the height, 95 of 100 poses ({unit})"),
            (turn_p95, "error of the turns, 95 of 100 poses (deg)"),
        )
    ):
        near = points(sampled, error)
        axes = Axes(96 + 560 * k, 622, 280, 380, _times(near), range_about([point.error for point in near], 0.25))
        parts += _panel(study, sampled, error, axes, name, 1)
    parts.append(
        _text(96, 592, "The upper right corner: all that samples, by heights and by turns", 17, INK, weight="600")
    )
    for k, words in enumerate(
        (
            "A line goes from coarse to finest meshes at a final step of 1 microinch; points beside it have 10 or 0.1.",
            "CPU time of one thread, set-up apart. Dashed: the Pareto front of what is shown; shaded: what it beats.",
        )
    ):
        parts.append(_text(40, 1074 + 19 * k, words, 13, FAINT))
    return "\n".join([*parts, "</svg>"]) + "\n"


def _times(found: Sequence[Point]) -> tuple[float, float]:
    return range_about([point.time for point in found], 0.2)


def _panel(study: Study, shown: Sequence[Measured], error: Quantity, axes: Axes, name: str, every: int) -> list[str]:
    parts = _frame(axes, name, every)
    parts += _front(points(shown, error), axes)
    present = [series for series in Series if any(one.run.contestant.series is series for one in shown)]
    ends = []
    for series in present:
        found = points(study.of(series), error)
        line = points([one for one in study.of(series) if is_on_line(one.run.contestant)], error)
        parts += _series(series, found, line, axes)
        ends.append(found[0] if series is Series.EXACT else found[-1])
    wanted = [axes.y(end.error) for end in ends]
    labels = spread_out(wanted, LABEL_GAP, axes.top + 8, axes.top + axes.height - 4)
    at = axes.left + axes.width + 26
    for series, end, y in zip(present, ends, labels, strict=True):
        colour = COLOURS[series]
        parts.append(
            f'<path d="M{axes.x(end.time) + 7:.1f} {axes.y(end.error):.1f} L{at - 14:.1f} {y:.1f} H{at - 4:.1f}"'
            f' fill="none" stroke="{colour}" stroke-width="1" opacity="0.55"/>'
        )
        parts.append(_text(at, y + 4.5, NAMES[series], 13.5, colour, weight="600"))
    return parts


def _frame(axes: Axes, name: str, every: int) -> list[str]:
    right, bottom = axes.left + axes.width, axes.top + axes.height
    parts = [
        f'<rect x="{axes.left}" y="{axes.top}" width="{axes.width}" height="{axes.height}" fill="none"'
        f' stroke="{GRID}"/>'
    ]
    for k in decades(axes.y_range, every):
        y = axes.y(10.0**k)
        parts.append(f'<path d="M{axes.left} {y:.1f} H{right}" stroke="{GRID}"/>')
        parts.append(_power(axes.left - 10, y + 4.5, k))
    for k in decades(axes.x_range, 1):
        x = axes.x(10.0**k)
        parts.append(f'<path d="M{x:.1f} {axes.top} V{bottom}" stroke="{GRID}"/>')
        parts.append(_text(x, bottom + 20, _milliseconds(k), 13, FAINT, anchor="middle"))
    parts.append(_text(axes.left + axes.width / 2, bottom + 42, "time per pose, median", 13, FAINT, anchor="middle"))
    middle = axes.top + axes.height / 2
    parts.append(
        f'<text transform="translate({axes.left - 58} {middle}) rotate(-90)" font-size="13" fill="{FAINT}"'
        f' text-anchor="middle">{escape(name)}</text>'
    )
    return parts


def _front(found: Sequence[Point], axes: Axes) -> list[str]:
    """The front, from the top down to each of its points and on to the right."""
    best = [found[k] for k in front([(point.time, point.error) for point in found])]
    path = f"M{axes.x(best[0].time):.1f} {axes.top}"
    for point in best:
        path += f" H{axes.x(point.time):.1f} V{axes.y(point.error):.1f}"
    path += f" H{axes.left + axes.width}"
    area = f"{path} V{axes.top} Z"
    return [
        f'<path d="{area}" fill="#eef3f8" opacity="0.6"/>',
        f'<path d="{path}" fill="none" stroke="{FAINT}" stroke-width="1.2" stroke-dasharray="5 4"/>',
    ]


def is_on_line(contestant: Contestant) -> bool:
    """Whether it is one of those that a series' line joins: one final step, ever finer meshes."""
    return isinstance(contestant.way, ByMesh) and contestant.way.options.final_step == MICROINCH


def _series(series: Series, found: Sequence[Point], line: Sequence[Point], axes: Axes) -> list[str]:
    places = [(axes.x(point.time), axes.y(point.error)) for point in found]
    colour = COLOURS[series]
    parts = []
    if len(line) > 1:
        joined = " ".join(f"{axes.x(point.time):.1f},{axes.y(point.error):.1f}" for point in line)
        parts.append(f'<polyline points="{joined}" fill="none" stroke="{colour}" stroke-width="1.4" opacity="0.5"/>')
    return parts + [_mark(MARKS[series], x, y, colour) for x, y in places]


def _mark(kind: str, x: float, y: float, colour: str) -> str:
    style = f'fill="{colour}" stroke="#ffffff" stroke-width="1"'
    if kind == "circle":
        return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4.6" {style}/>'
    if kind == "cross":
        return f'<path d="M{x - 4:.1f} {y - 4:.1f} l8 8 m0 -8 l-8 8" fill="none" stroke="{colour}" stroke-width="2.2"/>'
    sides = {"square": (4, 0.125), "diamond": (4, 0.0), "triangle": (3, 0.25), "star": (5, 0.25)}
    count, turn = sides[kind]
    corners = []
    for k in range(count * (2 if kind == "star" else 1)):
        radius = 8.5 if kind == "star" and k % 2 == 0 else (3.8 if kind == "star" else 5.6)
        angle = 2.0 * math.pi * (k / (count * (2 if kind == "star" else 1)) - turn)
        corners.append(f"{x + radius * math.cos(angle):.1f},{y + radius * math.sin(angle):.1f}")
    return f'<polygon points="{" ".join(corners)}" {style}/>'


def _power(x: float, y: float, exponent: int) -> str:
    digits = str(exponent).replace("-", "\u2212")
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-size="13" fill="{FAINT}" text-anchor="end">10'
        f'<tspan dy="-5" font-size="9.5">{digits}</tspan></text>'
    )


def _milliseconds(exponent: int) -> str:
    return f"{10 ** (exponent - 3)} s" if exponent >= 3 else f"{10.0**exponent:g} ms"


def _text(x: float, y: float, words: str, size: float, colour: str, anchor: str = "start", weight: str = "400") -> str:
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{colour}" text-anchor="{anchor}"'
        f' font-weight="{weight}">{escape(words)}</text>'
    )
