"""``make chamfer``: what a chamfer changes of first contacts; writes docs/chamfer.md and its pictures."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.chamfer.page import course_picture, page, window_picture
from studies.chamfer.study import STEP_DEG, done, gathered, tasks
from studies.stability.findings import in_order, workers

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Compute all courses, write the page and the pictures."""
    parser = argparse.ArgumentParser(prog="python -m studies.chamfer", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    parser.add_argument("--step", type=float, default=STEP_DEG, help="step of the phase in deg [%(default)s]")
    chosen = parser.parse_args()
    to_do = tasks(step_deg=chosen.step)
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        courses = list(in_order(pool, done, to_do, progress, "chamfer"))
    found = gathered(to_do, courses)
    pictures = chosen.into / "chamfer"
    pictures.mkdir(parents=True, exist_ok=True)
    (chosen.into / "chamfer.md").write_text(page(found, chosen.step))
    (pictures / "windows.svg").write_text(window_picture(found))
    (pictures / "courses.svg").write_text(course_picture(found))


if __name__ == "__main__":
    main()
