"""``make statics``: what a push does to the states of the default library; writes docs/statics.md and its maps."""

from __future__ import annotations

from pathlib import Path

from studies.stability.maps import drawn
from studies.statics.maps import MAPS, map_rows
from studies.statics.page import MU, page
from studies.statics.study import KINDS, before_snaps, pushed_states, verdict_counts
from threadstate.library.grid import Grid
from threadstate.statics.load import Load
from threadstate.statics.reaction import reaction_of
from threadstate.thread.catalogue import quarter_twenty_unc

DOCS = Path(__file__).parents[2] / "docs"
FRICTIONS = (0.0, 0.1, 0.2, 0.4)
PUSH = Load(force=(0.0, 0.0, -10.0))
EVERY = 10


def main() -> None:
    """Solve the grid, write the page and the maps."""
    pair, grid = quarter_twenty_unc(), Grid()
    states = pushed_states(pair, grid)
    apart = [one for one in states if not one.penetrating]
    reactions: dict[str, list[float]] = {kind: [] for kind in KINDS}
    for one in states[::EVERY]:
        if one.hold > MU:
            reactions[one.kind].append(reaction_of(pair, one.state, None, MU).size)
    text = page(
        [verdict_counts(states, mu) for mu in FRICTIONS],
        [verdict_counts(apart, mu) for mu in FRICTIONS],
        states,
        reactions,
        before_snaps(pair, grid, PUSH, MU),
    )
    (DOCS / "statics.md").write_text(text)
    for chart in MAPS:
        (DOCS / "statics" / f"{chart.name}.svg").write_text(drawn(chart, map_rows(states)))


if __name__ == "__main__":
    main()
