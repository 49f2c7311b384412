"""``threadstate formation``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Json, LibraryName, UnitName
from worker.output import print_json


def formation(
    key: Annotated[str, typer.Option("--key", metavar="KEY", help="Key of the formation.")],
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print where a contact formation of a library occurs, what can follow it, how far it is to the window.

    \b
    Examples:
      threadstate formation --key 14c84cf806
      threadstate formation --key 14c84cf806 --library 2 --unit mm --json
    """
    from threadstate.responses.networks import node_document
    from threadstate.units import conversion_factor
    from worker.history_table import print_node
    from worker.library_source import stored_network

    found = stored_network(database, library)
    shown = unit or found.pair.unit
    document = node_document(found.network, key, conversion_factor(found.pair.unit, shown))
    if as_json:
        print_json({"unit": shown.value, **document.model_dump(mode="json", by_alias=True)})
        return
    print_node(document)
