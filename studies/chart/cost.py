"""What a scene costs before the first pose: triangles, memory, time."""

from __future__ import annotations

import multiprocessing
import resource
import sys
import time
from dataclasses import dataclass

from studies.chart.contestant import ByMesh
from studies.chart.measure import mesh_method
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.part_name import Part
from threadstate.mesh.presets import Preset
from threadstate.mesh.scene import scene_part
from threadstate.mesh.scene_name import Scene
from threadstate.thread.pair import Pair


@dataclass(frozen=True)
class SceneCost:
    """Triangles of both parts; memory (bytes) that meshes and search trees add to a fresh process; CPU seconds."""

    scene: Scene
    preset: Preset
    triangles: int
    memory: int
    seconds: float


def scene_cost(pair: Pair, scene: Scene, preset: Preset) -> SceneCost:
    """The cost of a scene, measured in a process of its own."""
    with multiprocessing.get_context("forkserver").Pool(1) as pool:
        return pool.apply(_cost, (pair, scene, preset))


def _cost(pair: Pair, scene: Scene, preset: Preset) -> SceneCost:
    # What is compiled and imported at first use is no part of the scene.
    mesh_method(ByMesh(MeshOptions(Preset.COARSE.tessellation, scene=scene)), pair)
    before, began = _peak(), time.process_time()
    method = mesh_method(ByMesh(MeshOptions(preset.tessellation, scene=scene)), pair)
    seconds, memory = time.process_time() - began, _peak() - before
    parts = [scene_part(method.pair, part, preset.tessellation, scene) for part in Part]
    return SceneCost(scene, preset, sum(len(part.triangles) for part in parts), memory, seconds)


def _peak() -> int:
    """The most memory that this process has had, in bytes."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak if sys.platform == "darwin" else 1024 * peak
