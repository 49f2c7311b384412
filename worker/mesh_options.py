"""The options of commands that can find states by meshes."""

from __future__ import annotations

from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import DEFAULT_SCENE, Descent, FinalStep, MeshOptions, Tangent
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene_name import Scene

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
    """What was chosen of meshes; None where the method is another.

    Raises:
        InvalidValueError: something was chosen, and the method is another.
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
