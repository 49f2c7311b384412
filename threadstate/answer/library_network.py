"""A library's histories and what follows from them, each made when it is first needed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from sqlalchemy import Connection

from threadstate.answer.documents import FormationSummaryDocument, NetworkSummaryDocument
from threadstate.answer.networks import formation_summaries, summary_document
from threadstate.answer.tilts import TiltChanges
from threadstate.archive.read import stored_histories
from threadstate.archive.stored import StoredHistories
from threadstate.errors import NotFoundError
from threadstate.history.heights import Heights
from threadstate.library.read import LibraryRecord, not_on_the_grid
from threadstate.library.stored_inputs import library_options, library_pair
from threadstate.network.cells import CellMap
from threadstate.network.export import dot, graphml, node_link_json
from threadstate.network.graph import ConstraintNetwork, constraint_network
from threadstate.network.transitions import Transition, transitions
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair


@dataclass(frozen=True)
class LibraryNetwork:
    """A library's histories, and what follows from them, made when it is first needed."""

    library: LibraryRecord
    histories: StoredHistories

    @cached_property
    def pair(self) -> Pair:
        """The pair of the library."""
        return library_pair(self.library)

    @cached_property
    def options(self) -> SolveOptions:
        """The options of the library's solver."""
        return library_options(self.library)

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
        """Heights against phase by orientation, as far as they were asked for."""
        return {}

    @cached_property
    def tilts(self) -> TiltChanges:
        """What tilts change, as far as it was asked for."""
        return TiltChanges(self.histories, self.pair, self.options)

    @cached_property
    def summary(self) -> NetworkSummaryDocument:
        """The size of the network."""
        return summary_document(self.network, sum(len(one.windows) for one in self.histories.orientations))

    @cached_property
    def formations(self) -> list[FormationSummaryDocument]:
        """Every formation in few words."""
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

    def orientation(self, roll_deg: float, pitch_deg: float) -> int:
        """The number of an orientation.

        Raises:
            NotFoundError: it is none of the library's grid.
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
            f"library {library.id}, by the {library.method} method, has no histories; those by the exact method have"
        )
    return LibraryNetwork(library, histories)
