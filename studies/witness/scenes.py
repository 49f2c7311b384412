"""Random states under random loads, on points and on level patches."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import count

import numpy as np
from numpy.typing import NDArray

from benchmarks.sample import sample_poses
from threadstate.contact import _record_kernel as rk
from threadstate.errors import UnresolvedPoseError
from threadstate.state.model import ContactState
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.state.solve import solve_poses
from threadstate.statics.jamming import thinned
from threadstate.statics.touching import touching
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

SEED = 17
BATCH = 2000
PATCH_EVERY = 8
"""Every so many scenes one lies on a level patch."""
PATCH_TOLERANCE = 1e-2
"""Corners of a hull nearer to its chords, over the radius, are left out: with all the witness takes a second."""
LARGEST_FRICTION = 1.2


class LoadKind(StrEnum):
    """How a load is drawn."""

    PUSHED = "push and noise"
    HELD = "held by random forces within friction cones"
    SUPPORTED = "supported by random normal forces"


@dataclass(frozen=True)
class Scene:
    """Contacts about the bolt's origin, points (k, 3) over the nominal radius, and a load (moment over it, force)."""

    pose_deg: tuple[float, float, float]
    patch: bool
    points: Floats
    normals: Floats
    kind: LoadKind
    load: Floats


def scenes(pair: Pair) -> Iterator[Scene]:
    """Scenes without end, the same in every run: two or three contacts, and every eighth on a level patch."""
    rng = np.random.default_rng(SEED)
    on_points, on_patches = _states(pair, flush=False), _states(pair, flush=True)
    radius = pair.nominal_diameter / 2.0
    for number in count():
        state = next(on_patches if number % PATCH_EVERY == PATCH_EVERY - 1 else on_points)
        try:
            found = touching(pair, state)
        except UnresolvedPoseError:
            continue
        points, normals = found.points, found.normals
        if found.patch:
            hull = points[found.own :]
            kept, _ = thinned(hull[:, :2], PATCH_TOLERANCE * radius)
            points, normals = hull[kept], normals[found.own :][kept]
        kind = _kind(number)
        scaled = (points - np.array(found.origin)) / radius
        load = _load(rng, kind, scaled, normals)
        pose = state.roll_deg, state.pitch_deg, state.phase_deg
        yield Scene(pose, found.patch, scaled, np.array(normals), kind, load)


def _kind(number: int) -> LoadKind:
    return (LoadKind.PUSHED, LoadKind.HELD, LoadKind.PUSHED, LoadKind.HELD, LoadKind.SUPPORTED)[number % 5]


def _states(pair: Pair, *, flush: bool) -> Iterator[ContactState]:
    for batch in count(1):
        poses = sample_poses(batch * BATCH)[-BATCH:]
        records = solve_records(pair, SolveOptions(), poses)
        chosen = [
            tuple(pose)
            for pose, record in zip(poses.tolist(), records, strict=True)
            if record[rk.O_STATUS] == 0.0 and bool(int(record[rk.O_FLAGS]) & rk.FLAG_FLUSH) == flush
        ]
        yield from solve_poses(pair, chosen)


def _load(rng: np.random.Generator, kind: LoadKind, points: Floats, normals: Floats) -> Floats:
    noise, weights = rng.normal(size=6), rng.exponential(size=len(points))
    across, friction = rng.normal(size=points.shape), rng.uniform(0.0, LARGEST_FRICTION)
    if kind is LoadKind.PUSHED:
        return np.asarray(np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0]) + 0.2 * noise)
    forces = weights[:, np.newaxis] * normals
    if kind is LoadKind.HELD:
        across -= np.einsum("ka,ka->k", across, normals)[:, np.newaxis] * normals
        across /= np.linalg.norm(across, axis=1)[:, np.newaxis]
        forces += (friction * weights)[:, np.newaxis] * across
    return -np.concatenate([np.cross(points, forces).sum(axis=0), forces.sum(axis=0)])
