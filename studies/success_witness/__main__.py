"""``make success-witness``: cells of success maps beside a brute force; writes docs/success-witness.md."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.stability.findings import in_order, workers
from studies.success_witness.page import page
from studies.success_witness.study import Compared, done

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Compute the cells; the page is written again after each of them, with what is found until then."""
    parser = argparse.ArgumentParser(prog="python -m studies.success_witness", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--cells", type=int, default=140, help="cells of success maps [%(default)s]")
    chosen = parser.parse_args()
    cells: list[Compared] = []
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        for result in in_order(pool, done, list(range(chosen.cells)), progress, "cells"):
            cells.append(result)
            (chosen.into / "success-witness.md").write_text(page(cells))


if __name__ == "__main__":
    main()
