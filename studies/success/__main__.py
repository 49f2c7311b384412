"""``make success``: success maps of the default device; writes the end of docs/success.md and its pictures.

The maps are kept in files below ``data/success``, so that an interrupted run goes on, and one that was done is read.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Sequence
from pathlib import Path

from studies.success.page import HEADING, picture_name, pictured, section, share_picture
from studies.success.study import PHASES, StudiedMap, studied_inputs
from worker.success.run import computed_map_with_progress

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "success.md"


def main() -> None:
    """Compute the maps, write the section and the pictures."""
    parser = argparse.ArgumentParser(prog="python -m studies.success", description=__doc__)
    parser.add_argument("--workers", type=int, default=2, help="processes [%(default)s]")
    parser.add_argument("--into", type=Path, default=ROOT / "data" / "success", help="folder of maps [data/success]")
    parser.add_argument(
        "--friction-phases", type=int, default=PHASES, help="starting phases with friction [%(default)s]"
    )
    arguments = parser.parse_args()
    arguments.into.mkdir(parents=True, exist_ok=True)
    maps: list[StudiedMap] = []
    for inputs in studied_inputs(arguments.friction_phases):
        path = arguments.into / f"{inputs.strategy.value}-{inputs.sha256[:12]}.map"
        is_new, began = not path.exists(), time.monotonic()
        found = computed_map_with_progress(inputs, arguments.workers, path)
        minutes = math.ceil((time.monotonic() - began) / 60.0)
        duration = f"{minutes} min with {arguments.workers} {'processes' if arguments.workers > 1 else 'process'}"
        maps.append(StudiedMap(inputs, found.orientations, duration if is_new else ""))
        _write(maps)


def _write(maps: Sequence[StudiedMap]) -> None:
    """Write the section and the pictures, of the maps that there are so far."""
    text = PAGE.read_text()
    head = text[: text.index(HEADING)] if HEADING in text else f"{text}\n"
    PAGE.write_text(head + section(maps))
    folder = PAGE.with_suffix("")
    folder.mkdir(exist_ok=True)
    for one in pictured(maps):
        (folder / f"{picture_name(one)}.svg").write_text(share_picture(one))


if __name__ == "__main__":
    main()
