"""``threadstate mesh``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.mesh.part_name import Part
from threadstate.mesh.presets import Preset, Tessellation
from threadstate.mesh.scene_name import Scene
from worker.options import Designation, Json
from worker.output import print_json, print_line


def mesh(
    part: Annotated[Part, typer.Option("--part", help="Which of the pair.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="File to write: .stl, .ply or .glb.")],
    preset: Annotated[Preset, typer.Option("--preset", help="How finely the part is tessellated.")] = Preset.PAPER,
    chord: Annotated[
        float | None,
        typer.Option(
            "--chord",
            metavar="LENGTH",
            help="Largest distance from the true surface, in the pair's unit.",
            show_default="the preset's",
        ),
    ] = None,
    angle_control: Annotated[
        float | None,
        typer.Option(
            "--angle-control",
            metavar="NUMBER",
            help="0 to 1: how much finer curves of small radius are.",
            show_default="the preset's",
        ),
    ] = None,
    scene: Annotated[Scene, typer.Option("--scene", help="How much of the part is modelled.")] = Scene.FULL,
    pair: Designation = None,
    as_json: Json = False,
) -> None:
    r"""Write the bolt or the nut as a closed triangle mesh, as STL, PLY or GLB by the file's ending.

    The bolt is hollow, the nut is cut from a prism of 16 sides; each is one thread pitch long, in its own frame, its
    numbers in the pair's own unit. Scenes other than "full" leave out what cannot touch: their meshes are open.

    \b
    Examples:
      threadstate mesh --part bolt --out bolt.stl
      threadstate mesh --part nut --preset fine --out nut.glb --json
      threadstate mesh --part bolt --chord 5e-5 --angle-control 1 --out bolt.ply
      threadstate mesh --part nut --preset fine --scene edges --out nut.stl
    """
    from threadstate.mesh.export import file_ending, mesh_report, write_mesh
    from threadstate.mesh.scene import scene_part
    from threadstate.thread.catalogue import DEFAULT_DESIGNATION, pair_by_designation

    ending = file_ending(out)
    if scene is Scene.CURVES:
        raise InvalidValueError("--scene", scene.value, "full, band, edges (curves has no triangles)")
    threads = pair_by_designation(DEFAULT_DESIGNATION if pair is None else pair)
    chosen = preset.tessellation
    tessellation = Tessellation(
        chosen.chord_height if chord is None else chord / threads.thread_pitch,
        chosen.angle_control if angle_control is None else angle_control,
    )
    size = write_mesh(scene_part(threads, part, tessellation, scene), out)
    report = mesh_report(threads, part, tessellation, scene)
    if as_json:
        print_json(
            {
                "part": part.value,
                "scene": scene.value,
                "pair": threads.designation,
                "unit": threads.unit.value,
                "file": str(out),
                "format": ending,
                "bytes": size,
                "chord_height": tessellation.chord_height * threads.thread_pitch,
                "angle_control": tessellation.angle_control,
                "vertices": report.vertices,
                "triangles": report.triangles,
                "watertight": report.watertight,
                "volume": report.volume,
                "chord_deviation": report.chord_deviation,
                "edge_deviation": report.edge_deviation,
            }
        )
        return
    unit = threads.unit.value
    print_line(f"{out}: {part.value} of {threads.designation}, {report.triangles} triangles, {size} bytes")
    if scene is Scene.FULL:
        print_line(f"{'watertight' if report.watertight else 'NOT watertight'}, volume {report.volume:.6g} {unit}^3")
    else:
        print_line(f"scene {scene.value}: open where nothing can touch")
    print_line(
        f"at most {report.chord_deviation:.2g} {unit} from the true surface, "
        f"{report.edge_deviation:.2g} {unit} from the true edge curve"
    )
