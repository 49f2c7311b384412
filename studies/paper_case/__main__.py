"""``make paper-case``: the paper's case turned by compliant hands; writes docs/paper-case.md and its pictures."""

from __future__ import annotations

import argparse
from pathlib import Path

from rich.console import Console
from rich.progress import Progress

from studies.paper_case.page import limits_picture, page, path_picture
from studies.paper_case.study import (
    CENTRES,
    TILT_STIFFNESSES,
    device,
    limit_of_device,
    shown_paths,
)
from studies.stability.findings import in_order, workers

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Follow the paths, bracket the frictions, write the page."""
    parser = argparse.ArgumentParser(prog="python -m studies.paper_case", description=__doc__)
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    parser.add_argument("--processes", type=int, default=2, help="computing processes [%(default)s]")
    chosen = parser.parse_args()
    by_tilt = [device(k_tilt=stiffness) for stiffness in TILT_STIFFNESSES]
    by_centre = [device(centre=centre) for centre in CENTRES]
    with workers(chosen.processes) as pool, Progress(console=Console(stderr=True)) as progress:
        limits = list(in_order(pool, limit_of_device, [*by_tilt, *by_centre], progress, "devices"))
    tilts = dict(zip(TILT_STIFFNESSES, limits[: len(by_tilt)], strict=True))
    centres = dict(zip(CENTRES, limits[len(by_tilt) :], strict=True))
    shown = shown_paths()
    pictures = chosen.into / "paper-case"
    pictures.mkdir(parents=True, exist_ok=True)
    (pictures / "path.svg").write_text(path_picture(shown))
    (pictures / "limits.svg").write_text(limits_picture(tilts, centres))
    (chosen.into / "paper-case.md").write_text(page(shown, tilts, centres))


if __name__ == "__main__":
    main()
