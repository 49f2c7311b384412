"""The style of the studies' pictures, and their SVG: the same figure gives the same bytes."""

from __future__ import annotations

from collections.abc import Callable
from io import StringIO
from typing import Any

from matplotlib import rc_context
from matplotlib.figure import Figure

INK, FAINT, GRID = "#1d2733", "#5c6875", "#e3e7ec"

STYLE: dict[Any, Any] = {
    "axes.axisbelow": True,
    "axes.edgecolor": GRID,
    "axes.grid": True,
    "axes.labelcolor": FAINT,
    "axes.titlecolor": INK,
    "axes.titlelocation": "left",
    "axes.titleweight": "bold",
    "figure.constrained_layout.h_pad": 0.1,
    "figure.constrained_layout.w_pad": 0.1,
    "font.size": 10.0,
    "grid.color": GRID,
    "legend.frameon": False,
    "svg.fonttype": "none",  # text stays text
    "svg.hashsalt": "threadstate",
    "text.color": INK,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
}


def picture(size_in: tuple[float, float], title: str, draw: Callable[[Figure], None]) -> str:
    """What ``draw`` draws into a figure of that size (inches), as SVG."""
    with rc_context(STYLE):
        figure = Figure(figsize=size_in, layout="constrained")
        draw(figure)
        file = StringIO()
        # Without a date, and without the version of what drew it.
        figure.savefig(file, format="svg", metadata={"Title": title, "Date": None, "Creator": None})
    return file.getvalue()
