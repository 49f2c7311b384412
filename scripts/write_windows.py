"""Writes docs/windows.md from the stored library (``make designer``).

It is the library of 1/4-20 UNC of the database of the settings, which has to be that of the default grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from pathlib import Path
from textwrap import fill

from threadstate.library.engine import reader_engine
from threadstate.library.read import states_between
from threadstate.responses.documents import JumpDocument, OrientationWindowsDocument, SnapDocument, WindowDocument
from threadstate.responses.library_network import LibraryNetwork
from threadstate.responses.windows import windows_of_histories
from threadstate.settings import read_settings
from threadstate.state.model import ContactState, FeaturePair
from worker.library_source import stored_network

PAGE = Path(__file__).parent.parent / "docs" / "windows.md"
WIDTH = 120
LIBRARY = "1-4-20-unc"
"""The library that the page is about."""
EDGES = (FeaturePair.EDGE_EDGE, FeaturePair.EDGE_SURFACE)


def main() -> None:
    """Write the page."""
    network = stored_network(None, LIBRARY)
    rows = windows_of_histories(network.histories, None, None, network.pair, 1.0)
    PAGE.write_text(page(network, rows))


def page(network: LibraryNetwork, rows: Sequence[OrientationWindowsDocument]) -> str:
    """The page of falls and windows as Markdown."""
    unit = network.pair.unit
    falls = "\n".join(_row(one) for one in rows)
    windows = "\n".join(_window_row(window) for one in rows for window in one.windows)
    descents = [(one, descent) for one in rows for descent in one.descents]
    jumps = "\n".join(_jump_row(one.roll, one.pitch, jump) for one, descent in descents for jump in descent.jumps)
    snaps = [one.snap for one in rows if one.snap is not None]
    smooth, partly = (sum(test(snap) for snap in snaps) for test in (_has_no_jump, _jumps_by_less_than_half))
    uncertain = max(descent.fall_uncertainty for _, descent in descents)
    opening = (
        f"`make designer` writes this page from the latest library ({network.pair.designation}, "
        f"{network.summary.orientations} orientations, lengths in {unit}, angles in degrees). All is about a bolt "
        "turned counter-clockwise, and about the height of its first contact ([decision 17](decisions/0017-falls.md))."
    )
    counts = (
        f"{len(snaps)} of the {network.summary.orientations} orientations snap, by up to "
        f"{max(snap.fall for snap in snaps):.6f} {unit}. In {smooth} of these snaps nothing jumps, in {partly} more "
        f"the jump is less than half of the fall. No descent's fall is uncertain by more than {uncertain:.0e} {unit}."
    )
    worst, compared = _mirrored(network)
    summary = network.summary
    return f"""# Falls, snaps and clearance windows

{fill(opening, WIDTH)}

- A **descent** is a longest stretch of phase over which the height does not rise, from where it first falls to where it
  last does. Its **fall** is the height at its beginning less that at its end.
- A **jump** is the part of a fall that happens at one phase.
- The **steepest** fall is the largest within 3 deg of phase.
- The **snap** is the descent that holds the steepest fall, where that exceeds 5 % of the thread pitch. Its figures
  are those of the whole descent, and beside them the largest jump within it.

A phase above 360 is that of the next turn.

{fill(counts, WIDTH)}

| roll | pitch | steepest | from | snap from | to | fall | jump | jump at |
|---|---|---|---|---|---|---|---|---|
{falls}

## Clearance windows

A window is where the first contact is on a thread: no point of the bolt's edge is stopped by the nut's surface or edge
any more ([decision 7](decisions/0007-history.md)). It says where the bolt can go on down, not how far it falls; the
climb is from its lowest height to that at the exit.

| roll | pitch | enter | leave | width | climb |
|---|---|---|---|---|---|
{windows}

## Jumps

The bolt's height as its phase nears a jump from either side. Where the jump is at the end of two contacts of edge on
edge that meet, the height falls before it as the root of the phase that is left: phase and height there are solved
for. Errors are estimates: of what round-off does, and of what the height changes within the bracket of the jump.

