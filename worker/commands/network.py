"""``threadstate network``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from worker.load import NO_MOMENT, PUSH, WEDGED, Avoid, Force, Moment, Point, UnderMu, chosen_load, needs_friction
from worker.options import Database, Json, LibraryName, UnitName
from worker.output import print_json, print_text


class NetworkFormat(StrEnum):
    """The formats of a whole network."""

    NODE_LINK = "node-link"
    GRAPHML = "graphml"
    DOT = "dot"


def network(
    export: Annotated[NetworkFormat | None, typer.Option("--export", help="Print all of it in this format.")] = None,
    mu: UnderMu = None,
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    avoid: Avoid = WEDGED,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print the size of a library's constraint network and its connectivity, or all of it.

    With --mu: of all phases the parts that are free, held or wedged under a load, and the dead ends.

    \b
    Examples:
      threadstate network
      threadstate network --export graphml > network.graphml
      threadstate network --library 2 --json
      threadstate network --mu 0.15 --force 0,0,-10 --avoid held,wedged
    """
    needs_friction(mu, force, moment, point, avoid)

    from threadstate.responses.networks import loaded_summary_document
    from threadstate.responses.query import parse_marks
    from threadstate.units import conversion_factor
    from worker.history_table import print_loaded_summary, print_summary
    from worker.library_source import stored_network

    found = stored_network(database, library)
    if mu is not None:
        if export is not None:
            raise InvalidValueError("--export", export.value, "without --mu: the whole network is that without a load")
        factor = conversion_factor(found.pair.unit, unit or found.pair.unit)
        loaded = found.under(chosen_load(force, moment, point, factor), mu)
        document = loaded_summary_document(found.network, loaded.cell_map, mu, parse_marks(avoid))
        if as_json:
            print_json(document.model_dump(mode="json"))
        else:
            print_loaded_summary(document)
        return
    match export:
        case NetworkFormat.NODE_LINK:
            print_text(found.node_link)
        case NetworkFormat.GRAPHML:
            print_text(found.graphml)
        case NetworkFormat.DOT:
            print_text(found.dot)
        case None if as_json:
            print_json(found.summary.model_dump(mode="json", by_alias=True))
        case None:
            print_summary(found.summary)
