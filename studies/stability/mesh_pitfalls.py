"""What a mesh method would give that used the collision library's pairs unfiltered."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass

import numpy as np

from studies.methods import Case, MeshStates
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.clusters import Cluster, Connectivity
from threadstate.mesh.collision import Collider
from threadstate.mesh.part import part_solid
from threadstate.mesh.segments import Intersection
from threadstate.mesh.solid import Floats, Solid
from threadstate.mesh.solve import mesh_procedure
from threadstate.mesh.touch import cluster_segments
from threadstate.state.model import ContactState, StagePose
from threadstate.thread.pair import Pair, Part

AVERAGED_DEG = (-4.0, 0.0, 131.0)
"""Its second pose has two contacts, 0.2 in apart."""
FLUSH_DEG = (4.0, 0.0, 185.0)
"""Its second pose is flush."""
SEED = 5


@dataclass(frozen=True)
class MeshPitfalls:
    """The numbers of the three pitfalls.

    ``averaged_off`` is how far, in inches, the mean of all midpoints at two contacts is from the nearer of them;
    ``clusters`` how many there are. ``flush_pairs`` triangles collide in a flush pose, ``flush_met`` of them in a
    segment. ``types`` counts the pairs of all first contacts of a sample by how they meet; in
    ``poses_without_contact`` of these poses one of the pairs does not meet.
    """

    clusters: int
    averaged_off: float
    flush_pairs: int
    flush_met: int
    poses: int
    types: Counter[Intersection]
    poses_without_contact: int


def mesh_pitfalls(method: MeshStates, sample: int, pair: Pair) -> MeshPitfalls:
    """The three pitfalls, on the meshes of that method; ``sample`` is the number of random poses."""
    bolt, nut = (part_solid(pair, part, method.options.tessellation) for part in Part)
    collider, connectivity = Collider(bolt, nut), Connectivity(bolt, nut)

    def met(T_nut_bolt: Floats) -> tuple[Cluster, ...]:
        return connectivity.clusters(collider.pairs(T_nut_bolt))

    two = _second_pose(method, pair, AVERAGED_DEG)
    clusters = met(two)
    midpoints = [_midpoints(cluster, bolt, nut, two) for cluster in clusters]
    mean = np.concatenate(midpoints).mean(axis=0)
    off = min(float(np.linalg.norm(mean - points.mean(axis=0))) for points in midpoints)
    flush = _second_pose(method, pair, FLUSH_DEG)
    in_plane = [segment for cluster in met(flush) for segment in cluster_segments(cluster, bolt, nut, flush).types]
    types: Counter[Intersection] = Counter()
    poses_without_contact = 0
    poses = np.random.default_rng(SEED).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (sample, 3))
    for roll, pitch, phase in poses.tolist():
        try:
            pose, found = mesh_procedure(pair, method.options).first_pose((roll, pitch, phase))
        except MeshUndecidedError:
            continue
        here = Counter(
            Intersection(kind) for one in found for kind in cluster_segments(one, bolt, nut, pose).types.tolist()
        )
        types.update(here)
        poses_without_contact += bool(here[Intersection.IV] or here[Intersection.V])
    met_in_plane = sum(Intersection(kind) not in (Intersection.IV, Intersection.V) for kind in in_plane)
    return MeshPitfalls(len(clusters), off, len(in_plane), met_in_plane, sample, types, poses_without_contact)


def _second_pose(method: MeshStates, pair: Pair, pose_deg: tuple[float, float, float]) -> Floats:
    (answer,) = method.answers([Case(pair, pose_deg)])
    assert isinstance(answer, ContactState), f"the mesh method refuses {pose_deg}"
    return _matrix(answer.poses[1])


def _matrix(pose: StagePose) -> Floats:
    matrix = np.eye(4)
    matrix[:3, :3] = pose.rotation
    matrix[:3, 3] = pose.translation
    return matrix


def _midpoints(cluster: Cluster, bolt: Solid, nut: Solid, T_nut_bolt: Floats) -> Floats:
    segments = cluster_segments(cluster, bolt, nut, T_nut_bolt)
    real = np.isin(segments.types, (Intersection.I, Intersection.II, Intersection.III))
    return np.asarray(segments.midpoints[real])
