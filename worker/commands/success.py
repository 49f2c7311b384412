"""``threadstate success``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.settings import read_settings
from worker.options import (
    DeviceFile,
    Dimensions,
    Json,
    PairName,
    Scheduler,
    TiltMax,
    TiltStep,
    UnitName,
    Workers,
    chosen_scheduler,
    integer_option,
    number_option,
)

if TYPE_CHECKING:
    from threadstate.library.grid import Grid

LARGEST_PHASES = 36_000


def success(
    device: DeviceFile = None,
    strategy: Annotated[
        Strategy,
        typer.Option("--strategy", help="How the hand turns: until the snap and back, or clockwise at once."),
    ] = Strategy.CCW_THEN_CW,
    mu: Annotated[
        str, typer.Option("--mu", metavar="M", help="Coefficients of friction, 0 to 1, ascending, with commas.")
    ] = "0.1,0.2,0.3",
    phases: Annotated[
        int,
        integer_option(
            "--phases", metavar="N", min=1, max=LARGEST_PHASES, help="Starting phases of an orientation, evenly spaced."
        ),
    ] = 12,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    phase_tolerance: Annotated[
        float,
        number_option("--phase-tolerance", metavar="DEG", help="How far boundaries along the phase are narrowed."),
    ] = 2.0,
    mu_tolerance: Annotated[
        float, number_option("--mu-tolerance", metavar="M", help="How far the critical friction is narrowed.")
    ] = 0.01,
    point_limit: Annotated[
        int, integer_option("--point-limit", metavar="N", help="Points of a turn beyond which a path is undecided.")
    ] = 1000,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Keep the map in this file, and go on with what it has."),
    ] = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: Json = False,
) -> None:
    r"""Say from which orientations, starting phases and frictions a device and a strategy assemble a pair.

    Boundaries of outcome along the phase and the critical friction are bisected. A run with --out that was interrupted
    goes on where it was.

    \b
    Examples:
      threadstate success --tilt-max 4 --tilt-step 4 --phases 4 --mu 0
      threadstate success --strategy cw --mu 0,0.1 --out cw.map --workers 2
      threadstate success --pair M6 --device examples/device.toml --phases 8 --json
    """
    began = time.perf_counter()
    grid = grid_of(tilt_max, tilt_step, phases)
    from threadstate.device.model import default_device
    from threadstate.device.settle import check_pair
    from threadstate.responses.query import parse_frictions
    from threadstate.success.inputs import SuccessInputs
    from worker.commands.settle import read_device
    from worker.pairs.selection import chosen_pair
    from worker.success.report import print_map, print_map_json
    from worker.success.run import computed_map_with_progress

    frictions = parse_frictions(mu)
    threads = chosen_pair(pair, dimension or ())
    check_pair(threads)
    held = default_device() if device is None else read_device(device)
    inputs = SuccessInputs(threads, held, strategy, grid, frictions, phase_tolerance, mu_tolerance, point_limit)
    settings = read_settings()
    computing = chosen_scheduler(settings, scheduler, workers)
    result = computed_map_with_progress(inputs, workers or settings.workers, out, computing)
    elapsed_s = time.perf_counter() - began
    (print_map_json if as_json else print_map)(inputs, result, elapsed_s, unit or threads.unit)


def grid_of(tilt_max: float, tilt_step: float, phases: int) -> Grid:
    """The grid of a number of starting phases.

    Raises:
        InvalidValueError: the phases are no decimals, or the grid is not valid.
    """
    from threadstate.library.grid import Grid

    # What remains of a number of phases without its twos, fives and two threes has no finite decimal.
    rest = phases
    for prime in (2, 2, 2, 2, 2, 2, 2, 2, 3, 3, 5, 5, 5):
        rest = rest // prime if rest % prime == 0 else rest
    if rest != 1:
        raise InvalidValueError("phases", phases, "a number that divides 360 deg into decimals, as 4, 8, 12 or 36")
    return Grid(tilt_max, tilt_step, 360.0 / phases)
