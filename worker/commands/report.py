"""``threadstate report``."""

from __future__ import annotations

import datetime
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from threadstate.atomic_file import replaced_file
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.settings import read_settings
from worker.commands.success import LARGEST_PHASES, grid_of
from worker.options import (
    DeviceFile,
    Dimensions,
    PairName,
    Phase,
    Pitch,
    Roll,
    Scheduler,
    UnitName,
    Workers,
    chosen_scheduler,
    integer_option,
    number_option,
)
from worker.output import print_line

if TYPE_CHECKING:
    from threadstate.library.grid import Grid
    from threadstate.report.contents import ChosenPath
    from threadstate.success.inputs import SuccessInputs
    from threadstate.success.model import OrientationMap
    from threadstate.units import LengthUnit

ENDING = ".html"
THE_FILES = "that of --map, else"


def report(
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="The page, .html; one that is there is replaced.")],
    map_file: Annotated[
        Path | None,
        typer.Option("--map", metavar="FILE", help="A map of `threadstate success --out`; it is gone on with or made."),
    ] = None,
    roll: Roll = None,
    pitch: Pitch = None,
    phase: Phase = None,
    path_mu: Annotated[
        float | None,
        number_option(
            "--path-mu",
            metavar="M",
            help="Friction of that pose's path, 0 to 1.",
            show_default="the map's least",
        ),
    ] = None,
    title: Annotated[
        str | None, typer.Option("--title", metavar="TEXT", help="The title.", show_default="the pair's designation")
    ] = None,
    date: Annotated[
        str | None, typer.Option("--date", metavar="DATE", help="The date on it, as 2026-01-31.", show_default="today")
    ] = None,
    unit: UnitName = None,
    pair: PairName = None,
    dimension: Dimensions = None,
    device: DeviceFile = None,
    strategy: Annotated[
        Strategy | None,
        typer.Option("--strategy", help="How the hand turns.", show_default=f"{THE_FILES} ccw_then_cw"),
    ] = None,
    mu: Annotated[
        str | None,
        typer.Option(
            "--mu", metavar="M", help="Frictions of the map, with commas.", show_default=f"{THE_FILES} 0.1,0.2,0.3"
        ),
    ] = None,
    phases: Annotated[
        int | None,
        integer_option(
            "--phases",
            metavar="N",
            min=1,
            max=LARGEST_PHASES,
            help="Starting phases of an orientation.",
            show_default=f"{THE_FILES} 12",
        ),
    ] = None,
    tilt_max: Annotated[
        float | None,
        number_option("--tilt-max", metavar="DEG", help="Largest roll and pitch.", show_default=f"{THE_FILES} 4"),
    ] = None,
    tilt_step: Annotated[
        float | None,
        number_option("--tilt-step", metavar="DEG", help="Step of both.", show_default=f"{THE_FILES} 1"),
    ] = None,
    phase_tolerance: Annotated[
        float | None,
        number_option(
            "--phase-tolerance", metavar="DEG", help="As of `threadstate success`.", show_default=f"{THE_FILES} 2"
        ),
    ] = None,
    mu_tolerance: Annotated[
        float | None,
        number_option(
            "--mu-tolerance", metavar="M", help="As of `threadstate success`.", show_default=f"{THE_FILES} 0.01"
        ),
    ] = None,
    point_limit: Annotated[
        int | None,
        integer_option(
            "--point-limit", metavar="N", help="As of `threadstate success`.", show_default=f"{THE_FILES} 1000"
        ),
    ] = None,
    workers: Workers = None,
    scheduler: Scheduler = None,
) -> None:
    r"""Write a report of a device to one HTML file: its success map and one path, in words, figures and tables.

    With --map the pair, the device and all options of the map are those of its file. The path in detail is the worst
    that engages, or that of --roll, --pitch and --phase.

    \b
    Examples:
      threadstate report --out report.html --map device.map
      threadstate report --out report.html --tilt-max 4 --tilt-step 4 --phases 2 --mu 0 --title "Wrist B"
      threadstate report --out report.html --map device.map --roll 3 --pitch -2 --phase 0 --path-mu 0.1 --unit mm
    """
    _check_files(out, map_file)
    _check_title(title)
    on = datetime.datetime.now(datetime.UTC).date() if date is None else _date(date)
    from threadstate.device.settle import check_pair
    from threadstate.success.inputs import SuccessInputs
    from threadstate.success.map_file import inputs_of_map
    from worker.success.run import computed_map_with_progress

    known = None if map_file is None else inputs_of_map(map_file)
    given = _given(pair, dimension, device, strategy, mu, is_known=known is not None)
    numbers = {
        "phase_tolerance_deg": phase_tolerance,
        "mu_tolerance": mu_tolerance,
        "point_limit": point_limit,
        "grid": _grid(known, tilt_max, tilt_step, phases),
    }
    given |= {name: value for name, value in numbers.items() if value is not None}
    inputs = SuccessInputs(**given) if known is None else replace(known, **given)
    check_pair(inputs.pair)
    pose = _pose(roll, pitch, phase, path_mu, inputs)
    settings = read_settings()
    computing = chosen_scheduler(settings, scheduler, workers)
    result = computed_map_with_progress(inputs, workers or settings.workers, map_file, computing)
    written = _page(inputs, result.orientations, pose, unit=unit, title=title, date=on)
    with replaced_file(out) as file:
        file.write(written.encode())
    print_line(f"{out}: {len(result.orientations)} orientations, map {result.content_sha256[:12]}")


