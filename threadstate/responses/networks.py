"""The constraint network, its formations, paths and locations as documents."""

from __future__ import annotations

from threadstate.network.analysis import (
    WindowReach,
    cut_formations,
    dead_ends,
    following,
    identifying_formations,
    strong_parts,
    window_reach,
)
from threadstate.network.cells import Cell, CellMap
from threadstate.network.changes import difference
from threadstate.network.graph import ConstraintNetwork
from threadstate.network.loaded import Mark, mark_of
from threadstate.network.locate import Location
from threadstate.network.paths import Path
from threadstate.responses.documents import (
    FollowingDocument,
    FormationSummaryDocument,
    LoadedSummaryDocument,
    LocatedFormationDocument,
    LocationDocument,
    NetworkSummaryDocument,
    NodeDocument,
    OccurrenceDocument,
    PathDocument,
    ReachDocument,
    StepDocument,
    StretchDocument,
)
from threadstate.responses.formations import formation_document
from threadstate.statics.verdict import Verdict
from threadstate.units import scale_length


def summary_document(network: ConstraintNetwork, window_count: int) -> NetworkSummaryDocument:
    """The size of a network, and its connectivity."""
    return NetworkSummaryDocument(
        formations=len(network.nodes),
        edges=len(network.edges),
        intervals=sum(len(cells) for cells in network.cell_map.cells),
        orientations=network.cell_map.orientation_count,
        windows=window_count,
        strong_parts=[len(part) for part in strong_parts(network)],
        dead_ends=[one.key for one in dead_ends(network)],
        cut_formations=[one.key for one in cut_formations(network)],
        telling_formations=[one.formation.key for one in identifying_formations(network)],
    )


def loaded_summary_document(
    network: ConstraintNetwork, loaded: CellMap, mu: float, avoid: frozenset[Verdict]
) -> LoadedSummaryDocument:
    """The parts of all phases by mark, and the dead ends where no move leaves a cell whose verdict is in ``avoid``."""
    widths = dict.fromkeys(Mark, 0.0)
    for cell in loaded.all_cells:
        if cell.verdict is not None:
            widths[mark_of(cell.verdict)] += cell.width_deg
    return LoadedSummaryDocument(
        mu=mu,
        shares={mark: width / loaded.total_deg for mark, width in widths.items()},
        dead_ends=[one.key for one in dead_ends(network, loaded=loaded, avoid=avoid)],
    )


def formation_summaries(network: ConstraintNetwork) -> list[FormationSummaryDocument]:
    """A summary of each formation, in the network's order."""
    return [
        FormationSummaryDocument(
            key=node.formation.key,
            state_class=node.formation.state_class,
            text=node.formation.text,
            contacts=len(node.formation.contacts),
            share=node.share,
            window_share=node.window_share,
            orientations=len(node.orientations),
            to_window=_reach_document(reach),
        )
        for node, reach in zip(network.nodes, window_reach(network), strict=True)
    ]


def node_document(network: ConstraintNetwork, key: str, factor: float) -> NodeDocument:
    """A formation in the network, lengths multiplied by ``factor``.

    Raises:
        NotFoundError: no formation has that key.
    """
    node = network.node(key)
    reach = next(one for one in window_reach(network) if one.formation == node.formation)
    return NodeDocument(
        formation=formation_document(node.formation),
        cover=node.cover_deg,
        share=node.share,
        window_share=node.window_share,
        orientations=len(node.orientations),
        to_window=_reach_document(reach),
        following=[
            FollowingDocument(
                move=one.move,
                formation=one.formation.key,
                state_class=one.formation.state_class,
                change=difference(node.formation, one.formation).text,
                cover=one.cover_deg,
                share=one.share,
            )
            for one in following(network, key)
        ],
        occurrences=[_occurrence(cell, network.cell_map, factor) for cell in node.cells],
    )


def path_document(path: Path, cell_map: CellMap, factor: float) -> PathDocument:
    """A path, lengths multiplied by ``factor``."""
    steps = []
    for step in path.steps:
        roll, pitch = cell_map.tilt_deg(step.cell.orientation)
        steps.append(
            StepDocument(
                move=step.move,
                roll=roll,
                pitch=pitch,
                phase=step.phase_deg,
                turning=step.turning_deg,
                formation=step.cell.formation.key,
                state_class=step.cell.formation.state_class,
                text=step.cell.formation.text,
                margin=scale_length(step.cell.margin, factor),
                in_window=step.cell.in_window,
            )
        )
    return PathDocument(
        objective=path.objective.value,
        turning=path.turning_deg,
        transitions=path.transitions,
        worst_margin=path.worst_margin * factor,
        steps=steps,
    )


def location_document(location: Location, cell_map: CellMap) -> LocationDocument:
    """Where a state can be."""
    stretches = []
    for one in location.stretches:
        roll, pitch = cell_map.tilt_deg(one.orientation)
        stretches.append(
            StretchDocument(roll=roll, pitch=pitch, start=one.start_deg, end=one.end_deg, formation=one.formation.key)
        )
    return LocationDocument(
        share=location.share,
        undecided_share=location.undecided_share,
        orientations=len(location.orientations),
        formations=[
            LocatedFormationDocument(
                key=formation.key,
                state_class=formation.state_class,
                text=formation.text,
                share=width / cell_map.total_deg,
            )
            for formation, width in location.width_by_formation.items()
        ],
        stretches=stretches,
    )


def _reach_document(reach: WindowReach) -> ReachDocument:
    return ReachDocument(occurrences=reach.count, reaching=reach.reaching, least=reach.least_deg, most=reach.most_deg)


def _occurrence(cell: Cell, cell_map: CellMap, factor: float) -> OccurrenceDocument:
    roll, pitch = cell_map.tilt_deg(cell.orientation)
    return OccurrenceDocument(
        roll=roll,
        pitch=pitch,
        start=cell.start_deg,
        end=cell.end_deg,
        margin=scale_length(cell.margin, factor),
        in_window=cell.in_window,
    )
