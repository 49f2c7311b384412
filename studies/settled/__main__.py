"""``make settled``: settled states beside the paper's; writes docs/settled-compared.md and its maps.

Reads the library of settled states of the default pair and device over the default grid, which ``threadstate
rebuild-settled`` makes.
"""

from __future__ import annotations

from pathlib import Path

from studies.settled.maps import MAPS, map_rows
from studies.settled.page import page
from studies.settled.study import compared
from studies.stability.maps import drawn
from threadstate.device.document import device_from_document
from threadstate.device.model import Device, default_device
from threadstate.device.settle import settle_poses
from threadstate.errors import NotFoundError
from threadstate.library.engine import reading
from threadstate.library.grid import Grid
from threadstate.settings import read_settings
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import settled_library_by_input, settled_states_between
from threadstate.state.solve import solve_poses
from threadstate.thread.catalogue import quarter_twenty_unc

DOCS = Path(__file__).parents[2] / "docs"

EVERY_DEG = 30.0
"""The phases at which softer devices are looked at."""
TILT_STIFFNESSES = (500.0, 50.0)
"""In N mm a rad."""


def main() -> None:
    """Read the settled states, solve the paper's, write the page and the maps."""
    pair, grid, device = quarter_twenty_unc(), Grid(), default_device()
    with reading(read_settings().database) as engine, engine.connect() as connection:
        library = settled_library_by_input(connection, SettledInputs(pair, grid, device).sha256)
        if library is None:
            raise NotFoundError("the default library of settled states is missing; run `threadstate rebuild-settled`")
        settled = settled_states_between(connection, library.id, 0, grid.pose_count - 1)
    states = [state for index in range(grid.orientation_count) for state in solve_poses(pair, grid.poses(index))]
    poses = compared(states, settled)
    some = [one.state for one in poses if one.state.phase_deg % EVERY_DEG == 0.0]
    commands = [(one.roll_deg, one.pitch_deg, one.phase_deg) for one in some]
    by_tilt = [(soft, compared(some, settle_poses(pair, commands, soft))) for soft in map(_device, TILT_STIFFNESSES)]
    (DOCS / "settled-compared.md").write_text(page(pair, device, poses, by_tilt))
    (DOCS / "settled").mkdir(exist_ok=True)
    for chart in MAPS:
        (DOCS / "settled" / f"{chart.name}.svg").write_text(drawn(chart, map_rows(poses)))


def _device(k_tilt: float) -> Device:
    return device_from_document({"unit": "mm", "k_tilt": k_tilt})


if __name__ == "__main__":
    main()
