"""``make settle``: settled states checked apart from the solver; writes docs/settle-checked.md."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.settle.page import page
from studies.settle.study import Amount, Found, Part, done, tasks
from studies.stability.findings import in_order, workers

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Do the work; the page is written again after each piece of it, with what is found until then."""
    parser = argparse.ArgumentParser(prog="python -m studies.settle", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--random", type=int, default=10_000, help="random commands [%(default)s]")
    parser.add_argument("--beside", type=int, default=300, help="minima searched for from beside [%(default)s]")
    parser.add_argument("--followed", type=int, default=30, help="pushes followed by the brute force [%(default)s]")
    parser.add_argument("--centres", type=int, default=2600, help="commands of which 20 changes are made [%(default)s]")
    chosen = parser.parse_args()
    found = {part: Found() for part in Part}
    to_do = list(tasks(Amount(chosen.random, chosen.beside, chosen.followed, chosen.centres)))
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        for task, result in zip(to_do, in_order(pool, done, to_do, progress, "settled states"), strict=True):
            found[task.part].add(result)
            (chosen.into / "settle-checked.md").write_text(page(found))


if __name__ == "__main__":
    main()
