"""``threadstate mesh``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from threadstate.errors import InvalidValueError
from threadstate.mesh.options import Scene
from threadstate.mesh.presets import Preset, Tessellation
from threadstate.thread.pair import Part
from worker.options import Dimensions, Json, PairName, UnitName, number_option
from worker.output import print_json, print_line


def mesh(
    part: Annotated[Part, typer.Option("--part", help="Which of the pair.")],
    out: Annotated[Path, typer.Option("--out", metavar="FILE", help="File to write: .stl, .ply or .glb.")],
    preset: Annotated[Preset, typer.Option("--preset", help="How finely the part is tessellated.")] = Preset.PAPER,
    chord: Annotated[
        float | None,
        number_option(
            "--chord",
            metavar="LENGTH",
            help="Largest distance from the true surface.",
            show_default="the preset's",
        ),
    ] = None,
    angle_control: Annotated[
        float | None,
        number_option(
            "--angle-control",
            metavar="NUMBER",
            help="0 to 1: how much finer curves of small radius are.",
            show_default="the preset's",
        ),
    ] = None,
    scene: Annotated[Scene, typer.Option("--scene", help="How much of the part is modelled.")] = Scene.FULL,
    pair: PairName = None,
    dimension: Dimensions = None,
    unit: UnitName = None,
    as_json: Json = False,
) -> None:
    r"""Write the bolt or the nut as a closed triangle mesh, as STL, PLY or GLB by the file's ending.

    The bolt is hollow, the nut is cut from a prism of 16 sides; each is one thread pitch long and in its own frame.
    Numbers are in the pair's own unit or in that of --unit. Scenes other than "full" leave out what cannot touch: their
    meshes are open.

    \b
    Examples:
      threadstate mesh --part bolt --out bolt.stl
      threadstate mesh --part nut --preset fine --out nut.glb --json
      threadstate mesh --part bolt --chord 5e-5 --angle-control 1 --out bolt.ply
      threadstate mesh --part nut --preset fine --scene edges --out nut.stl
      threadstate mesh --part bolt --unit mm --out bolt.stl
      threadstate mesh --part bolt --pair examples/m6x1.toml --out bolt.stl
    """
    from threadstate.mesh.export import file_ending, mesh_report, write_mesh
    from threadstate.mesh.scene import scene_part
    from threadstate.thread.catalogue import source_of
    from threadstate.units import conversion_factor
    from worker.pairs.selection import chosen_pair

    ending = file_ending(out)
    if scene is Scene.CURVES:
        raise InvalidValueError("--scene", scene.value, "full, band, edges (curves has no triangles)")
    threads = chosen_pair(pair, dimension or ())
    shown = unit or threads.unit
    factor = conversion_factor(threads.unit, shown)
    chosen = preset.tessellation
    tessellation = Tessellation(
        chosen.chord_height if chord is None else chord / factor / threads.thread_pitch,
        chosen.angle_control if angle_control is None else angle_control,
    )
    solid = scene_part(threads, part, tessellation, scene)
    size = write_mesh(replace(solid, vertices=solid.vertices * factor), out)
    report = mesh_report(threads, part, tessellation, scene)
    if as_json:
        print_json(
            {
                "part": part.value,
                "scene": scene.value,
                "pair": threads.designation,
                "source": source_of(threads),
                "unit": shown.value,
                "file": str(out),
                "format": ending,
                "bytes": size,
                "chord_height": tessellation.chord_height * threads.thread_pitch * factor,
                "angle_control": tessellation.angle_control,
                "vertices": report.vertices,
                "triangles": report.triangles,
                "watertight": report.watertight,
                "volume": report.volume * factor**3,
                "chord_deviation": report.chord_deviation * factor,
                "edge_deviation": report.edge_deviation * factor,
            }
        )
        return
    print_line(f"{out}: {part.value} of {threads.designation}, {report.triangles} triangles, {size} bytes")
    if scene is Scene.FULL:
        closed = "watertight" if report.watertight else "NOT watertight"
        print_line(f"{closed}, volume {report.volume * factor**3:.6g} {shown}^3")
    else:
        print_line(f"scene {scene.value}: open where nothing can touch")
    print_line(
        f"at most {report.chord_deviation * factor:.2g} {shown} from the true surface, "
        f"{report.edge_deviation * factor:.2g} {shown} from the true edge curve"
    )
