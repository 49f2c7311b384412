"""``threadstate design``."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.numbers import number
from threadstate.settings import read_settings
from threadstate.units import LengthUnit
from worker.commands.success import LARGEST_PHASES, grid_of
from worker.options import (
    DeviceFile,
    Dimensions,
    Json,
    PairName,
    Scheduler,
    TiltMax,
    TiltStep,
    Workers,
    chosen_scheduler,
    integer_option,
    number_option,
)

if TYPE_CHECKING:
    from threadstate.device.model import Device, Limits
    from threadstate.success.design import Parameter

LARGEST_SEARCH = 10_000
VARIED_MM = (("k_lateral", 1.0, 500.0), ("k_tilt", 20.0, 5000.0), ("centre", -10.0, 10.0))
"""What is varied by default, and how far, with lengths in mm."""
POWERS = {"k_lateral": -1, "k_axial": -1, "k_tilt": 1, "k_twist": 1, "centre": 1, "push": 0, "ccw_turn": 0}
"""The power of length in what can be varied."""


def design(
    device: DeviceFile = None,
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="NAME=LOW:HIGH",
            help="A number of the device that is varied, and how far, in its own unit; any number of times.",
            show_default="k_lateral=1:500, k_tilt=20:5000 and centre=-10:10 of a device in mm",
        ),
    ] = None,
    max_tilt: Annotated[
        float | None, number_option("--max-tilt", metavar="DEG", help="Largest tilt that the device allows.")
    ] = None,
    max_shift: Annotated[
        float | None, number_option("--max-shift", metavar="LENGTH", help="Largest shift that it allows, in its unit.")
    ] = None,
    max_torque: Annotated[
        float | None,
        number_option("--max-torque", metavar="TORQUE", help="Largest torque that it holds, in N times its unit."),
    ] = None,
    strategy: Annotated[
        Strategy,
        typer.Option("--strategy", help="How the hand turns: until the snap and back, or clockwise at once."),
    ] = Strategy.CCW_THEN_CW,
    mu: Annotated[
        str,
        typer.Option(
            "--mu", metavar="M", help="Coefficients of friction, ascending, with commas; the first is searched at."
        ),
    ] = "0,0.1,0.2,0.3",
    phases: Annotated[
        int,
        integer_option(
            "--phases", metavar="N", min=1, max=LARGEST_PHASES, help="Starting phases of an orientation, evenly spaced."
        ),
    ] = 1,
    tilt_max: TiltMax = 4.0,
    tilt_step: TiltStep = 1.0,
    evaluations: Annotated[
        int,
        integer_option("--evaluations", metavar="N", min=1, max=LARGEST_SEARCH, help="Devices that are tried at most."),
    ] = 60,
    finalists: Annotated[
        int,
        integer_option(
            "--finalists", metavar="N", min=1, max=100, help="Of the best ones, how many are tried at all frictions."
        ),
    ] = 3,
    point_limit: Annotated[
        int, integer_option("--point-limit", metavar="N", help="Points of a turn beyond which a path is undecided.")
    ] = 1000,
    maps: Annotated[
        Path, typer.Option("--maps", metavar="FOLDER", help="Keep the maps of the devices here, and go on with them.")
    ] = Path("design-maps"),
    pair: PairName = None,
    dimension: Dimensions = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: Json = False,
) -> None:
    r"""Find the device that brings most orientations home, within limits of its travel.

    Devices are tried at the first friction; those that no other one beats in orientations, tilt, shift and torque are
    the front, and its best ones are tried at every friction. Then each number of the best one is moved until fewer
    engage.

    \b
    Examples:
      threadstate design --tilt-max 2 --tilt-step 2 --mu 0 --evaluations 8
      threadstate design --max-tilt 4 --max-shift 2.5 --workers 2
      threadstate design --device examples/device.toml --vary centre=-5:5 --vary push=5:40 --json
    """
    began = time.perf_counter()
    grid = grid_of(tilt_max, tilt_step, phases)
    from threadstate.device.model import default_device
    from threadstate.device.settle import check_pair
    from threadstate.responses.query import parse_frictions
    from threadstate.success.inputs import SuccessInputs
    from threadstate.units import conversion_factor
    from worker.commands.settle import read_device
    from worker.design.report import print_design, print_design_json
    from worker.design.run import Design
    from worker.pairs.selection import chosen_pair

    threads = chosen_pair(pair, dimension or ())
    check_pair(threads)
    held = default_device() if device is None else read_device(device)
    inputs = SuccessInputs(threads, held, strategy, grid, parse_frictions(mu), point_limit=point_limit)
    limits = _limits(max_tilt, max_shift, max_torque, conversion_factor(held.unit, threads.unit))
    settings = read_settings()
    computing = chosen_scheduler(settings, scheduler, workers)
    search = Design(inputs, _varied(vary, held), limits, workers or settings.workers, maps, computing)
    result = search.run(evaluations, finalists)
    elapsed_s = time.perf_counter() - began
    (print_design_json if as_json else print_design)(inputs, limits, result, elapsed_s)


def _limits(max_tilt: float | None, max_shift: float | None, max_torque: float | None, factor: float) -> Limits:
    """The limits; a length in the device's unit times ``factor`` is in the pair's."""
    from threadstate.device.model import Limits

    for name, value in (("max_tilt", max_tilt), ("max_shift", max_shift), ("max_torque", max_torque)):
        if value is not None and not 0.0 < value < math.inf:
            raise InvalidValueError(name, value, "a number > 0")
    return Limits(max_tilt, max_shift, max_torque).in_unit(factor)


def _varied(texts: list[str] | None, held: Device) -> list[Parameter]:
    from threadstate.success.design import Parameter
    from threadstate.units import conversion_factor

    if texts is None:
        factor = conversion_factor(LengthUnit.MILLIMETRE, held.unit)
        return [
            Parameter(name, low * factor ** POWERS[name], high * factor ** POWERS[name])
            for name, low, high in VARIED_MM
        ]
    found = []
    for text in texts:
        name, is_given, ends = text.partition("=")
        low, is_range, high = ends.partition(":")
        if not (is_given and is_range):
            raise InvalidValueError("vary", text, "NAME=LOW:HIGH, as k_tilt=20:5000")
        found.append(Parameter(name.strip(), number(low), number(high)))
    return found