| roll | pitch | jump at | error | before | behind | error | fall |
|---|---|---|---|---|---|---|---|
{jumps}

## Symmetries

Each outline is its own mirror image, the threads have a hand. So the height of first contact at (roll, pitch, phase)
is that at (roll, -pitch, -phase) where edges alone decide it, and nothing else is symmetric: not windows, nor falls,
nor what follows the first contact. On the library's grid: of {compared:,} poses whose first contact, and that of the
mirrored pose, is edge on edge or edge on surface, the largest difference of heights is {worst:.1e} {unit}.

## The network

- {summary.formations:,} formations in {summary.intervals:,} intervals, {summary.edges:,} edges.
- With all moves it is {_parts(summary.strong_parts)}.
- Dead ends, from which turning counter-clockwise meets no window: {len(summary.dead_ends)}. Each of the orientations
  has a window, and turning passes every phase.
- Cut formations, without which the network falls apart: {len(summary.cut_formations)}. Tilting leads around every one.
- {len(summary.telling_formations)} formations occur at one orientation alone: who sees one of them knows the tilt.
"""


def _parts(sizes: list[int]) -> str:
    return "one strongly connected part" if len(sizes) == 1 else f"{len(sizes)} strongly connected parts, of {sizes}"


def _has_no_jump(snap: SnapDocument) -> bool:
    return snap.jump_at is None


def _jumps_by_less_than_half(snap: SnapDocument) -> bool:
    return snap.jump_at is not None and snap.jump < 0.5 * snap.fall


def _row(one: OrientationWindowsDocument) -> str:
    steepest_from = "" if one.steepest_from is None else f"{one.steepest_from:.6f}"
    cells = [f"{one.roll:g}", f"{one.pitch:g}", f"{one.steepest:.6f}", steepest_from]
    if one.snap is None:
        return _cells(*cells, "", "", "", "", "")
    snap = one.snap
    jump_at = "" if snap.jump_at is None else f"{snap.jump_at:.6f}"
    return _cells(*cells, f"{snap.start:.6f}", f"{snap.end:.6f}", f"{snap.fall:.6f}", f"{snap.jump:.6f}", jump_at)


def _window_row(one: WindowDocument) -> str:
    phases = (f"{one.enter:.6f}", f"{one.leave:.6f}", f"{one.width:.3f}")
    return _cells(f"{one.roll:g}", f"{one.pitch:g}", *phases, f"{abs(one.climb):.6f}")


def _jump_row(roll: float, pitch: float, jump: JumpDocument) -> str:
    sides = (f"{jump.height_before:.12f}", f"{jump.height_after:.12f}", f"{jump.height_uncertainty:.0e}")
    phase = (f"{jump.phase:.10f}", f"{jump.phase_uncertainty:.0e}")
    return _cells(f"{roll:g}", f"{pitch:g}", *phase, *sides, f"{jump.fall:.6f}")


def _cells(*cells: str) -> str:
    return "| " + " | ".join(cells) + " |"


def _mirrored(network: LibraryNetwork) -> tuple[float, int]:
    """The largest difference of heights between poses and their mirror images, and how many were compared."""
    grid = network.library.grid
    engine = reader_engine(read_settings().database)
    with engine.connect() as connection:
        states = states_between(connection, network.library.id, 0, grid.pose_count - 1)
    engine.dispose()
    by_pose = {(state.roll_deg, state.pitch_deg, state.phase_deg): state for state in states}
    worst, compared = 0.0, 0
    for roll, pitch, phase in product(grid.tilts_deg, grid.tilts_deg, grid.phases_deg):
        one, other = by_pose[roll, pitch, phase], by_pose.get((roll, -pitch + 0.0, (360.0 - phase) % 360.0))
        if other is not None and _on_edges(one) and _on_edges(other):
            compared += 1
            worst = max(worst, abs(one.poses[0].translation[2] - other.poses[0].translation[2]))
    return worst, compared


def _on_edges(state: ContactState) -> bool:
    return state.contacts[0].features in EDGES


if __name__ == "__main__":
    main()
