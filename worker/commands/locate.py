"""``threadstate locate``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.state.model import Flag, StateClass
from worker.options import Database, Json, LibraryName, integer_option
from worker.output import print_json


def locate(
    state_class: Annotated[StateClass | None, typer.Option("--class", help="The class observed.")] = None,
    contacts: Annotated[
        int | None, integer_option("--contacts", metavar="N", min=1, help="How many contacts there are.")
    ] = None,
    contact: Annotated[
        str,
        typer.Option(
            "--contact",
            metavar="TEXT",
            help="Contacts, with commas, each as stage:bolt_region:nut_region:features; * where not observed.",
        ),
    ] = "",
    flag: Annotated[Flag | None, typer.Option("--flag", help="A flag observed.")] = None,
    ordered: Annotated[
        bool, typer.Option("--ordered", help="The contacts are the first in their order.", show_default=False)
    ] = False,
    library: LibraryName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print where a contact state with the labels observed can be.

    Which formations remain, with the keys that `threadstate path --from` takes, and at which orientations and phases.

    \b
    Examples:
      threadstate locate --class stable_three_point --contact 1:crest_fillet_pos
      threadstate locate --contacts 3 --contact 1:*:*:edge-edge,2:base
    """
    if state_class is None and contacts is None and not contact and flag is None:
        raise InvalidValueError(
            "observation", None, "at least one of --class, --contacts, --contact, --flag; all phases remain without any"
        )

    from threadstate.network.locate import Observation
    from threadstate.network.locate import locate as located
    from threadstate.responses.networks import location_document
    from threadstate.responses.query import parse_contact_observations
    from worker.history_table import print_location
    from worker.library_source import stored_network

    flags = frozenset() if flag is None else frozenset({flag})
    observation = Observation(state_class, contacts, flags, parse_contact_observations(contact), ordered)
    cell_map = stored_network(database, library).cell_map
    document = location_document(located(cell_map, observation), cell_map)
    if as_json:
        print_json(document.model_dump(mode="json", by_alias=True))
        return
    print_location(document)
