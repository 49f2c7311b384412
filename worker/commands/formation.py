"""``threadstate formation``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Json
from worker.output import print_json


def formation(
    key: Annotated[str, typer.Option("--key", metavar="KEY", help="Key of the formation.")],
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Tell of a contact formation of the latest library: where it occurs, what can follow, how far it is to the snap.

    \b
    Examples:
      threadstate formation --key 14c84cf806
    """
    from threadstate.answer.networks import node_document
    from worker.history_table import print_node
    from worker.stored_network import stored_network

    document = node_document(stored_network(database).network, key, 1.0)
    if as_json:
        print_json(document.model_dump(mode="json", by_alias=True))
        return
    print_node(document)
