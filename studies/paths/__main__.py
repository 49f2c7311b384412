"""``make paths``: paths checked by shorter steps, and those with friction by energy; writes docs/paths-checked.md."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.paths.changes import turned
from studies.paths.page import page
from studies.paths.study import Found, done
from studies.stability.findings import in_order, workers

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Follow the paths; the page is written again after each of them, with what is found until then."""
    parser = argparse.ArgumentParser(prog="python -m studies.paths", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--paths", type=int, default=300, help="paths with friction [%(default)s]")
    parser.add_argument("--frictionless", type=int, default=500, help="paths without friction [%(default)s]")
    parser.add_argument("--turn", type=float, default=270.0, help="degrees that each is turned [%(default)s]")
    chosen = parser.parse_args()
    found = Found(chosen.turn)
    to_do = [(number, chosen.turn) for number in range(chosen.paths)]
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        for pose in in_order(pool, turned, range(chosen.frictionless), progress, "paths without friction"):
            found.frictionless.append(pose)
        (chosen.into / "paths-checked.md").write_text(page(found))
        for result in in_order(pool, done, to_do, progress, "paths with friction"):
            found.add(result)
            (chosen.into / "paths-checked.md").write_text(page(found))


if __name__ == "__main__":
    main()
