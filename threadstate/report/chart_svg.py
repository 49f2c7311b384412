"""Curves over the phase of the hand as SVG: the same chart gives the same text."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from itertools import pairwise

from threadstate.device.assembly_model import PathEventKind
from threadstate.report.curves import Chart, Course, Mark, Series
from threadstate.report.words import MINUS, exact, rounded

WIDTH, PLOT_HEIGHT = 460, 262
LEFT, RIGHT, TOP, BOTTOM = 62, 12, 40, 44
LEGEND_ROW, LEGEND_COLUMNS = 22, 2
LEAST_STEP_PX = 0.6
"""Vertices of a curve that are nearer to each other are not drawn."""
LEAST_LABEL_PX = 30.0
"""Labels of the phase stand no nearer to each other."""
LABELLED_DEG = 90.0


@dataclass(frozen=True, slots=True)
class _View:
    """What is drawn: how far the hand turns, and a range of values."""

    turned_deg: float
    low: float
    high: float

    def x(self, turned_deg: float) -> float:
        """Where a turn of the hand is, in pixels from the left."""
        return LEFT + turned_deg / self.turned_deg * (WIDTH - LEFT - RIGHT)

    def y(self, value: float) -> float:
        """Where a value is, in pixels from the top."""
        return TOP + (self.high - value) / (self.high - self.low) * (PLOT_HEIGHT - TOP - BOTTOM)


def chart_svg(chart: Chart, course: Course, marks: Sequence[Mark]) -> str:
    """A picture of the chart; marks are the falls and the snap."""
    view = _view(chart, course)
    rows = math.ceil(len(chart.series) / LEGEND_COLUMNS) if len(chart.series) > 1 else 0
    height = PLOT_HEIGHT + LEGEND_ROW * rows
    return "\n".join(
        [
            f'<svg class="chart" viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{escape(alternative(chart))}">',
            f'<text class="title" x="{LEFT}" y="22">{escape(chart.title)} ({escape(chart.unit)})</text>',
            *_shade(view, course),
            *_axes(view, course),
            *_marks(view, marks),
            *(
                f'<path class="line line-{i}" d="{_line(view, course, series)}"/>'
                for i, series in enumerate(chart.series)
            ),
            *(_legend(chart) if rows else ()),
            "</svg>",
        ]
    )


def alternative(chart: Chart) -> str:
    """What a picture shows, in words: of each curve the range and the end."""
    texts = []
    for series in chart.series:
        name = f"{series.name} " if len(chart.series) > 1 else ""
        low, high, end = (rounded(value) for value in (min(series.values), max(series.values), series.values[-1]))
        texts.append(f"{name}from {low} to {high}, {end} at the end")
    return f"{chart.title} ({chart.unit}) over the phase: {'; '.join(texts)}."


def _view(chart: Chart, course: Course) -> _View:
    values = [value for series in chart.series for value in series.values]
    low, high = min(values), max(values)
    # A curve that does not move is drawn in the middle of its picture.
    margin = 0.07 * (high - low) or 0.5 * abs(high) or 1.0
    return _View(course.turned_deg[-1] or 1.0, low - margin, high + margin)


def _shade(view: _View, course: Course) -> Iterator[str]:
    """The second turn on a ground of its own."""
    if course.legs[-1] > 0:
        x = view.x(course.turned_deg[course.legs.index(1) - 1])
        yield (
            f'<rect class="back" x="{x:.2f}" y="{TOP}" width="{WIDTH - RIGHT - x:.2f}" '
            f'height="{PLOT_HEIGHT - TOP - BOTTOM}"/>'
        )


def _axes(view: _View, course: Course) -> Iterator[str]:
    right, bottom = WIDTH - RIGHT, PLOT_HEIGHT - BOTTOM
    for value in ticks(view.low, view.high):
        y = view.y(value)
        kind = "axis" if value == 0.0 else "grid"
        yield f'<path class="{kind}" d="M{LEFT} {y:.2f}H{right}"/>'
        yield f'<text class="soft end" x="{LEFT - 7}" y="{y + 4.5:.2f}">{_tick(value)}</text>'
    last = -math.inf
    for turned_deg, phase_deg in phase_labels(course):
        x = view.x(turned_deg)
        yield f'<path class="grid" d="M{x:.2f} {TOP}V{bottom}"/>'
        if x - last >= LEAST_LABEL_PX:
            # At the right border a label in the middle would be cut off.
            place = f'end" x="{WIDTH - 1}' if x > right - RIGHT else f'middle" x="{x:.2f}'
            yield f'<text class="soft {place}" y="{bottom + 18}">{exact(phase_deg)}</text>'
            last = x
    yield f'<text class="soft middle" x="{0.5 * (LEFT + right):.1f}" y="{bottom + 37}">phase of the hand (deg)</text>'


def phase_labels(course: Course) -> Iterator[tuple[float, float]]:
    """Round phases of each leg: how far the hand has turned there, and the phase; in degrees."""
    for k, (before, after) in enumerate(pairwise(course.phases_deg)):
        low, high = min(before, after), max(before, after)
        for number in range(math.ceil(low / LABELLED_DEG), math.floor(high / LABELLED_DEG) + 1):
            phase_deg = number * LABELLED_DEG
            if phase_deg != before or k == 0:
                yield course.turned_deg[k] + abs(phase_deg - before), phase_deg


def _marks(view: _View, marks: Sequence[Mark]) -> Iterator[str]:
    """A line where the bolt falls; the snap by its name."""
    bottom = PLOT_HEIGHT - BOTTOM
    for mark in marks:
        x = view.x(mark.turned_deg)
        if mark.kind is PathEventKind.SNAP:
            yield f'<text class="event end" x="{x - 5.0:.2f}" y="{TOP - 4}">snap</text>'
        else:
            yield f'<path class="fall" d="M{x:.2f} {TOP}V{bottom}"/>'
            yield f'<path class="event" d="M{x - 4.0:.2f} {TOP - 8}H{x + 4.0:.2f}L{x:.2f} {TOP}Z"/>'


def _line(view: _View, course: Course, series: Series) -> str:
    """A curve, without the vertices that are too near to see."""
    places = [(view.x(turned), view.y(value)) for turned, value in zip(course.turned_deg, series.values, strict=True)]
    drawn = [places[0]]
    for place in places[1:-1]:
        if math.dist(place, drawn[-1]) >= LEAST_STEP_PX:
            drawn.append(place)
    drawn += places[-1:] if len(places) > 1 else []
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in drawn)


def _legend(chart: Chart) -> Iterator[str]:
    width = (WIDTH - LEFT - RIGHT) / LEGEND_COLUMNS
    for i, series in enumerate(chart.series):
        row, column = divmod(i, LEGEND_COLUMNS)
        x, y = LEFT + column * width, PLOT_HEIGHT + LEGEND_ROW * row + 8
        yield f'<path class="line line-{i}" d="M{x:.1f} {y}h30"/>'
        yield f'<text x="{x + 37:.1f}" y="{y + 4.5}">{escape(series.name)}</text>'


def ticks(low: float, high: float) -> list[float]:
    """Round values between two others: three to seven."""
    rough = (high - low) / 6.0
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1.0, 2.0, 5.0, 10.0) if factor * power >= rough)
    return [step * i + 0.0 for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _tick(value: float) -> str:
    return f"{value:.6g}".replace("-", MINUS)
