"""``threadstate path``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.network.moves import Move
from threadstate.network.search import Objective
from worker.load import NO_MOMENT, PUSH, WEDGED, Avoid, Force, Moment, Point, UnderMu, chosen_load, needs_friction
from worker.options import Database, Json, LibraryName, UnitName, number_option
from worker.output import print_json


def path(
    source: Annotated[str, typer.Option("--from", metavar="KEY", help="Key of the formation to start from.")],
    objective: Annotated[
        Objective, typer.Option("--objective", help="What makes a path the best.")
    ] = Objective.TURNING,
    moves: Annotated[
        str, typer.Option("--moves", metavar="NAMES", help=f"Moves allowed, with commas: {', '.join(Move)}.")
    ] = Move.COUNTER_CLOCKWISE.value,
    roll: Annotated[float | None, number_option("--roll", metavar="DEG", help="Only from this roll.")] = None,
    pitch: Annotated[float | None, number_option("--pitch", metavar="DEG", help="Only from this pitch.")] = None,
    phase: Annotated[float | None, number_option("--phase", metavar="DEG", help="Only from this phase.")] = None,
    mu: UnderMu = None,
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    avoid: Avoid = WEDGED,
    library: LibraryName = None,
    unit: UnitName = None,
    database: Database = None,
    as_json: Json = False,
) -> None:
    r"""Print the best path from a contact formation to the clearance window, by the moves allowed.

    \b
    Examples:
      threadstate path --from 14c84cf806
      threadstate path --from 14c84cf806 --objective margin --moves ccw,roll+,roll-,pitch+,pitch-
      threadstate path --from 14c84cf806 --roll 4 --pitch 0 --phase 200
      threadstate path --from 14c84cf806 --library m6x1 --unit mm
      threadstate path --from 14c84cf806 --mu 0.15 --force 0,0,-10 --avoid held,wedged
    """
    if (roll is None) != (pitch is None) or (phase is not None and roll is None):
        raise InvalidValueError("--roll, --pitch, --phase", (roll, pitch, phase), "none, roll and pitch, or all three")
    needs_friction(mu, force, moment, point, avoid)

    from threadstate.network.paths import best_path
    from threadstate.responses.networks import path_document
    from threadstate.responses.query import parse_marks, parse_moves
    from threadstate.units import conversion_factor
    from worker.history_table import print_path
    from worker.library_source import stored_network

    allowed = parse_moves(moves)
    found = stored_network(database, library)
    shown = unit or found.pair.unit
    orientation = None if roll is None or pitch is None else found.orientation(roll, pitch)
    start = found.network.node(source).formation
    factor = conversion_factor(found.pair.unit, shown)
    avoided = parse_marks(avoid)
    cell_map = found.cell_map if mu is None else found.under(chosen_load(force, moment, point, factor), mu).cell_map
    best = best_path(cell_map, start, objective, allowed, orientation=orientation, phase_deg=phase, avoid=avoided)
    document = None if best is None else path_document(best, cell_map, factor)
    if as_json:
        print_json(
            None if document is None else {"unit": shown.value, **document.model_dump(mode="json", by_alias=True)}
        )
        return
    print_path(document, shown)
