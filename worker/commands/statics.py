"""``threadstate statics``."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.statics.load import DEFAULT_FRICTION, checked_friction
from worker.commands.solve import BATCH, wanted_poses
from worker.load import NO_MOMENT, PUSH, Force, Moment, Point, chosen_load
from worker.options import Dimensions, Json, PairName, Phase, Pitch, Poses, Roll, UnitName, number_option
from worker.output import print_json


def statics(
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    poses: Poses = None,
    mu: Annotated[
        float, number_option("--mu", metavar="M", help="Coefficient of friction of all contacts.")
    ] = DEFAULT_FRICTION,
    force: Force = PUSH,
    moment: Moment = NO_MOMENT,
    point: Point = None,
    include: Annotated[
        str | None,
        typer.Option(
            "--include",
            metavar="NAMES",
            help="More numbers, with commas: reaction, forces_range, modes, wrenches.",
            show_default=False,
        ),
    ] = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Say what a load does to a contact state: whether it is held, wedged, or moves, and what turns the bolt.

    With --json, one object a line in the order of the file.

    \b
    Examples:
      threadstate statics --roll 1 --pitch -2 --phase 10
      threadstate statics --roll 1 --pitch -2 --phase 10 --mu 0.15 --force 0,0,-10 --json
      threadstate statics --roll 1 --pitch -2 --phase 10 --force 0.5,0,-10 --moment 0,0.1,0 --json
      threadstate statics --roll 1 --pitch -2 --phase 10 --mu 1 --include reaction,forces_range,modes
      threadstate statics --poses poses.csv --mu 0.1 --json
    """
    wanted = wanted_poses(roll, pitch, phase, poses)

    from threadstate.state.solve import solve_poses
    from threadstate.statics.document import requested_document
    from threadstate.statics.extras import extras_of, requested_extras
    from threadstate.statics.solve import statics_of
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair
    from worker.tables import print_statics

    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    checked_friction(mu)
    requested = requested_extras(include) if include is not None else frozenset()
    load = chosen_load(force, moment, point, factor)
    for start in range(0, len(wanted), BATCH):
        for state in solve_poses(threads, wanted[start : start + BATCH]):
            found = statics_of(threads, state, load, mu)
            extras = extras_of(threads, state, found, requested) if requested else None
            if as_json:
                print_json({**requested_document(found, extras, factor), "source": source_of(threads)})
            else:
                print_statics(found, extras, shown, factor)
