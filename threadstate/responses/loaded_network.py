"""A library's network under a load: its cells cut where the verdict changes, its transitions marked."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock

from threadstate.network.cells import CellMap
from threadstate.network.graph import ConstraintNetwork
from threadstate.network.loaded import Mark, Part, loaded_cells, transition_mark
from threadstate.network.transitions import Transition
from threadstate.state.options import SolveOptions
from threadstate.statics.load import Load
from threadstate.statics.stretches import LoadedOrientation
from threadstate.thread.pair import Pair


@dataclass(frozen=True)
class LoadedNetwork:
    """The cells of a library's network under a load at a friction; those of an orientation are solved when needed."""

    network: ConstraintNetwork
    pair: Pair
    options: SolveOptions
    load: Load
    mu: float
    _lock: Lock = field(default_factory=Lock, compare=False, repr=False)

    @cached_property
    def cell_map(self) -> CellMap:
        """The cells, cut where the verdict changes."""
        cell_map = self.network.cell_map
        return loaded_cells(cell_map, [self.parts(number) for number in range(cell_map.orientation_count)])

    def parts(self, orientation: int) -> list[list[Part]]:
        """The parts of the cells of an orientation; each is solved once, whoever asks."""
        with self._lock:
            return self._solved_parts(orientation)

    def _solved_parts(self, orientation: int) -> list[list[Part]]:
        if orientation not in self._parts:
            cells = self.network.cell_map.cells[orientation]
            tilt = self.network.cell_map.tilt_deg(orientation)
            solved = LoadedOrientation(self.pair, self.options, *tilt, self.load)
            stretches = solved.stretches([(cell.start_deg, cell.end_deg) for cell in cells], self.mu)
            self._parts[orientation] = [
                [(one.start_deg, one.end_deg, one.verdict) for one in of_cell] for of_cell in stretches
            ]
        return self._parts[orientation]

    def mark(self, one: Transition) -> Mark:
        """The mark of a transition of the network."""
        return transition_mark(one, self.parts(one.source.orientation)[one.source.position])

    @cached_property
    def _parts(self) -> dict[int, list[list[Part]]]:
        return {}
