"""Curves and maps as SVG or PNG files, by matplotlib."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from threadstate.errors import InvalidValueError
from threadstate.numbers import number_text
from threadstate.responses.documents import HeightsDocument, WindowDocument
from threadstate.units import LengthUnit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ENDINGS = (".svg", ".png")
TURN_DEG = 360.0
MOST_TICKS = 17
"""A map with more values of an angle than that does not name them all."""

_DOTS_PER_INCH = 150
_FIRST, _REST, _WINDOW, _NONE = "#1f5fa8", "#b3541e", "#dfe9d8", "#c8c8c8"


def check_plot_file(path: Path, endings: Sequence[str] = ENDINGS) -> None:
    """Check that a plot can be written to a file of this name, with one of these endings.

    Raises:
        InvalidValueError: another ending, or a folder that does not exist.
    """
    if path.suffix.lower() not in endings:
        raise InvalidValueError("--plot", str(path), f"a name that ends in {' or '.join(endings)}")
    if not path.absolute().parent.is_dir():
        raise InvalidValueError("--plot", str(path), "a file in a folder that exists")


def plot_heights(document: HeightsDocument, windows: Sequence[WindowDocument], unit: LengthUnit, path: Path) -> None:
    """Draw the height of first contact against phase, where the bolt rests that too, and shade the windows.

    Args:
        document: the curve, lengths in ``unit``.
        windows: the clearance windows of its orientation.
        unit: unit of the lengths.
        path: the file; its ending says the format.

    Raises:
        InvalidValueError: the file cannot be of that name.
    """
    with _figure(path, (9.0, 4.5)) as figure:
        axes = figure.add_subplot()
        for start, end in _within_turn(windows):
            axes.axvspan(start, end, color=_WINDOW, linewidth=0.0, label="clearance window")
        for heights, colour, label in (
            (document.rest_heights, _REST, "at rest"),
            (document.first_heights, _FIRST, "first contact"),
        ):
            # A height that is not known interrupts the curve.
            known = [float("nan") if height is None else height for height in heights]
            axes.plot(document.phases, known, color=colour, linewidth=1.4, label=label)
        axes.set_title(f"roll {number_text(document.roll)}°, pitch {number_text(document.pitch)}°")
        axes.set_xlabel("phase (deg), counter-clockwise")
        axes.set_ylabel(f"height of the bolt ({unit})")
        axes.set_xlim(0.0, TURN_DEG)
        axes.set_xticks(range(0, 361, 30))
        _legend(figure, axes)


def plot_map(
    values: Mapping[tuple[float, float], float | None], title: str, unit: LengthUnit | str, path: Path
) -> None:
    """Draw a value of every orientation of a grid as a coloured square, grey without a value.

    Args:
        values: by roll and pitch in degrees; None: no value.
        title: what the value is.
        unit: unit of the values.
        path: the file; its ending says the format.

    Raises:
        InvalidValueError: the file cannot be of that name, or there is no orientation.
    """
    if not values:
        raise InvalidValueError("orientations to plot", 0, "one at least")
    import numpy as np
    from matplotlib import colormaps

    rolls, pitches = (sorted({tilt[axis] for tilt in values}) for axis in (0, 1))
    squares = np.full((len(pitches), len(rolls)), np.nan)
    for (roll, pitch), value in values.items():
        if value is not None:
            squares[pitches.index(pitch), rolls.index(roll)] = value
    with _figure(path, (6.4, 5.4)) as figure:
        axes = figure.add_subplot()
        colours = colormaps["viridis"].with_extremes(bad=_NONE)
        drawn = axes.pcolormesh(
            _edges(rolls), _edges(pitches), np.ma.masked_invalid(squares), cmap=colours, edgecolors="white"
        )
        axes.set_facecolor(_NONE)
        axes.set_aspect("equal")
        axes.set_title(title)
        axes.set_xlabel("roll (deg)")
        axes.set_ylabel("pitch (deg)")
        if max(len(rolls), len(pitches)) <= MOST_TICKS:
            axes.set_xticks(rolls)
            axes.set_yticks(pitches)
        if np.isfinite(squares).any():
            figure.colorbar(drawn, ax=axes, label=f"{title} ({unit})")
        if np.isnan(squares).any():
            axes.fill([], [], color=_NONE, label="none")
            _legend(figure, axes)


@contextmanager
def _figure(path: Path, size_in: tuple[float, float]) -> Iterator[Figure]:
    """A figure, which is written to the file on leaving."""
    check_plot_file(path)
    # Imported late: it takes a while, and most commands draw nothing.
    from matplotlib import rc_context
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as NewFigure

    # With a salt of its own, the same figure is the same file.
    with rc_context(
        {"svg.hashsalt": "threadstate", "font.size": 10.0, "axes.spines.top": False, "axes.spines.right": False}
    ):
        figure = NewFigure(figsize=size_in, layout="constrained")
        FigureCanvasAgg(figure)
        yield figure
        kind = path.suffix.lower().removeprefix(".")
        # Without a date, and without the version of what drew it.
        metadata = {"Date": None, "Creator": None} if kind == "svg" else {"Software": None}
        figure.savefig(path, format=kind, dpi=_DOTS_PER_INCH, metadata=metadata)


def _within_turn(windows: Sequence[WindowDocument]) -> Iterator[tuple[float, float]]:
    """The windows' phases in [0, 360]; one that goes on past 360 is two stretches."""
    for window in windows:
        start = window.enter % TURN_DEG
        end = start + window.width
        yield start, min(end, TURN_DEG)
        if end > TURN_DEG:
            yield 0.0, end - TURN_DEG


def _legend(figure: Figure, axes: Axes) -> None:
    """A legend below the axes, each label once."""
    handles = {label: handle for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)}
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=3, frameon=False)


def _edges(tilts: Sequence[float]) -> list[float]:
    """The borders of the squares about ascending tilts: half way between them."""
    if len(tilts) == 1:
        return [tilts[0] - 0.5, tilts[0] + 0.5]
    inner = [0.5 * (low + high) for low, high in pairwise(tilts)]
    return [1.5 * tilts[0] - 0.5 * tilts[1], *inner, 1.5 * tilts[-1] - 0.5 * tilts[-2]]
