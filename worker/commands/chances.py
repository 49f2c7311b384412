"""``threadstate chances``."""

from __future__ import annotations

import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.numbers import number
from threadstate.settings import read_settings
from worker.options import (
    DeviceFile,
    Dimensions,
    Json,
    PairName,
    Scheduler,
    UnitName,
    Workers,
    chosen_scheduler,
    integer_option,
    number_option,
)

if TYPE_CHECKING:
    from threadstate.chances.sampling import Uncertainty

LARGEST_SAMPLES = 100_000


def chances(
    device: DeviceFile = None,
    strategy: Annotated[
        Strategy,
        typer.Option("--strategy", help="How the hand turns: until the snap and back, or clockwise at once."),
    ] = Strategy.CCW_THEN_CW,
    tilt_sd: Annotated[
        float, number_option("--tilt-sd", metavar="DEG", help="Standard deviation of roll and pitch, 0 to 10.")
    ] = 1.0,
    tilt_mean: Annotated[
        str, typer.Option("--tilt-mean", metavar="ROLL,PITCH", help="Their means, in degrees, -10 to 10.")
    ] = "0,0",
    mu: Annotated[
        str,
        typer.Option("--mu", metavar="LOW:HIGH", help="Range of the coefficient of friction, 0 to 1, or one number."),
    ] = "0.1:0.3",
    samples: Annotated[
        int,
        integer_option("--samples", metavar="N", min=1, max=LARGEST_SAMPLES, help="How many paths are sampled."),
    ] = 64,
    point_limit: Annotated[
        int, integer_option("--point-limit", metavar="N", help="Points of a turn beyond which a path is undecided.")
    ] = 1000,
    watch: Annotated[
        str | None,
        typer.Option(
            "--watch",
            metavar="TEXT",
            help='What a sensor measures, each with its tolerance, as "force=0.5,-1,10+-0.5 torque=0.2+-0.05 '
            'phase=120+-10".',
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="Keep the samples in this file, and go on with what it has."),
    ] = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
    as_json: Json = False,
) -> None:
    r"""Say how likely a device assembles a pair under uncertain approach, and what a sensor should watch for.

    Tilt, phase and friction are sampled, and each path is followed. With more samples the first ones stay. A run with
    --out that was interrupted goes on where it was.

    \b
    Examples:
      threadstate chances --tilt-sd 1 --mu 0 --samples 16
      threadstate chances --tilt-mean 0,-2 --tilt-sd 1.5 --mu 0.05:0.2 --strategy cw --out cw.samples
      threadstate chances --device examples/device.toml --samples 256 --workers 2 --json
    """
    began = time.perf_counter()
    uncertainty = _uncertainty(tilt_mean, tilt_sd, mu)
    from threadstate.chances.inputs import ChancesInputs
    from threadstate.chances.watch import parse_observation
    from threadstate.device.model import default_device
    from threadstate.device.settle import check_pair
    from worker.chances.report import print_chances, print_chances_json
    from worker.chances.run import computed_records_with_progress
    from worker.commands.settle import read_device
    from worker.pairs.selection import chosen_pair

    observation = None if watch is None else parse_observation(watch)
    threads = chosen_pair(pair, dimension or ())
    check_pair(threads)
    held = default_device() if device is None else read_device(device)
    inputs = ChancesInputs(threads, held, strategy, uncertainty, point_limit)
    settings = read_settings()
    computing = chosen_scheduler(settings, scheduler, workers)
    result = computed_records_with_progress(inputs, samples, workers or settings.workers, out, computing)
    elapsed_s = time.perf_counter() - began
    (print_chances_json if as_json else print_chances)(inputs, result, observation, elapsed_s, unit or threads.unit)


def _uncertainty(tilt_mean: str, tilt_sd: float, mu: str) -> Uncertainty:
    from threadstate.chances.sampling import Uncertainty

    low, _, high = mu.partition(":")
    valid = "a number or LOW:HIGH, as 0.05:0.2"
    frictions = (_number("mu", low, mu, valid), _number("mu", high if ":" in mu else low, mu, valid))
    roll, is_pair, pitch = tilt_mean.partition(",")
    valid = "ROLL,PITCH in degrees, as 0,-2"
    if not is_pair:
        raise InvalidValueError("tilt_mean", tilt_mean, valid)
    mean = (_number("tilt_mean", roll, tilt_mean, valid), _number("tilt_mean", pitch, tilt_mean, valid))
    return Uncertainty(mean, tilt_sd, frictions)


def _number(name: str, text: str, given: str, valid: str) -> float:
    try:
        return number(text.strip())
    except ValueError:
        raise InvalidValueError(name, given, valid) from None
