"""``threadstate locate``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.state.model import Flag, StateClass
from threadstate.statics.verdict import Verdict
from worker.load import NO_MOMENT, PUSH, Force, Moment, Point, UnderMu, chosen_load, needs_friction
from worker.options import Database, Json, LibraryName, UnitName, integer_option
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
    verdict: Annotated[
        Verdict | None, typer.Option("--verdict", help="What the bolt was seen to do under the load; with --mu.")
    ] = None,
    mu: UnderMu = None,
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print where a contact state with the labels observed can be.

    Which formations remain, with the keys that `threadstate path --from` takes, and at which orientations and phases.

    \b
    Examples:
      threadstate locate --class stable_three_point --contact 1:crest_fillet_pos
      threadstate locate --contacts 3 --contact 1:*:*:edge-edge,2:base
      threadstate locate --verdict can_stay --mu 0.15 --force 0,0,-10
    """
    if state_class is None and contacts is None and not contact and flag is None and verdict is None:
        raise InvalidValueError(
            "observation",
            None,
            "at least one of --class, --contacts, --contact, --flag, --verdict; all phases remain without any",
        )
    if (verdict is None) != (mu is None):
        raise InvalidValueError("--verdict, --mu", (verdict, mu), "both or none: a verdict is that at a friction")
    needs_friction(mu, force, moment, point)

    from threadstate.network.locate import Observation
    from threadstate.network.locate import locate as located
    from threadstate.responses.networks import location_document
    from threadstate.responses.query import parse_contact_observations
    from threadstate.units import conversion_factor
    from worker.history_table import print_location
    from worker.library_source import stored_network

    flags = frozenset() if flag is None else frozenset({flag})
    observation = Observation(state_class, contacts, flags, parse_contact_observations(contact), ordered, verdict)
    network = stored_network(database, library)
    cell_map = network.cell_map
    if mu is not None:
        factor = conversion_factor(network.pair.unit, unit or network.pair.unit)
        cell_map = network.under(chosen_load(force, moment, point, factor), mu).cell_map
    document = location_document(located(cell_map, observation), cell_map)
    if as_json:
        print_json(document.model_dump(mode="json", by_alias=True))
        return
    print_location(document)
