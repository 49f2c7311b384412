"""``make stability``: runs the study and writes its page, its maps and the list of its failures."""

from __future__ import annotations

import argparse
from pathlib import Path

from studies.methods import ExactMethod
from studies.stability.findings import Extent, Findings, findings
from studies.stability.maps import DECADE_MAP, MAPS, drawn
from studies.stability.page import FOLDER, page
from studies.stability.page_exact import failures_csv
from studies.stability.page_methods import decade_rows, descents_csv, wrong_csv
from threadstate.library.grid import Grid
from threadstate.thread.catalogue import quarter_twenty_unc

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Run the study and write its results."""
    parser = argparse.ArgumentParser(prog="python -m studies.stability", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--lines", type=int, default=72, help="orientations searched for events [%(default)s]")
    parser.add_argument("--degrees", type=int, default=360, help="of phase searched on each [%(default)s]")
    parser.add_argument("--centres", type=int, default=40, help="the most in a hard place [%(default)s]")
    parser.add_argument("--tilt-max", type=float, default=4.0, help="of the grid, in degrees [%(default)s]")
    parser.add_argument("--phase-step", type=float, default=1.0, help="of the grid, in degrees [%(default)s]")
    chosen = parser.parse_args()
    grid = Grid(tilt_max_deg=chosen.tilt_max, phase_step_deg=chosen.phase_step)
    extent = Extent(chosen.lines, chosen.degrees, chosen.centres, grid)
    found = findings(ExactMethod(), quarter_twenty_unc(), extent, chosen.processes)
    write(found, chosen.into)


def write(found: Findings, into: Path) -> None:
    """The page, its maps and its lists."""
    folder = into / FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    (into / "stability.md").write_text(page(found))
    (folder / "failures.csv").write_text(failures_csv(found))
    (folder / "wrong-meshes.csv").write_text(wrong_csv(found))
    (folder / "descents.csv").write_text(descents_csv(found))
    (folder / f"{DECADE_MAP.name}.svg").write_text(drawn(DECADE_MAP, decade_rows(found)))
    for chart in MAPS:
        (folder / f"{chart.name}.svg").write_text(drawn(chart, found.rows))


if __name__ == "__main__":
    main()
