"""Writes what the stored library says to designers: the session in the README and docs/windows.md (``make designer``).

Commands are run on the database of the settings, whose latest library has to be that of the default grid.
"""

from __future__ import annotations

import contextlib
import io
import re
import shlex
from dataclasses import dataclass
from itertools import product
from pathlib import Path

from threadstate.answer.documents import SnapDocument, WindowDocument
from threadstate.answer.library_network import LibraryNetwork
from threadstate.answer.windows import windows_of_histories
from threadstate.library.engine import reader_engine
from threadstate.library.read import states_between
from threadstate.settings import read_settings
from threadstate.state.model import ContactState, FeaturePair
from worker.cli import run_command_line
from worker.stored_network import stored_network

ROOT = Path(__file__).parent.parent
README, PAGE = ROOT / "README.md", ROOT / "docs" / "windows.md"
SESSION = re.compile(r"(<!-- designer -->\n).*?(<!-- /designer -->)", re.DOTALL)
LEFT_OUT = "contacts"
"""The last column of tables, whose words wrap: what stands under it is not shown."""
EDGES = (FeaturePair.EDGE_EDGE, FeaturePair.EDGE_SURFACE)


@dataclass(frozen=True)
class Question:
    """What a designer wants to know, the command that answers, and how many lines of the answer are shown."""

    words: str
    command: str
    first: int = 40
    last: int = 0


QUESTIONS = (
    Question(
        "The device holds the bolt with 4 deg of roll; the phase is not known. Where can it fall into the thread?",
        "threadstate windows --roll 4 --pitch 0",
    ),
    Question(
        "A window 7.4 deg wide, without a snap: at this tilt the bolt slides in on the thread and climbs by the lead\n"
        "at once. With a pitch of -4 deg and no roll it is another thing:",
        "threadstate windows --roll 0 --pitch -4",
    ),
    Question(
        "That snap is felt: 0.0075 in at one phase. Back to 4 deg of roll. What is felt before? The sensor says: the\n"
        "bolt's crest on the nut's surface, and flush.",
        "threadstate locate --class stable_three_point --flag flush --contact 1:crest:surface:edge-surface",
    ),
    Question(
        "So the pitch is 0 and the phase is not near 0. How far must the bolt turn at most, and through which states\n"
        "must the device carry it? (Contacts, in words, are left out here.)",
        "threadstate path --from 12b904af6f --roll 4 --pitch 0",
        first=8,
        last=6,
    ),
)


def main() -> None:
    """Write the session and the page."""
    session = "\n".join(_asked(question) for question in QUESTIONS)
    README.write_text(SESSION.sub(lambda found: f"{found[1]}{session}{found[2]}", README.read_text()))
    PAGE.write_text(_page(stored_network(None)))


def _asked(question: Question) -> str:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        code = run_command_line(shlex.split(question.command)[1:])
    assert code == 0, question.command
    lines = [line.rstrip() for line in printed.getvalue().splitlines()]
    width = next((line.index(LEFT_OUT) for line in lines if line.endswith(LEFT_OUT)), None)
    lines = [line[:width].rstrip() for line in lines if line[:width].strip()]
    if len(lines) > question.first + question.last:
        lines = [*lines[: question.first], "...", *lines[len(lines) - question.last :]]
    return f"{question.words}\n\n```\n$ {question.command}\n" + "\n".join(lines) + "\n```\n"


def _page(network: LibraryNetwork) -> str:
    unit = network.pair.unit
    rows = windows_of_histories(network.histories, None, None, network.pair.thread_pitch, 1.0)
    table = "\n".join(_row(one) for one in rows)
    snaps = "\n".join(_snap_row(one.roll, one.pitch, one.snap) for one in rows if one.snap is not None)
    worst, compared = _mirrored(network)
    summary = network.summary
    return f"""# Clearance windows and snaps

`make designer` writes this page from the latest library ({network.pair.designation}, {summary.orientations}
orientations, lengths in {unit}, angles in degrees). A window is where the first contact of a bolt turned
counter-clockwise is on a thread: no point of its edge is stopped by the nut's surface or edge any more. The snap is the
largest fall of the bolt at one phase; where there is none, the bolt slides into the window and its height does not jump
([decision 7](decisions/0007-history.md)).

| roll | pitch | enter | leave | width | drop | climb | snap at | falls by |
|---|---|---|---|---|---|---|---|---|
{table}

## Heights of the snaps

The bolt's height at first contact as its phase nears the snap from either side. Before it the height falls as the root
of the phase that is left, up to where two contacts of edge on edge meet: phase and height there are solved for. Errors
are estimates: of what round-off does, and of what the height changes within the bracket behind the snap.

| roll | pitch | snap at | error | before | behind | error |
|---|---|---|---|---|---|---|
{snaps}

## Symmetries

Each outline is its own mirror image, the threads have a hand. So the height of first contact at (roll, pitch, phase)
is that at (roll, -pitch, -phase) where edges alone decide it, and nothing else is symmetric: not windows, nor snaps,
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


def _row(one: WindowDocument) -> str:
    snap = ("", "") if one.snap is None else (f"{one.snap.phase:.6f}", f"{one.snap.fall:.6f}")
    phases = (f"{one.enter:.6f}", f"{one.leave:.6f}", f"{one.width:.3f}")
    cells = (f"{one.roll:g}", f"{one.pitch:g}", *phases, f"{abs(one.drop):.6f}", f"{abs(one.climb):.6f}", *snap)
    return "| " + " | ".join(cells) + " |"


def _snap_row(roll: float, pitch: float, snap: SnapDocument) -> str:
    assert snap.height_uncertainty is not None
    sides = (f"{snap.height_before:.12f}", f"{snap.height_after:.12f}", f"{snap.height_uncertainty:.0e}")
    cells = (f"{roll:g}", f"{pitch:g}", f"{snap.phase:.10f}", f"{snap.phase_uncertainty:.0e}", *sides)
    return "| " + " | ".join(cells) + " |"


def _mirrored(network: LibraryNetwork) -> tuple[float, int]:
    """The largest difference of heights between poses and their mirror images, and how many were compared."""
    grid = network.library.grid
    engine = reader_engine(read_settings().database)
    with engine.connect() as connection:
        states = states_between(connection, network.library.id, 0, grid.state_count - 1)
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
