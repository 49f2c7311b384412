"""``make compared``: success maps of devices, strategies and pairs; writes docs/devices-compared.md and its pictures.

The maps are kept in files below ``data/devices-compared``, so that an interrupted run goes on, and one that was done is
read.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from studies.devices_compared.page import page, pictures
from studies.devices_compared.study import all_inputs
from studies.success.study import StudiedMap
from worker.success.run import computed_map_with_progress

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "devices-compared.md"


def main() -> None:
    """Compute the maps, write the page and the pictures."""
    parser = argparse.ArgumentParser(prog="python -m studies.devices_compared", description=__doc__)
    parser.add_argument("--workers", type=int, default=1, help="processes [%(default)s]")
    parser.add_argument(
        "--into", type=Path, default=ROOT / "data" / "devices-compared", help="folder of maps [data/devices-compared]"
    )
    arguments = parser.parse_args()
    arguments.into.mkdir(parents=True, exist_ok=True)
    maps: dict[str, StudiedMap] = {}
    for inputs in all_inputs():
        path = arguments.into / f"{inputs.strategy.value}-{inputs.sha256[:12]}.map"
        found = computed_map_with_progress(inputs, arguments.workers, path)
        maps[inputs.sha256] = StudiedMap(inputs, found.orientations)
    PAGE.write_text(page(maps))
    folder = PAGE.with_suffix("")
    folder.mkdir(exist_ok=True)
    for name, drawn in pictures(maps).items():
        (folder / f"{name}.svg").write_text(drawn)


if __name__ == "__main__":
    main()
