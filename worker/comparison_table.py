"""Libraries side by side as text tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from threadstate.history.falls import SNAP_PITCHES
from threadstate.numbers import number_text
from threadstate.responses.comparison import ComparedLibraryDocument, ComparedOrientationDocument, SpreadDocument
from threadstate.state.model import StateClass
from worker.tables import table

Cell = Callable[[ComparedLibraryDocument], str]


def print_comparison(libraries: Sequence[ComparedLibraryDocument]) -> None:
    """One column a library; of a number that every orientation has, the median and the range."""
    rows = table("", *(f"{one.designation} (library {one.library})" for one in libraries))

    def add(name: str, cell: Cell) -> None:
        rows.add_row(name, *map(cell, libraries))

    add("thread pitch", lambda one: f"{number_text(one.thread_pitch)} {one.unit}")
    add("axial play (pitches)", lambda one: f"{one.axial_play:.4f}")
    add("orientations with windows", lambda one: f"{one.windows} of {len(one.orientations)}")
    add("window (deg)", lambda one: _spread(one.window, 3))
    add("widest window (deg)", lambda one: _spread(one.widest, 3))
    add("steepest fall (pitches)", lambda one: _spread(one.fall, 4))
    add(f"snaps (fall above {number_text(SNAP_PITCHES)})", lambda one: f"{one.snaps} of {len(one.orientations)}")
    for name in libraries[0].classes:
        add(f"states {name}", partial(_share_of_class, name))
    for i, held in enumerate(libraries[0].held):
        add(f"states that hold at mu {number_text(held.mu)}", partial(_share_held, i))
    add("least mu that holds", lambda one: _spread(one.mu_hold_least, 4))
    add("least mu that wedges", lambda one: _spread(one.mu_wedge_least, 4))
    add("greatest embedment (pitches)", lambda one: _spread(one.embedment_most, 6))
    add("undecided poses", lambda one: f"{one.undecided} of {one.states + one.undecided}")
    rows.print()


def _share_of_class(name: StateClass, one: ComparedLibraryDocument) -> str:
    return _percent(one.classes.get(name))


def _share_held(i: int, one: ComparedLibraryDocument) -> str:
    return _percent(one.held[i].share if one.held else None)


def print_each(libraries: Sequence[ComparedLibraryDocument]) -> None:
    """One row an orientation of any library's grid: its windows in degrees, and its steepest fall in thread pitches."""
    columns = [f"{name} ({one.library})" for one in libraries for name in ("window", "fall")]
    rows = table("roll", "pitch", *columns)
    by_tilt = [{(each.roll, each.pitch): each for each in one.orientations} for one in libraries]
    for tilt in sorted({tilt for one in by_tilt for tilt in one}):
        rows.add_row(*map(number_text, tilt), *(cell for one in by_tilt for cell in _window_and_fall(one.get(tilt))))
    rows.print()


def _window_and_fall(one: ComparedOrientationDocument | None) -> tuple[str, str]:
    return ("-", "-") if one is None else (f"{one.window:.3f}", f"{one.fall:.4f}{' snaps' if one.snaps else ''}")


def _spread(spread: SpreadDocument | None, decimals: int) -> str:
    if spread is None:
        return "-"
    least, median, most = (f"{value:.{decimals}f}" for value in (spread.least, spread.median, spread.most))
    return f"{median} ({least} to {most})"


def _percent(share: float | None) -> str:
    return "-" if share is None else f"{100.0 * share:.2f} %"
