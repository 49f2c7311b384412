"""``threadstate heights``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from worker.options import Database, Dimensions, Json, PairName, UnitName, number_option
from worker.output import print_json


def heights(
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
    plot: Annotated[
        Path | None,
        typer.Option("--plot", metavar="FILE", help="Draw it, too, as .svg or .png."),
    ] = None,
    database: Database = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    as_json: Json = False,
) -> None:
    r"""Print the height of the bolt against its phase, at as many phases as straight lines between them need.

    A jump shows as two heights at phases that all but coincide. With --library it is that of a library: read where the
    orientation is on its grid, else computed by its pair and tolerances.

    \b
    Examples:
      threadstate heights --roll 0 --pitch -4
      threadstate heights --roll 1.5 --pitch -0.7 --json
      threadstate heights --roll 0 --pitch -4 --library latest
      threadstate heights --roll 2.5 --pitch -1.2 --pair examples/m6x1.toml
      threadstate heights --roll 0 --pitch -4 --library latest --unit mm --plot heights.svg
    """
    from worker.plots import check_plot_file, plot_heights

    if plot is not None:
        check_plot_file(plot)

    from threadstate.responses.heights import computed_heights, heights_document, stored_heights
    from threadstate.responses.histories import computed_history
    from threadstate.responses.windows import windows_document
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.history_table import print_heights
    from worker.library_source import orientation_source

    with orientation_source(database, library, pair, dimension, roll, pitch, stored=stored) as source:
        threads = source.pair
        if source.stored is not None:
            connection, network = source.stored
            found = stored_heights(connection, network, roll, pitch)
            history = None if plot is None else network.histories.orientations[network.orientation(roll, pitch)]
        else:
            found = computed_heights(threads, roll, pitch, source.options)
            history = None if plot is None else computed_history(threads, roll, pitch, source.options)
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    document = heights_document(found, roll, pitch, threads.thread_pitch, factor)
    if plot is not None and history is not None:
        windows = windows_document(history, roll, pitch, threads, factor).windows
        plot_heights(document, windows, shown, plot)
    if as_json:
        print_json({"unit": shown.value, "source": source_of(threads), **document.model_dump(mode="json")})
        return
    print_heights(document, shown)
