"""``make witness``: the numbers of loaded states beside the witness's; writes docs/statics-witness.md."""

from __future__ import annotations

import argparse
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from itertools import islice
from multiprocessing import get_context
from pathlib import Path

from rich.console import Console
from rich.progress import track

from studies.witness.compare import Compared, Number, Outcome, compare
from studies.witness.page import page
from studies.witness.scenes import Scene, scenes
from threadstate.thread.catalogue import quarter_twenty_unc

PAGE = Path(__file__).parents[2] / "docs" / "statics-witness.md"
CHUNK = 25


def main() -> None:
    """Compare, write the page, and fail where anything is apart."""
    parser = argparse.ArgumentParser(prog="python -m studies.witness", description=__doc__)
    parser.add_argument("--scenes", type=int, default=10_000, help="random states with loads [%(default)s]")
    parser.add_argument("--processes", type=int, default=2, help="[%(default)s]")
    parser.add_argument("--page", type=Path, default=PAGE, help="where the page is written [docs/statics-witness.md]")
    arguments = parser.parse_args()
    some = list(islice(scenes(quarter_twenty_unc()), arguments.scenes))
    found: list[tuple[Scene, list[Compared]]] = []
    with ProcessPoolExecutor(arguments.processes, mp_context=get_context("spawn")) as pool:
        compared = pool.map(compare, some, chunksize=CHUNK)
        for scene, numbers in zip(
            some, track(compared, "witness", len(some), console=Console(stderr=True)), strict=True
        ):
            found.append((scene, numbers))
    arguments.page.write_text(page(found))
    counts = Counter((one.number, one.outcome) for _, numbers in found for one in numbers)
    for number in Number:
        told = ", ".join(f"{counts[number, outcome]:,} {outcome}" for outcome in Outcome if counts[number, outcome])
        print(f"{number}: {told}")
    apart = sum(counts[number, Outcome.APART] for number in Number)
    if apart:
        raise SystemExit(f"{apart} numbers are apart: {arguments.page}")


if __name__ == "__main__":
    main()
