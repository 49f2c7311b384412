"""``make certificate``: audits the bounds that close boxes; writes the last section of docs/certificate.md."""

from __future__ import annotations

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context
from pathlib import Path

from rich.console import Console
from rich.progress import track

from studies.certificate.page import HEADING, section
from studies.certificate.study import Found, audit_some, failures

PAGE = Path(__file__).parents[2] / "docs" / "certificate.md"
CHUNK = 200


def main() -> None:
    """Audit, write the section, and fail where a claim is contradicted."""
    parser = argparse.ArgumentParser(prog="python -m studies.certificate", description=__doc__)
    parser.add_argument("--boxes", type=int, default=100_000, help="boxes [%(default)s]")
    parser.add_argument("--processes", type=int, default=2, help="[%(default)s]")
    parser.add_argument("--page", type=Path, default=PAGE, help="the page whose end is written [docs/certificate.md]")
    arguments = parser.parse_args()
    chunks = -(-arguments.boxes // CHUNK)
    found = Found()
    with ProcessPoolExecutor(arguments.processes, mp_context=get_context("spawn")) as pool:
        for some in track(
            pool.map(partial(audit_some, count=CHUNK), range(chunks)), "audit", chunks, console=Console(stderr=True)
        ):
            found.add(some)
    text = arguments.page.read_text()
    arguments.page.write_text(
        text[: text.index(HEADING)] + section(found) if HEADING in text else text + "\n" + section(found)
    )
    for (name, outcome), count in sorted(found.outcomes.items()):
        print(f"{name}: {count:,} {outcome}")
    if failures(found):
        raise SystemExit(f"{failures(found)} claims are contradicted: {arguments.page}")


if __name__ == "__main__":
    main()
