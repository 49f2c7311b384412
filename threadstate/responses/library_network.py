"""A library's histories and what is derived from them; each derived value is computed once, when it is first needed."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from threading import Lock

from sqlalchemy import Connection

from threadstate.errors import NotFoundError
from threadstate.history.heights import Heights
from threadstate.library.identity import options_of, pair_of
from threadstate.library.read import LibraryRecord, not_on_the_grid
from threadstate.network.cells import CellMap
from threadstate.network.export import dot, graphml, node_link_json
from threadstate.network.graph import ConstraintNetwork, constraint_network
from threadstate.network.transitions import Transition, transitions
from threadstate.responses.documents import FormationSummaryDocument, NetworkSummaryDocument
from threadstate.responses.loaded_network import LoadedNetwork
from threadstate.responses.networks import formation_summaries, summary_document
from threadstate.responses.transitions import TiltChanges
from threadstate.state.options import SolveOptions
from threadstate.statics.load import Load
from threadstate.stored_histories.mapping import stored_histories
from threadstate.stored_histories.model import StoredHistories
from threadstate.thread.pair import Pair

LOADED_KEPT = 4
"""Networks under a load that are kept of a library."""


@dataclass(frozen=True)
class LibraryNetwork:
    """A library's histories and the values derived from them, computed when first needed and cached."""

    library: LibraryRecord
    histories: StoredHistories
    _lock: Lock = field(default_factory=Lock, compare=False, repr=False)

    @cached_property
    def pair(self) -> Pair:
        """The pair of the library."""
        return pair_of(self.library.pair)

    @cached_property
    def options(self) -> SolveOptions:
        """The options of the library's solver."""
        return options_of(self.library.options)

    @cached_property
    def cell_map(self) -> CellMap:
        """The cells of all orientations."""
        return self.histories.cell_map

    @cached_property
    def network(self) -> ConstraintNetwork:
        """The network of the cells."""
        return constraint_network(self.cell_map)

    @cached_property
    def transitions(self) -> tuple[Transition, ...]:
        """All transitions, in order."""
        return transitions(self.cell_map)

    @cached_property
    def curves(self) -> dict[int, Heights]:
        """Cached curves of height against phase, by orientation."""
        return {}

    @cached_property
    def tilts(self) -> TiltChanges:
        """The changes by tilts, cached."""
        return TiltChanges(self.histories, self.pair, self.options)

    @cached_property
    def summary(self) -> NetworkSummaryDocument:
        """The size of the network."""
        return summary_document(self.network, sum(len(one.windows) for one in self.histories.orientations))

    @cached_property
    def formations(self) -> list[FormationSummaryDocument]:
        """A summary of every formation."""
        return formation_summaries(self.network)

    @cached_property
    def node_link(self) -> bytes:
        """The network as node-link JSON."""
        return node_link_json(self.network).encode()

    @cached_property
    def graphml(self) -> bytes:
        """The network as GraphML."""
        return graphml(self.network).encode()

    @cached_property
    def dot(self) -> bytes:
        """The network in Graphviz's language."""
        return dot(self.network).encode()

    def under(self, load: Load, mu: float) -> LoadedNetwork:
        """The network under a load at a friction; the last few are kept."""
        with self._lock:
            if (load, mu) not in self._loaded:
                while len(self._loaded) >= LOADED_KEPT:
                    del self._loaded[next(iter(self._loaded))]
                self._loaded[load, mu] = LoadedNetwork(self.network, self.pair, self.options, load, mu)
            return self._loaded[load, mu]

    @cached_property
    def _loaded(self) -> dict[tuple[Load, float], LoadedNetwork]:
        return {}

    def orientation(self, roll_deg: float, pitch_deg: float) -> int:
        """The number of an orientation.

        Raises:
            NotFoundError: the library's grid does not have it.
        """
        tilts = self.library.grid.tilts_deg
        if roll_deg not in tilts or pitch_deg not in tilts:
            raise not_on_the_grid(self.library, roll_deg, pitch_deg)
        return self.cell_map.orientation(roll_deg, pitch_deg)


def library_network(connection: Connection, library: LibraryRecord) -> LibraryNetwork:
    """The network of a published library.

    Raises:
        NotFoundError: the library has no histories.
    """
    histories = stored_histories(connection, library.id, library.grid)
    if histories is None:
        raise NotFoundError(
            f"library {library.id}, by the {library.method} method, has no histories; "
            "libraries of the exact method have"
        )
    return LibraryNetwork(library, histories)
