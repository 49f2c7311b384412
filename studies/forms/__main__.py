"""``make forms``: forms of threads beside the brute force and under perturbation; writes docs/forms-checked.md."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.forms.page import page
from studies.forms.study import FORMS, Amount, Found, done, tasks
from studies.stability.findings import in_order, workers

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Do the work and write the page."""
    parser = argparse.ArgumentParser(prog="python -m studies.forms", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--heights", type=int, default=1000, help="poses of each form [%(default)s]")
    parser.add_argument("--turns", type=int, default=200, help="of them with their turns [%(default)s]")
    parser.add_argument("--centres", type=int, default=68, help="poses that are changed [%(default)s]")
    chosen = parser.parse_args()
    amount = Amount(chosen.heights, chosen.turns, chosen.centres)
    found = [Found() for _ in FORMS]
    to_do = list(tasks(amount))
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        for task, result in zip(to_do, in_order(pool, done, to_do, progress, "forms"), strict=True):
            found[task.form].add(result)
    (chosen.into / "forms-checked.md").write_text(page(FORMS, found))


if __name__ == "__main__":
    main()
