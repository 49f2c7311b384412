"""Histories, transitions, windows and networks as text tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

from threadstate.history.falls import SPAN_DEG
from threadstate.numbers import number_text
from threadstate.responses.documents import (
    FallsDocument,
    FallsRangeDocument,
    HeightsDocument,
    HeldDocument,
    LoadedSummaryDocument,
    LocationDocument,
    NetworkSummaryDocument,
    NodeDocument,
    OrientationHistoryDocument,
    OrientationWindowsDocument,
    PathDocument,
    SnapDocument,
    TransitionDocument,
    WindowDocument,
)
from threadstate.units import LengthUnit
from worker.output import print_line
from worker.tables import angle, interval_end, length, phase, table


def print_history(history: OrientationHistoryDocument, unit: LengthUnit) -> None:
    """One row an interval, and what changes where it begins; then the falls and the windows."""
    rows = table("from", "to", "formation", f"height ({unit})", "in window", "begins with", "contacts", words_last=True)
    for i, interval in enumerate(history.intervals):
        begins = history.boundaries[i] if history.boundaries else None
        rows.add_row(
            phase(interval.start),
            interval_end(interval.start, interval.end),
            interval.formation.key,
            length(interval.first_height, unit),
            "yes" if interval.in_window else "",
            "" if begins is None else ", ".join(sorted({kind for one in begins.changes for kind in one.kinds})),
            interval.formation.text,
        )
    rows.print()
    print_line("")
    print_falls([history], unit)
    print_line("")
    print_windows(history.windows, unit)


def print_heights(heights: HeightsDocument, unit: LengthUnit) -> None:
    """One row a phase."""
    rows = table("phase", f"first contact ({unit})", "at rest")
    for at, first, last in zip(heights.phases, heights.first_heights, heights.rest_heights, strict=True):
        # A jump is between two phases that all but coincide.
        rows.add_row(f"{at:.9f}", length(first, unit), length(last, unit))
    rows.print()


def print_falls(orientations: Sequence[FallsDocument], unit: LengthUnit, span: float = SPAN_DEG) -> None:
    """One row an orientation: its snap, and its steepest fall within ``span`` degrees of phase."""
    rows = table(
        "roll",
        "pitch",
        "snap from",
        "to",
        f"falls ({unit})",
        "jumps",
        "at",
        f"steepest in {number_text(span)} deg",
        "from",
    )
    for one in orientations:
        snap = one.snap
        cells = ["-"] * 5
        if snap is not None:
            ends = phase(snap.start), interval_end(snap.start, snap.end)
            cells = [*ends, length(snap.fall, unit), length(snap.jump, unit), phase(snap.jump_at)]
        rows.add_row(
            number_text(one.roll),
            number_text(one.pitch),
            *cells,
            length(one.steepest, unit),
            phase(one.steepest_from),
        )
    rows.print()


@dataclass(frozen=True, slots=True)
class Compared:
    """An orientation of a library beside others; lengths in the unit that all are shown in."""

    library: int
    designation: str
    thread_pitch: float
    found: OrientationWindowsDocument


def print_compared(compared: Sequence[Compared], unit: LengthUnit) -> None:
    """One column an orientation of a library."""
    rows = table("", *(f"{one.designation} (library {one.library})" for one in compared))

    def add(name: str, cell: Callable[[Compared], str]) -> None:
        rows.add_row(name, *(cell(one) for one in compared))

    def of_snap(cell: Callable[[SnapDocument], str]) -> Callable[[Compared], str]:
        return lambda one: "-" if one.found.snap is None else cell(one.found.snap)

    add("roll, pitch (deg)", lambda one: f"{number_text(one.found.roll)}, {number_text(one.found.pitch)}")
    add(f"thread pitch ({unit})", lambda one: length(one.thread_pitch, unit))
    add("snap from (deg)", of_snap(lambda snap: phase(snap.start)))
    add("snap to", of_snap(lambda snap: interval_end(snap.start, snap.end)))
    add(f"snap falls ({unit})", of_snap(lambda snap: length(snap.fall, unit)))
    add(
        "... in thread pitches",
        lambda one: "-" if one.found.snap is None else f"{one.found.snap.fall / one.thread_pitch:.4f}",
    )
    add(f"of it jumps ({unit})", of_snap(lambda snap: length(snap.jump, unit)))
    add("... at (deg)", of_snap(lambda snap: phase(snap.jump_at)))
    add(f"steepest in {number_text(SPAN_DEG)} deg ({unit})", lambda one: length(one.found.steepest, unit))
    add("windows (deg)", lambda one: ", ".join(f"{window.width:.3f}" for window in one.found.windows) or "-")
    rows.print()


def print_falls_range(found: FallsRangeDocument, unit: LengthUnit) -> None:
    """What the tilts within a tolerance give, from least to most."""
    of = f"of {found.tilts} tilts within +-{number_text(found.tolerance)} deg"
    print_line(f"roll {number_text(found.roll)}, pitch {number_text(found.pitch)} deg: {found.snaps} {of} snap")
    rows = table("", "least", "most")
    for name, within, write in (
        (f"steepest ({unit})", found.steepest, partial(length, unit=unit)),
        (f"snap falls ({unit})", found.fall, partial(length, unit=unit)),
        (f"of it jumps ({unit})", found.jump, partial(length, unit=unit)),
        ("snap from", found.snap_from, phase),
        ("snap to", found.snap_to, phase),
    ):
        low, high = within or (None, None)
        rows.add_row(name, write(low), write(high))
    rows.print()


def print_windows(windows: Sequence[WindowDocument], unit: LengthUnit) -> None:
    """One row a window."""
    rows = table("roll", "pitch", "window from", "to", "width", f"climbs ({unit})")
    for one in windows:
        rows.add_row(
            number_text(one.roll),
            number_text(one.pitch),
            phase(one.enter),
            interval_end(one.enter, one.leave),
            f"{one.width:.3f}",
            length(one.climb, unit),
        )
    rows.print()


def print_transitions(transitions: Sequence[TransitionDocument], unit: LengthUnit) -> None:
    """One row a transition."""
    rows = table(
        "move",
        "roll",
        "pitch",
        "phase",
        "to",
        "from",
        "to",
        f"height changes by ({unit})",
        *(["under the load"] if any(one.mark is not None for one in transitions) else []),
        "what changes",
        words_last=True,
    )
    for one in transitions:
        before, after = one.first_height
        rows.add_row(
            one.move.value,
            number_text(one.source.roll),
            number_text(one.source.pitch),
            phase(one.phase),
            interval_end(one.phase, one.phase_end) if one.phase_end != one.phase else "",
            one.source.formation,
            one.target.formation,
            length(None if before is None or after is None else after - before, unit, signed=True),
            *([] if one.mark is None else [one.mark.value]),
            one.text,
        )
    rows.print()


def print_summary(summary: NetworkSummaryDocument) -> None:
    """The size of a network, a line each."""
    for name, value in (
        ("formations", summary.formations),
        ("edges", summary.edges),
        ("intervals", summary.intervals),
        ("orientations", summary.orientations),
        ("windows", summary.windows),
        ("strongly connected parts", len(summary.strong_parts)),
        ("dead ends, counter-clockwise", len(summary.dead_ends)),
        ("cut formations", len(summary.cut_formations)),
        ("formations of one orientation", len(summary.telling_formations)),
    ):
        print_line(f"{name:<32}{value:>8}")


def print_loaded_summary(summary: LoadedSummaryDocument) -> None:
    """What a load does in a network, a line each."""
    for mark, share in summary.shares.items():
        print_line(f"{mark:<32}{100.0 * share:>7.2f} %")
    print_line(f"{'dead ends, counter-clockwise':<32}{len(summary.dead_ends):>8}")


def print_held(held: HeldDocument) -> None:
    """What a load does along the phase at a friction: one row a stretch."""
    print_line(f"roll {number_text(held.roll)}, pitch {number_text(held.pitch)} deg, mu {number_text(held.mu)}")
    rows = table("phase", "to", "verdict")
    for one in held.stretches:
        rows.add_row(phase(one.start), interval_end(one.start, one.end), one.verdict.value)
    rows.print()


def print_node(node: NodeDocument) -> None:
    """A formation, its occurrences and its successors."""
    reach = node.to_window
    print_line(f"{node.formation.key}  {node.formation.text}")
    print_line(f"{100.0 * node.share:.3f} % of all phases, at {node.orientations} orientations")
    print_line(
        f"counter-clockwise: {reach.reaching} of {reach.occurrences} intervals lead to a window, "
        f"after {angle(reach.least)} to {angle(reach.most)} deg"
    )
    rows = table("move", "next formation", "share")
    for one in node.following:
        rows.add_row(one.move.value, one.formation, f"{100.0 * one.share:.2f} %")
    rows.print()


def print_path(path: PathDocument | None, unit: LengthUnit) -> None:
    """One row a step."""
    if path is None:
        print_line("no path: the moves allowed lead to no window")
        return
    margin = f"worst margin {length(path.worst_margin, unit)} {unit}"
    print_line(f"{path.turning:.6f} deg of turning, {path.transitions} transitions, {margin}")
    rows = table("move", "roll", "pitch", "phase", "turned", "margin", "formation", "contacts", words_last=True)
    for step in path.steps:
        rows.add_row(
            "" if step.move is None else step.move.value,
            number_text(step.roll),
            number_text(step.pitch),
            phase(step.phase),
            angle(step.turning),
            length(step.margin, unit),
            step.formation,
            step.text,
        )
    rows.print()


def print_location(location: LocationDocument) -> None:
    """The location: one row per formation, then one row per stretch."""
    print_line(f"{100.0 * location.share:.3f} % of all phases remain, at {location.orientations} orientations")
    formations = table("formation", "share", "contacts", words_last=True)
    for formation in location.formations:
        formations.add_row(formation.key, f"{100.0 * formation.share:.3f} %", formation.text)
    formations.print()
    print_line("")
    rows = table("roll", "pitch", "from", "to", "formation")
    for one in location.stretches:
        end = interval_end(one.start, one.end)
        rows.add_row(number_text(one.roll), number_text(one.pitch), phase(one.start), end, one.formation)
    rows.print()
