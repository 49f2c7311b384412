"""``threadstate transitions``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.network.changes import ChangeKind
from threadstate.network.moves import Move
from threadstate.state.model import StateClass
from worker.load import NO_MOMENT, PUSH, Force, Moment, Point, UnderMu, chosen_load, needs_friction
from worker.options import Database, Json, LibraryName, UnitName, integer_option, number_option
from worker.output import print_json, print_status


def transitions(
    move: Annotated[Move | None, typer.Option("--move", help="Only by this move.")] = None,
    roll: Annotated[float | None, number_option("--roll", metavar="DEG", help="Only from this roll.")] = None,
    pitch: Annotated[float | None, number_option("--pitch", metavar="DEG", help="Only from this pitch.")] = None,
    phase_min: Annotated[float | None, number_option("--phase-min", metavar="DEG", help="Smallest phase.")] = None,
    phase_max: Annotated[float | None, number_option("--phase-max", metavar="DEG", help="Largest phase.")] = None,
    source: Annotated[str | None, typer.Option("--from", metavar="KEY", help="Only from this formation.")] = None,
    target: Annotated[str | None, typer.Option("--to", metavar="KEY", help="Only to this formation.")] = None,
    change: Annotated[ChangeKind | None, typer.Option("--change", help="Only where this changes.")] = None,
    state_class: Annotated[StateClass | None, typer.Option("--class", help="Only from this class.")] = None,
    limit: Annotated[int, integer_option("--limit", metavar="N", min=1, help="How many at most.")] = 50,
    mu: UnderMu = None,
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print transitions of a library: along phase, and to the orientations beside at the same phase.

    With --mu each is marked free, held or wedged by what the load does where it begins.

    \b
    Examples:
      threadstate transitions --roll 0 --pitch -4 --move ccw
      threadstate transitions --change class --move roll+ --limit 10
      threadstate transitions --roll 0 --pitch -4 --phase-min 357 --phase-max 358 --json
      threadstate transitions --library 2 --unit mm --limit 5
      threadstate transitions --roll 0 --pitch -4 --move ccw --mu 0.15 --force 0,0,-10
    """
    needs_friction(mu, force, moment, point)

    from threadstate.responses.query import TransitionFilter, filter_transitions
    from threadstate.responses.transitions import transition_documents
    from threadstate.units import conversion_factor
    from worker.history_table import print_transitions
    from worker.library_source import stored_network

    which = TransitionFilter(move, roll, pitch, phase_min, phase_max, source, target, change, state_class)
    network = stored_network(database, library)
    found = filter_transitions(network, which)
    shown = unit or network.pair.unit
    factor = conversion_factor(network.pair.unit, shown)
    loaded = None if mu is None else network.under(chosen_load(force, moment, point, factor), mu)
    documents = transition_documents(found[:limit], network.histories, network.tilts, factor, loaded)
    if as_json:
        for one in documents:
            print_json({"unit": shown.value, **one.model_dump(mode="json", by_alias=True)})
    else:
        print_transitions(documents, shown)
    if len(found) > limit:
        print_status(f"{limit} of {len(found)} transitions; --limit shows more")
