"""``threadstate network``."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from worker.options import Database, Json, LibraryName
from worker.output import print_json, print_text


class NetworkFormat(StrEnum):
    """The formats of a whole network."""

    NODE_LINK = "node-link"
    GRAPHML = "graphml"
    DOT = "dot"


def network(
    export: Annotated[NetworkFormat | None, typer.Option("--export", help="Print all of it in this format.")] = None,
    library: LibraryName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print the size of a library's constraint network and its connectivity, or all of it.

    \b
    Examples:
      threadstate network
      threadstate network --export graphml > network.graphml
      threadstate network --library 2 --json
    """
    from worker.history_table import print_summary
    from worker.library_source import stored_network

    found = stored_network(database, library)
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
