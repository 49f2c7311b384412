"""``make bench``: least frictions in closed forms, by a conic solver, and by nnls and linprog on pyramids."""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.progress import track
from scipy.optimize import linprog, nnls

from benchmarks.sample import sample_poses
from oracle.statics.friction import hold_friction, wedge_friction
from oracle.statics.wrenches import Wrench
from threadstate.contact import _record_kernel as rk
from threadstate.state.options import SolveOptions
from threadstate.state.records import solve_records
from threadstate.statics import _numbers_kernel as nk
from threadstate.statics._last_pose_kernel import set_contacts
from threadstate.statics.numbers import contact_numbers
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair

Floats = NDArray[np.float64]

SIDES = 16
"""Of the pyramids, inscribed in the friction cones: what they hold the cones hold."""
HALVINGS = 30
MOST_MU = 20.0
"""A least friction above it is none for the pyramids."""
BALANCED = 1e-9
"""What nnls may leave of a load, over it."""
AGREE = 1e-7
"""Angles of friction (rad) that differ by less agree."""


@dataclass(frozen=True)
class Scene:
    """Contacts about the bolt's origin, over the nominal radius r, and a load (moment over r, force)."""

    pose_deg: tuple[float, float, float]
    points: Floats
    normals: Floats
    load: Floats


@dataclass(frozen=True)
class Contestant:
    """How many states a second a way finds the least holding friction of, and of the closed forms the wedging one too.

    ``ratio`` is how many times as many the closed forms do. ``worst`` is the largest difference of friction angles
    (rad) from theirs.
    """

    name: str
    states: int
    states_per_second: float
    ratio: float
    worst: float


@dataclass(frozen=True)
class Disagreement:
    """A state of which the conic solver's certified bounds and those of the closed forms have no angle in common."""

    pose_deg: tuple[float, float, float]
    load: tuple[float, ...]
    number: str
    ours: tuple[float, float]
    theirs: tuple[float, float]


def scenes(pair: Pair, count: int) -> list[Scene]:
    """Random states with two or three contacts under random loads that mostly push."""
    poses = sample_poses(3 * count)
    records = solve_records(pair, SolveOptions(), poses)
    rng = np.random.default_rng(17)
    radius = pair.nominal_diameter / 2.0
    found: list[Scene] = []
    for pose, record in zip(poses, records, strict=True):
        k = int(record[rk.O_CONTACTS])
        if record[rk.O_STATUS] != 0.0 or int(record[rk.O_FLAGS]) & rk.FLAG_FLUSH or len(found) == count:
            continue
        points, normals = np.empty((k, 3)), np.empty((k, 3))
        if set_contacts(record, pair.bolt.packed, pair.nut.packed, points, normals) == k:
            roll, pitch, phase = pose.tolist()
            load = np.array([0.0, 0.0, 0.0, 0.0, 0.0, -1.0]) + 0.2 * rng.normal(size=6)
            found.append(Scene((roll, pitch, phase), points / radius, normals, load))
    return found


def closed_forms(some: list[Scene]) -> Floats:
    """Rows of numbers of scenes."""
    return np.array([contact_numbers(nk.EVERY_NUMBER, scene.load, scene.points, scene.normals).row for scene in some])


def pyramid_rays(scene: Scene, mu: float) -> Floats:
    """The wrenches (6, k SIDES) of the edges of the pyramids."""
    angles = np.linspace(0.0, 2.0 * math.pi, SIDES, endpoint=False)
    rays = []
    for point, normal in zip(scene.points, scene.normals, strict=True):
        across = np.linalg.svd(normal[np.newaxis])[2][1:]
        forces = normal + mu * (np.outer(np.cos(angles), across[0]) + np.outer(np.sin(angles), across[1]))
        rays.append(np.hstack([np.cross(point, forces), forces]))
    return np.vstack(rays).T


def by_nnls(scene: Scene, mu: float) -> bool:
    """Whether the pyramids hold the load, by the least squares of what is left of it."""
    _, left = nnls(pyramid_rays(scene, mu), -scene.load)
    return bool(left <= BALANCED * np.linalg.norm(scene.load))


