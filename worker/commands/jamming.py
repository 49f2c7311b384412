"""``threadstate jamming``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from threadstate.statics.load import DEFAULT_FRICTION
from worker.load import NO_MOMENT, PUSH, Force, Moment, Point, chosen_load
from worker.options import Dimensions, Json, PairName, UnitName, number_option
from worker.output import print_json


def jamming(
    roll: Annotated[float, number_option("--roll", metavar="DEG", help="Roll, -10 to 10.")],
    pitch: Annotated[float, number_option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")],
    phase: Annotated[float, number_option("--phase", metavar="DEG", help="Phase, any finite angle.")],
    mu: Annotated[
        float, number_option("--mu", metavar="M", help="Coefficient of friction of all contacts.")
    ] = DEFAULT_FRICTION,
    axes: Annotated[
        str, typer.Option("--axes", metavar="A,B", help="Two of fx, fy, mx, my, mz: what is varied beside the push.")
    ] = "fx,my",
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    contacts: Annotated[
        str | None,
        typer.Option("--contacts", metavar="I,J", help="These contacts alone, from 1.", show_default="all"),
    ] = None,
    window: Annotated[
        str | None,
        typer.Option(
            "--window",
            metavar="X,Y",
            help="Half widths of what is seen of an unbounded diagram.",
            show_default="what shows its corners",
        ),
    ] = None,
    tolerance: Annotated[
        float | None,
        number_option("--tolerance", metavar="X", help="Gap of its boundary aimed at, over the diagram's size."),
    ] = None,
    plot: Annotated[Path | None, typer.Option("--plot", metavar="FILE", help="Draw it, too, as .svg.")] = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Say which loads beside a push the contacts of a state can balance: its jamming diagram.

    Forces are over the push, moments over the push times the nominal radius.

    \b
    Examples:
      threadstate jamming --roll 1 --pitch -2 --phase 10
      threadstate jamming --roll 1 --pitch -2 --phase 10 --mu 0.5 --plot jamming.svg
      threadstate jamming --roll 4 --pitch 0 --phase 185 --axes mx,my --json
      threadstate jamming --roll 1 --pitch -2 --phase 10 --mu 1 --contacts 1,2
    """
    from worker.plots import check_plot_file

    if plot is not None:
        check_plot_file(plot, (".svg",))

    from threadstate.responses.query import parse_axes, parse_contacts, parse_window
    from threadstate.state.solve import solve_pose
    from threadstate.statics.jamming import TOLERANCE, jamming_diagram
    from threadstate.statics.jamming_document import jamming_document
    from threadstate.statics.jamming_svg import jamming_svg
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_jamming

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    load = chosen_load(force, moment, point, factor)
    state = solve_pose(threads, roll, pitch, phase)
    diagram = jamming_diagram(
        threads,
        state,
        mu,
        parse_axes(axes),
        load=load,
        contacts=None if contacts is None else parse_contacts("--contacts", contacts),
        window=None if window is None else parse_window("--window", window),
        tolerance=TOLERANCE if tolerance is None else tolerance,
    )
    document = jamming_document(state, diagram, factor)
    if plot is not None:
        plot.write_text(jamming_svg(document))
    if as_json:
        print_json({**document, "source": source_of(threads)})
    else:
        print_jamming(document)
