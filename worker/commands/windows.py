"""``threadstate windows``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.history.falls import SNAP_PITCHES, SPAN_DEG
from worker.options import Database, Json, LibraryName, UnitName, integer_option, number_option
from worker.output import print_json, print_line


def windows(
    roll: Annotated[float | None, number_option("--roll", metavar="DEG", help="Only of this roll.")] = None,
    pitch: Annotated[float | None, number_option("--pitch", metavar="DEG", help="Only of this pitch.")] = None,
    tolerance: Annotated[
        float | None,
        number_option("--tolerance", metavar="DEG", help="Of roll and pitch, either way: the range of what they give."),
    ] = None,
    steps: Annotated[
        int, integer_option("--steps", metavar="N", help="Values of each angle within the tolerance, an odd number.")
    ] = 3,
    span: Annotated[
        float, number_option("--span", metavar="DEG", help="Span of phase of the steepest fall.")
    ] = SPAN_DEG,
    least: Annotated[
        float,
        number_option("--least", metavar="N", help="A steepest fall of more than so many thread pitches is a snap's."),
    ] = SNAP_PITCHES,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    plot: Annotated[
        Path | None, typer.Option("--plot", metavar="FILE", help="Draw a map of the snaps' falls, as .svg or .png.")
    ] = None,
    as_json: Json = False,
) -> None:
    r"""Print where the bolt goes down, snaps and enters the thread.

    Of all orientations of a library, or of one: any roll and pitch, which are computed where they are not on the grid.
    A snap is the whole descent that holds the steepest fall, with the part of it that happens at one phase; a window is
    where the first contact is on a thread, so that the bolt can go on down.

    \b
    Examples:
      threadstate windows
      threadstate windows --roll 0 --pitch -4
      threadstate windows --roll 2.5 --pitch -1.2 --tolerance 0.3
      threadstate windows --library m6x1 --unit in --json
      threadstate windows --plot falls.svg
    """
    from threadstate.responses.falls_range import computed_falls, falls_range, tilts_within
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.falls import falls_and_windows
    from worker.history_table import print_falls, print_falls_range, print_windows
    from worker.library_source import stored_network
    from worker.plots import check_plot_file, plot_map
    from worker.progress import with_progress

    if tolerance is not None and (roll is None or pitch is None):
        raise InvalidValueError("--tolerance", tolerance, "with --roll and --pitch")
    if plot is not None and not (roll is None and pitch is None):
        raise InvalidValueError("--plot", str(plot), "a map of all orientations; `heights --plot` draws one of them")
    if plot is not None:
        check_plot_file(plot)
    network = stored_network(database, library)
    shown = unit or network.pair.unit
    factor = conversion_factor(network.pair.unit, shown)
    found = falls_and_windows(network, roll, pitch, factor, span, least)
    within = None
    if tolerance is not None and roll is not None and pitch is not None:
        tilts = tilts_within(roll, pitch, tolerance, steps)
        within = falls_range(
            lambda a, b: computed_falls(network.pair, network.options, a, b, factor, span, least),
            roll,
            pitch,
            tolerance,
            with_progress(tilts, "tilts"),
        )
    if plot is not None:
        falls = {(one.roll, one.pitch): None if one.snap is None else one.snap.fall for one in found}
        plot_map(falls, f"{network.pair.designation}: fall of the snap", shown, plot)
    if as_json:
        entries = [one.model_dump(mode="json", by_alias=True) for one in found]
        of = {"library": network.library.id, "unit": shown.value, "source": source_of(network.pair)}
        given = {} if within is None else {"range": within.model_dump(mode="json")}
        print_json({**of, "orientations": entries, **given})
        return
    print_falls(found, shown, span)
    print_line("")
    print_windows([window for one in found for window in one.windows], shown)
    if within is not None:
        print_line("")
        print_falls_range(within, shown)