def by_linprog(scene: Scene, mu: float) -> bool:
    """Whether the pyramids hold the load, by a linear program."""
    rays = pyramid_rays(scene, mu)
    found = linprog(np.zeros(rays.shape[1]), A_eq=rays, b_eq=-scene.load, bounds=(0.0, None), method="highs")
    return bool(found.status == 0)


def halved(held: Callable[[Scene, float], bool], scene: Scene) -> float:
    """The least friction by halving; infinite where none up to ``MOST_MU`` holds."""
    if not held(scene, MOST_MU):
        return math.inf
    low, high = 0.0, MOST_MU
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if held(scene, middle) else (middle, high)
    return high


def main() -> None:
    """Measure in one run, and print what was found."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.statics", description=__doc__)
    parser.add_argument("--states", type=int, default=10_000, help="solved in closed forms [%(default)s]")
    parser.add_argument("--compared", type=int, default=100, help="first of them, by the others as well [%(default)s]")
    parser.add_argument("--conic", type=int, help="first of them, by the conic solver [as --compared]")
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of a table")
    arguments = parser.parse_args()
    pair = quarter_twenty_unc()
    some = scenes(pair, arguments.states)
    closed_forms(some[:10])
    start = time.perf_counter()
    rows = closed_forms(some)
    ours = len(some) / (time.perf_counter() - start)
    contestants = [Contestant("closed forms, both frictions and the margin", len(some), ours, 1.0, 0.0)]
    angle = np.arctan(rows[:, nk.N_HOLD + 1])

    conic = some[: arguments.conic or arguments.compared]
    disagreements: list[Disagreement] = []
    worst, seconds = 0.0, 0.0
    for scene, row in zip(track(conic, "conic solver", console=Console(stderr=True)), rows, strict=False):
        begun = time.perf_counter()
        hold = hold_friction(scene.points, scene.normals, Wrench.of(scene.load[3:], scene.load[:3]), 1.0)
        wedge = wedge_friction(scene.points, scene.normals, 1.0)
        seconds += time.perf_counter() - begun
        for name, at, theirs in (("mu_hold", nk.N_HOLD, hold), ("mu_wedge", nk.N_WEDGE, wedge)):
            low, high = float(row[at]), float(row[at + 1])
            upper = math.inf if theirs.upper is None else theirs.upper
            apart = max(math.atan(low) - math.atan(upper), math.atan(theirs.lower) - math.atan(high))
            worst = max(worst, apart)
            if apart > AGREE:
                load = tuple(scene.load.tolist())
                disagreements.append(Disagreement(scene.pose_deg, load, name, (low, high), (theirs.lower, upper)))
    rate = len(conic) / seconds
    contestants.append(Contestant("Clarabel, certified, both frictions", len(conic), rate, ours / rate, worst))
    for name, held in (("nnls on pyramids", by_nnls), ("linprog on pyramids", by_linprog)):
        begun = time.perf_counter()
        found = np.array([halved(held, scene) for scene in some[: arguments.compared]])
        rate = len(found) / (time.perf_counter() - begun)
        both = np.isfinite(found) & np.isfinite(rows[: len(found), nk.N_HOLD + 1])
        apart = float(np.max(np.abs(np.arctan(found) - angle[: len(found)])[both], initial=0.0))
        contestants.append(Contestant(f"{name} of {SIDES} sides, one friction", len(found), rate, ours / rate, apart))
    if arguments.json:
        found_all = {
            "contestants": [asdict(one) for one in contestants],
            "disagreements": [asdict(one) for one in disagreements],
        }
        print(json.dumps(found_all))
        return
    print(f"{'least frictions':<46}{'states':>8}{'states/s':>12}{'ratio':>10}{'worst angle (rad)':>19}")
    for one in contestants:
        line = f"{one.name:<46}{one.states:>8,}{one.states_per_second:>12,.1f}{one.ratio:>10,.0f}{one.worst:>19.1e}"
        print(line)
    total = 2 * len(conic)
    print(f"{len(disagreements)} of {total:,} numbers lie off the conic solver's by more than {AGREE:g} rad")
    for other in disagreements:
        print(f"  {other}")


if __name__ == "__main__":
    main()