def _check_files(out: Path, map_file: Path | None) -> None:
    """Check the names of the files before anything is computed."""
    if out.suffix.lower() != ENDING or out.is_dir():
        raise InvalidValueError("--out", str(out), f"a file whose name ends in {ENDING}")
    if not out.absolute().parent.is_dir():
        raise InvalidValueError("--out", str(out), "a file in a folder that exists")
    if map_file is not None and map_file.absolute() == out.absolute():
        raise InvalidValueError("--map", str(map_file), "another file than --out")


def _check_title(title: str | None) -> None:
    """Check that a title is text: what a shell passes need not be."""
    try:
        (title or "").encode()
    except UnicodeEncodeError:
        raise InvalidValueError("--title", title, "text in UTF-8") from None


def _date(text: str) -> datetime.date:
    try:
        return datetime.date.fromisoformat(text)
    except ValueError:
        raise InvalidValueError("--date", text, "a day as 2026-01-31") from None


def _given(
    pair: str | None,
    dimension: list[str] | None,
    device: Path | None,
    strategy: Strategy | None,
    mu: str | None,
    *,
    is_known: bool,
) -> dict[str, Any]:
    """What options say of a map; without a file that knows them pair, device and strategy are the default ones."""
    from threadstate.device.model import default_device
    from threadstate.responses.query import parse_frictions
    from worker.commands.settle import read_device
    from worker.pairs.selection import chosen_pair

    given: dict[str, Any] = {}
    if pair is not None or dimension or not is_known:
        given["pair"] = chosen_pair(pair, dimension or ())
    if device is not None or not is_known:
        given["device"] = default_device() if device is None else read_device(device)
    if strategy is not None or not is_known:
        given["strategy"] = strategy or Strategy.CCW_THEN_CW
    if mu is not None:
        given["frictions"] = parse_frictions(mu)
    return given


def _grid(known: SuccessInputs | None, tilt_max: float | None, tilt_step: float | None, phases: int | None) -> Grid:
    """The grid of the options, and of the map's file, or the default one, where they say nothing."""
    base = grid_of(4.0, 1.0, 12) if known is None else known.grid
    return grid_of(
        base.tilt_max_deg if tilt_max is None else tilt_max,
        base.tilt_step_deg if tilt_step is None else tilt_step,
        phases or base.phase_count,
    )


def _pose(
    roll: float | None, pitch: float | None, phase: float | None, path_mu: float | None, inputs: SuccessInputs
) -> ChosenPath | None:
    """The path that options name; None where they name none."""
    from threadstate.device.settle import check_friction
    from threadstate.report.contents import ChosenPath
    from threadstate.state.solve import checked_poses

    named = {"roll": roll, "pitch": pitch, "phase": phase}
    if path_mu is not None and None in named.values():
        raise InvalidValueError("--path-mu", path_mu, "a friction beside --roll, --pitch and --phase")
    if roll is pitch is phase is None:
        return None
    if roll is None or pitch is None or phase is None:
        missing = next(name for name, value in named.items() if value is None)
        raise InvalidValueError(f"--{missing}", None, "an angle in degrees beside those of the others, or none of them")
    checked_poses([(roll, pitch, phase)])
    mu = inputs.frictions[0] if path_mu is None else path_mu
    check_friction(mu)
    return ChosenPath(roll, pitch, phase, mu, "This path was asked for.", is_default=False)


def _page(
    inputs: SuccessInputs,
    orientations: Sequence[OrientationMap],
    pose: ChosenPath | None,
    *,
    unit: LengthUnit | None,
    title: str | None,
    date: datetime.date,
) -> str:
    """The page of a whole map; the path in detail is computed."""
    from threadstate.device.assemble import assemble_pose
    from threadstate.library.identity import COMPUTING
    from threadstate.report.contents import default_path, made_report
    from threadstate.report.page import report_page

    chosen = pose or default_path(inputs, orientations)
    angles = (chosen.roll_deg, chosen.pitch_deg, chosen.phase_deg)
    path = assemble_pose(inputs.pair, *angles, inputs.device, inputs.strategy, mu=chosen.mu)
    made = made_report(
        inputs,
        orientations,
        chosen,
        path,
        unit=unit or inputs.pair.unit,
        title=title or f"Assembly of {inputs.pair.designation}",
        date=date,
        libraries=[(name, version(name)) for name in COMPUTING],
    )
    return report_page(made)
