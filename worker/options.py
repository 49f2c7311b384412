"""Options that several commands share. Numbers are parsed by :mod:`threadstate.numbers`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, NoReturn

import typer

from threadstate import settings
from threadstate.errors import InvalidValueError
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, MeshOptions, Scene, Tangent
from threadstate.mesh.presets import Preset
from threadstate.numbers import integer, number
from threadstate.units import LengthUnit


def number_option(name: str, **described: Any) -> Any:
    """An option that is a number; ``described`` as for ``typer.Option``."""
    return typer.Option(name, parser=lambda value: _parsed(number, value), **described)


def integer_option(name: str, *, min: int | None = None, max: int | None = None, **described: Any) -> Any:  # noqa: A002
    """An option that is a whole number from ``min`` to ``max``; ``described`` as for ``typer.Option``."""

    def parse(value: object) -> object:
        found = _parsed(integer, value)
        if min is not None and found < min:
            _refuse(f"{found} is below {min}")
        if max is not None and found > max:
            _refuse(f"{found} is above {max}")
        return found

    return typer.Option(name, parser=parse, min=min, max=max, **described)


def _parsed(read: Callable[[str], float], value: Any) -> Any:
    """Parse a text; defaults, which are not texts, pass."""
    if not isinstance(value, str):
        return value
    try:
        return read(value)
    except ValueError as error:
        _refuse(str(error))


def _refuse(reason: str) -> NoReturn:
    # Loaded when it is needed: `threadstate --help` does without.
    from pydantic_core import PydanticCustomError

    raise PydanticCustomError("number", "{reason}", {"reason": reason})


Roll = Annotated[float | None, number_option("--roll", metavar="DEG", help="Roll, -10 to 10.")]
Pitch = Annotated[float | None, number_option("--pitch", metavar="DEG", help="Pitch, -10 to 10.")]
Phase = Annotated[float | None, number_option("--phase", metavar="DEG", help="Phase, any finite angle.")]
Poses = Annotated[
    Path | None,
    typer.Option("--poses", metavar="FILE", help="CSV file of poses, header roll,pitch,phase; /dev/stdin works."),
]

Database = Annotated[
    str | None,
    typer.Option(
        "--database",
        metavar="URL",
        help="A SQLite file (sqlite:////absolute/path/file.sqlite3) or a PostgreSQL database "
        "(postgresql+psycopg://user@host/name).",
        show_default=f"{settings.DATABASE}, else a file in the data directory",
    ),
]

LibraryName = Annotated[
    str | None,
    typer.Option(
        "--library",
        metavar="NAME",
        help="Which library: its number, its thread's designation or slug, latest, or latest-mesh.",
        show_default="latest",
    ),
]

UnitName = Annotated[
    LengthUnit | None, typer.Option("--unit", help="Unit of all lengths.", show_default="the thread's own")
]

MethodName = Annotated[SolverMethod, typer.Option("--method", help="How states are found.")]

Json = Annotated[bool, typer.Option("--json", help="Print JSON.", show_default=False)]

PairName = Annotated[
    str | None,
    typer.Option(
        "--pair",
        metavar="NAME",
        help='A thread, such as M6-6g/6H or "1/4-20 UNC at minimum material", or a TOML file of dimensions; with '
        "--dimension, a name for it.",
        show_default=f"{settings.PAIR}, else 1/4-20 UNC",
    ),
]
Dimensions = Annotated[
    list[str] | None,
    typer.Option(
        "--dimension",
        metavar="KEY=VALUE",
        help="A dimension of one's own pair, as thread_pitch=1 or fit.nut_pitch_diameter=5.35; any number of times.",
    ),
]

DeviceFile = Annotated[
    Path | None,
    typer.Option(
        "--device",
        metavar="FILE",
        help="The device as a TOML or JSON file.",
        show_default="the device of docs/device.md",
    ),
]

PhaseStep = Annotated[float, number_option("--phase-step", metavar="DEG", help="Step of phase; divides 360.")]
TiltMax = Annotated[float, number_option("--tilt-max", metavar="DEG", help="Largest roll and pitch; at most 10.")]
TiltStep = Annotated[
    float, number_option("--tilt-step", metavar="DEG", help="Step of roll and pitch; divides the largest.")
]
Workers = Annotated[
    int | None,
    integer_option(
        "--workers",
        metavar="N",
        min=1,
        max=settings.LARGEST_WORKER_COUNT,
        help="Processes that compute.",
        show_default=f"{settings.WORKERS}, else one a processor",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="URL",
        help="Dask scheduler whose workers compute, tcp://host:port.",
        show_default=f"{settings.SCHEDULER}, else processes here",
    ),
]
Host = Annotated[
    str | None,
    typer.Option(
        "--host", metavar="ADDRESS", help="Address to listen on.", show_default=f"{settings.HOST}, else 127.0.0.1"
    ),
]
Port = Annotated[
    int | None,
    integer_option(
        "--port", metavar="N", min=1, max=65535, help="Port to listen on.", show_default=f"{settings.PORT}, else 8000"
    ),
]


def chosen_scheduler(read: settings.Settings, scheduler: str | None, workers: int | None) -> str | None:
    """The scheduler whose workers compute; None: processes here do, as where their number is an option.

    Raises:
        InvalidValueError: both are options.
    """
    if scheduler is not None and workers is not None:
        raise InvalidValueError("--workers", workers, "without --scheduler alone: a scheduler's workers compute there")
    return read.scheduler if scheduler is None and workers is None else scheduler


PresetName = Annotated[
    Preset | None,
    typer.Option("--preset", help="Mesh: how finely the parts are tessellated.", show_default=Preset.PAPER.value),
]
DescentName = Annotated[
    Descent | None,
    typer.Option("--descent", help="Mesh: how motions are stepped; decades tunnel.", show_default=Descent.SAFE.value),
]
FinalStepName = Annotated[
    FinalStep | None,
    typer.Option(
        "--final-step",
        help="Mesh: the smallest step, on a pitch of 0.05 in.",
        show_default=FinalStep.ONE_MICROINCH.value,
    ),
]
TangentName = Annotated[
    Tangent | None,
    typer.Option("--tangent", help="Mesh: the axis of the second turn.", show_default=Tangent.EDGE.value),
]
SceneName = Annotated[
    Scene | None,
    typer.Option("--scene", help="Mesh: how much of the parts is modelled.", show_default=DEFAULT_SCENE.value),
]
Unchecked = Annotated[
    bool,
    typer.Option("--unchecked", help="Mesh: without a second tessellation that has to agree.", show_default=False),
]


def mesh_options(
    method: SolverMethod,
    preset: Preset | None,
    descent: Descent | None,
    final_step: FinalStep | None,
    tangent: Tangent | None,
    scene: Scene | None,
    *,
    unchecked: bool,
) -> MeshOptions | None:
    """The options of the mesh method; None for another solver method.

    Raises:
        InvalidValueError: options of meshes are given for another solver method.
    """
    if method is SolverMethod.MESH:
        return MeshOptions(
            tessellation=(preset or Preset.PAPER).tessellation,
            descent=descent or Descent.SAFE,
            final_step=(final_step or FinalStep.ONE_MICROINCH).thread_pitches,
            tangent=tangent or Tangent.EDGE,
            scene=scene or DEFAULT_SCENE,
            checked=not unchecked,
        )
    chosen = {"preset": preset, "descent": descent, "final-step": final_step, "tangent": tangent, "scene": scene}
    given = {name: value.value for name, value in chosen.items() if value is not None}
    if unchecked:
        given["unchecked"] = "given"
    for name, value in given.items():
        raise InvalidValueError(f"--{name}", value, "a setting of --method mesh alone")
    return None
