"""``threadstate history``."""

from __future__ import annotations

from typing import Annotated

import typer

from worker.options import Database, Dimensions, Json, PairName, UnitName, number_option
from worker.output import print_json


def history(
    roll: Annotated[float, number_option("--roll", metavar="DEG", help="Roll, -10 to 10.")],
    pitch: Annotated[float, number_option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")],
    library: Annotated[
        str | None,
        typer.Option(
            "--library",
            metavar="NAME",
            help="Of this library: its number, its thread's designation or slug, or latest.",
            show_default=False,
        ),
    ] = None,
    stored: Annotated[
        bool, typer.Option("--stored", help="From the library's tables alone, never computed.", show_default=False)
    ] = False,
    unit: UnitName = None,
    database: Database = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    as_json: Json = False,
) -> None:
    r"""Print the history of an orientation: its phase circle, cut where any label changes, and its clearance windows.

    Any orientation is computed, which takes about a second. With --library it is that of a library: read where the
    orientation is on its grid, else computed by its pair and tolerances.

    \b
    Examples:
      threadstate history --roll 0 --pitch -4
      threadstate history --roll 1.5 --pitch -0.7 --json
      threadstate history --roll 0 --pitch -4 --library latest
      threadstate history --roll 2.5 --pitch -1.2 --library 1-4-20-unc --unit mm
      threadstate history --roll 2.5 --pitch -1.2 --pair examples/m6x1.toml
    """
    from threadstate.responses.histories import computed_history, history_document
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.history_table import print_history
    from worker.library_source import orientation_source

    with orientation_source(database, library, pair, dimension, roll, pitch, stored=stored) as source:
        threads = source.pair
        if source.stored is not None:
            _, network = source.stored
            found = network.histories.orientations[network.orientation(roll, pitch)]
        else:
            found = computed_history(threads, roll, pitch, source.options)
    shown = unit or threads.unit
    document = history_document(found, roll, pitch, threads, conversion_factor(threads.unit, shown))
    if as_json:
        print_json(
            {"unit": shown.value, "source": source_of(threads), **document.model_dump(mode="json", by_alias=True)}
        )
        return
    print_history(document, shown)
