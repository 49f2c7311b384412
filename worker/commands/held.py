"""``threadstate held``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.load import NO_MOMENT, PUSH, Force, Moment, Point, chosen_load
from worker.options import Database, Dimensions, Json, PairName, UnitName, number_option
from worker.output import print_json


def held(
    roll: Annotated[float, number_option("--roll", metavar="DEG", help="Roll, -10 to 10.")],
    pitch: Annotated[float, number_option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")],
    mu: Annotated[
        str, typer.Option("--mu", metavar="M", help="Coefficients of friction of all contacts, with commas.")
    ] = "0.1,0.2,0.3",
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    library: Annotated[
        str | None,
        typer.Option(
            "--library",
            metavar="NAME",
            help="Of this library: its number, its thread's designation or slug, or latest.",
            show_default=False,
        ),
    ] = None,
    unit: UnitName = None,
    database: Database = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    as_json: Json = False,
) -> None:
    r"""Say along the phase of an orientation where the contacts can hold a load, and where they can wedge.

    Where that begins and ends is solved. Any orientation is computed, which takes about a second. With --json, one
    object for each friction.

    \b
    Examples:
      threadstate held --roll 0 --pitch -4
      threadstate held --roll 0 --pitch -4 --mu 0.15 --force 0.5,0,-10 --json
      threadstate held --roll 2.5 --pitch -1.2 --library 1-4-20-unc --mu 0.1
    """
    from threadstate.responses.held import held_documents
    from threadstate.responses.histories import computed_history
    from threadstate.responses.query import parse_frictions
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.history_table import print_held
    from worker.library_source import orientation_source

    frictions = parse_frictions(mu)
    with orientation_source(database, library, pair, dimension, roll, pitch, stored=False) as source:
        threads, options = source.pair, source.options
        if source.stored is not None:
            _, network = source.stored
            found = network.histories.orientations[network.orientation(roll, pitch)]
            options = network.options
        else:
            found = computed_history(threads, roll, pitch, source.options)
    load = chosen_load(force, moment, point, conversion_factor(threads.unit, unit or threads.unit))
    for document in held_documents(threads, options, (roll, pitch), found.cells, load, frictions):
        if as_json:
            print_json({**document.model_dump(mode="json"), "source": source_of(threads)})
        else:
            print_held(document)
