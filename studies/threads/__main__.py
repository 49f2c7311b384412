"""``make threads``: windows and falls of standard threads; writes docs/threads-compared.md and its picture."""

from __future__ import annotations

from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from rich.console import Console
from rich.progress import track

from studies.threads.page import page, play_picture
from studies.threads.study import CLASSES, FITS, FORMS, SIZES, looked_at

DOCS = Path(__file__).parents[2] / "docs"
PROCESSES = 2


def main() -> None:
    """Solve all pairs, write the page and the picture."""
    names = list(dict.fromkeys([*CLASSES, *FORMS, *FITS, *SIZES]))
    with ProcessPoolExecutor(PROCESSES, mp_context=get_context("spawn")) as pool:
        found = list(track(pool.map(looked_at, names), "threads", len(names), console=Console(stderr=True)))
    (DOCS / "threads-compared.md").write_text(page(dict(zip(names, found, strict=True))))
    (DOCS / "threads" / "play.svg").write_text(play_picture(found))


if __name__ == "__main__":
    main()
