"""``make certainty``: what a surer search of thread on thread costs; writes docs/certainty.md and its picture."""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.progress import track

from studies.certainty.page import chart, page
from studies.certainty.study import SETTINGS, compared, drawn_poses, solved

DOCS = Path(__file__).parents[2] / "docs"


def main() -> None:
    """Solve the same poses with every setting, and compare."""
    parser = argparse.ArgumentParser(prog="python -m studies.certainty", description=__doc__)
    parser.add_argument("--poses", type=int, default=6000, help="poses of each pair [%(default)s]")
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    chosen = parser.parse_args()
    poses = drawn_poses(chosen.poses)
    found = {}
    with TemporaryDirectory() as folder:
        for i, setting in enumerate(track(SETTINGS, "settings", console=Console(stderr=True))):
            found[setting.name] = solved(setting, poses, Path(folder) / str(i))
    results = compared(poses, found)
    (chosen.into / "certainty.md").write_text(page(results))
    (chosen.into / "certainty.svg").write_text(chart(results))


if __name__ == "__main__":
    main()
