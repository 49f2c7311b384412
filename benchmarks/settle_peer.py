"""``make peer``: settled states and whole paths beside MuJoCo's, by signed distances of meshes; writes
docs/settle-peer.md.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from harness.markdown import table
from oracle.pose import pose_rotation
from oracle.profile import bolt_profile, nut_profile
from oracle.rest import ALL_SAMPLES, overlap_depth
from threadstate.device.assemble import assemble_pose
from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.document import device_from_document
from threadstate.device.model import Device, Outcome, SettledState, default_device
from threadstate.device.settle import settle_poses
from threadstate.mesh.part import part_solid
from threadstate.mesh.presets import Preset
from threadstate.thread.catalogue import quarter_twenty_unc
from threadstate.thread.pair import Pair, Part

Floats = NDArray[np.float64]

DOCS = Path(__file__).parents[1] / "docs"
CHILD = Path(__file__).with_name("mujoco_settle.py")
SEED = 5
DAMPING = 2.0
"""Of each joint of the peer, in units of push, radius and its time: all but critical."""
AFTER_SNAP_DEG = 20.0
"""How far beyond our snap the peer's bolt is turned to see when it falls."""
DEVICE = {"unit": "mm", "k_twist": 500.0}
"""The default device, its twist as stiff as its tilt: the spring of a ball joint has the same energy."""


@dataclass(frozen=True)
class Compared:
    """A command settled by both: processor milliseconds of each, and how far the peer's pose is from the exact one.

    ``apart`` is the distance of the bolt's origins and ``overlap`` how deep the exact solids overlap in the peer's
    pose, both over the nominal radius; ``angle_deg`` is between the rotations and ``speed`` the peer's at its end.
    """

    pose_deg: tuple[float, float, float]
    exact_ms: float
    peer_ms: float
    apart: float
    angle_deg: float
    overlap: float
    speed: float


def meshes(pair: Pair, preset: Preset) -> dict[str, Any]:
    """Bolt and nut as meshes, their lengths over the nominal radius."""
    r = pair.nominal_diameter / 2.0
    solids = {part.value: part_solid(pair, part, preset.tessellation) for part in (Part.BOLT, Part.NUT)}
    return {
        name: {"vertices": (solid.vertices / r).tolist(), "faces": solid.triangles.tolist()}
        for name, solid in solids.items()
    }


def exact(pair: Pair, device: Device, poses: Floats) -> list[tuple[SettledState, float]]:
    """The settled states of commands, with the processor milliseconds of each."""
    settle_poses(pair, poses[:1], device)
    found = []
    for pose in poses:
        start = time.process_time()
        (state,) = settle_poses(pair, [pose], device)
        found.append((state, 1e3 * (time.process_time() - start)))
    return found


def compared(python: Path, count: int, preset: Preset) -> list[Compared]:
    """Random commands that settle, by both."""
    pair, device = quarter_twenty_unc(), device_from_document(DEVICE)
    r = pair.nominal_diameter / 2.0
    poses = np.random.default_rng(SEED).uniform([-4.0, -4.0, 0.0], [4.0, 4.0, 360.0], (count, 3))
    states = [(state, ms) for state, ms in exact(pair, device, poses) if state.outcome is Outcome.SETTLED]
    asked = {**_asked(pair, device, preset), "cases": [_case(state, r) for state, _ in states]}
    answers = _answers(python, asked)
    return [_compared(pair, state, ms, theirs, r) for (state, ms), theirs in zip(states, answers, strict=True)]


def _asked(pair: Pair, device: Device, preset: Preset) -> dict[str, Any]:
    """What the peer is asked, without the cases."""
    r, held = pair.nominal_diameter / 2.0, device.in_unit(pair.unit)
    return {
        "meshes": meshes(pair, preset),
        "device": {
            "k_lateral": held.stiffness[3][3] * r / held.push,
            "k_tilt": held.stiffness[0][0] / (held.push * r),
            "damping": DAMPING,
        },
    }


def _answers(python: Path, asked: dict[str, Any]) -> list[dict[str, Any]]:
    answer = subprocess.run(
        [str(python), str(CHILD)], input=json.dumps(asked), capture_output=True, text=True, check=True
    )
    return [json.loads(line) for line in answer.stdout.splitlines()]


def _case(state: SettledState, r: float) -> dict[str, Any]:
    assert state.pose is not None
    assert state.shift is not None
    command = pose_rotation(state.roll_deg, state.pitch_deg, state.phase_deg)
    return {"command": command.tolist(), "height": (state.pose.translation[2] - state.shift[2]) / r}


def _compared(pair: Pair, state: SettledState, ms: float, theirs: dict[str, Any], r: float) -> Compared:
    assert state.pose is not None
    rotation, origin = np.array(theirs["rotation"]), r * np.array(theirs["translation"])
    depth = overlap_depth(
        np.ascontiguousarray(rotation), origin, np.arange(ALL_SAMPLES), math.inf, bolt_profile(pair), nut_profile(pair)
    )
    return Compared(
        (state.roll_deg, state.pitch_deg, state.phase_deg),
        ms,
        1e3 * float(theirs["seconds"]),
        float(np.linalg.norm(origin - np.array(state.pose.translation)) / r),
        _angle_deg(np.array(state.pose.rotation), rotation),
        float(depth) / r,
        float(theirs["speed"]),
    )


def _angle_deg(one: Floats, other: Floats) -> float:
    """The angle of the turn from one rotation to another."""
    return math.degrees(math.acos(max(-1.0, min(1.0, (float(np.trace(one.T @ other)) - 1.0) / 2.0))))


@dataclass(frozen=True)
class ComparedPath:
    """A path followed by both: processor seconds of each, and how far the peer's last pose is from the exact one's.

    ``rate`` is the peer's, degrees of turn a unit of its time. ``apart`` (over the nominal radius) and ``angle_deg``
    are as of :class:`Compared`. ``late_deg`` is how much farther the peer has been turned when its bolt is half-way
    down the fall of our snap; None where there is no snap, or none of its own within ``AFTER_SNAP_DEG``.
    """

    pose_deg: tuple[float, float, float]
    outcome: AssemblyOutcome
    turned_deg: float
    rate: float
    exact_s: float
    peer_s: float
    apart: float
    angle_deg: float
    late_deg: float | None


def compared_paths(python: Path, count: int, preset: Preset, rates: Sequence[float]) -> list[ComparedPath]:
    """Random commands settled and turned by ``ccw_then_cw``; the peer is turned as far, each way, at each rate."""
    pair = quarter_twenty_unc()
    stiff, device = device_from_document(DEVICE), default_device()
    r = pair.nominal_diameter / 2.0
    poses = np.random.default_rng(SEED + 1).uniform([-4.0, -4.0, 0.0], [4.0, 0.0, 360.0], (count, 3))
    assemble_pose(pair, 0.0, 0.0, 0.0, device)
    paths = []
    for roll, pitch, phase in poses.tolist():
        start = time.process_time()
        path = assemble_pose(pair, roll, pitch, phase, device)
        seconds = time.process_time() - start
        if path.outcome is not AssemblyOutcome.UNDECIDED:
            paths.append((path, seconds))
    asked = _asked(pair, stiff, preset)
    asked["cases"] = [
        {**_case(path.start, r), "legs": legs_deg(path), "rate": rate} for path, _ in paths for rate in rates
    ]
    answers = _answers(python, asked)
    late = _late_snaps(python, asked, [path for path, _ in paths for _ in rates], r)
    found = []
    for k, theirs in enumerate(answers):
        path, seconds = paths[k // len(rates)]
        last = path.points[-1].pose
        start_deg = (path.start.roll_deg, path.start.pitch_deg, path.start.phase_deg)
        found.append(
            ComparedPath(
                start_deg,
                path.outcome,
                sum(map(abs, legs_deg(path))),
                rates[k % len(rates)],
                seconds,
                float(theirs["seconds"]),
                float(np.linalg.norm(np.array(theirs["translation"]) - np.array(last.translation) / r)),
                _angle_deg(np.array(last.rotation), np.array(theirs["rotation"])),
                late.get(k),
            )
        )
    return found


def _late_snaps(python: Path, asked: dict[str, Any], paths: Sequence[AssemblyPath], r: float) -> dict[int, float]:
    """By the number of a case how many degrees after ours the peer's snap comes, turned on beyond it.

    Its time is not of the comparison.
    """
    numbers, cases, turned = [], [], []
    for k, path in enumerate(paths):
        snaps = [event for event in path.events if event.kind is PathEventKind.SNAP]
        if not snaps:
            continue
        (snap,) = snaps
        after = next(i for i, point in enumerate(path.points) if point.phase_deg >= snap.phase_deg)
        heights = [path.points[i].pose.translation[2] / r for i in (after - 1, after)]
        turned.append(snap.phase_deg - path.points[0].phase_deg)
        numbers.append(k)
        cases.append({**asked["cases"][k], "legs": [turned[-1] + AFTER_SNAP_DEG], "below": sum(heights) / 2.0})
    answers = _answers(python, {**asked, "cases": cases})
    return {
        k: theirs["below_deg"] - ours
        for k, theirs, ours in zip(numbers, answers, turned, strict=True)
        if theirs["below_deg"] is not None
    }


def legs_deg(path: AssemblyPath) -> list[float]:
    """How far a path is turned, counter-clockwise and then back."""
    phases = [point.phase_deg for point in path.points]
    top = max(phases)
    return [top - phases[0], phases[-1] - top]


def page(found: list[Compared], paths: list[ComparedPath], preset: Preset) -> str:
    """The page as Markdown."""
    columns = ("roll, pitch, phase (deg)", "ms", "MuJoCo ms", "apart (r)", "angle (deg)", "overlap (r)", "speed")
    rows = [
        [
            ", ".join(f"{angle:.2f}" for angle in one.pose_deg),
            f"{one.exact_ms:.1f}",
            f"{one.peer_ms:,.0f}",
            f"{one.apart:.1e}",
            f"{one.angle_deg:.2f}",
            f"{one.overlap:.1e}",
            f"{one.speed:.0e}",
        ]
        for one in found
    ]
    ours, theirs = (
        float(np.median(times)) for times in ([one.exact_ms for one in found], [one.peer_ms for one in found])
    )
    apart, overlap = [one.apart for one in found], [one.overlap for one in found]
    return f"""# Settled states beside MuJoCo

`make peer` writes this page: random commands of 1/4-20 UNC without friction, settled by `threadstate` and, in the same
run, by MuJoCo 3, in an environment of its own (`requirements-mujoco.lock`). There bolt and nut are signed distances of
the [{preset.value}](speed-accuracy.md) meshes, lengths over the nominal radius r and forces over the push; the device
is the default one with a twist as stiff as its tilt, three slides and a ball joint with springs. The push grows within
a quarter of the simulated time. Times are processor time of a core, without building its model;
`threadstate` is compiled for {os.environ.get("NUMBA_CPU_NAME", "the processor")}.

At the median {ours:.1f} ms and {theirs:,.0f} ms: {theirs / ours:,.0f} times as long. Origins are
{np.median(apart):.1e} r apart at the median and {max(apart):.1e} r at most.

{table(columns, rows)}

*Overlap*: how deep the exact solids overlap in MuJoCo's pose, negative where they are apart. Its contacts give way by
some 1e-4 r, but its distances are interpolated between samples of a mesh, which rounds edges and threads: that is its
softness, up to {max(overlap):.0e} r here, and poses differ by as much and by what tilt and shift make of it.
*Speed*: the fastest joint at the end, radii or radians a unit of its time; where it is not small MuJoCo has not come to
rest.

{_paths_words(paths)}"""


def _paths_words(paths: list[ComparedPath]) -> str:
    """The section on whole paths."""
    columns = (
        "roll, pitch, phase (deg)",
        "outcome",
        "turned (deg)",
        "s",
        "rate",
        "MuJoCo s",
        "times",
        "apart (r)",
        "angle (deg)",
        "snap after ours (deg)",
    )
    rows = [
        [
            ", ".join(f"{angle:.2f}" for angle in one.pose_deg),
            one.outcome.value.replace("_", " "),
            f"{one.turned_deg:.0f}",
            f"{one.exact_s:.2f}",
            f"{one.rate:g}",
            f"{one.peer_s:.1f}",
            f"{one.peer_s / one.exact_s:,.0f}",
            f"{one.apart:.1e}",
            f"{one.angle_deg:.2f}",
            "" if one.late_deg is None else f"{one.late_deg:.1f}",
        ]
        for one in paths
    ]
    rates = sorted({one.rate for one in paths}, reverse=True)
    lines = []
    for rate in rates:
        of_rate = [one for one in paths if one.rate == rate]
        times = float(np.median([one.peer_s / one.exact_s for one in of_rate]))
        ours_s = float(np.median([one.exact_s for one in of_rate]))
        apart = float(np.median([one.apart for one in of_rate]))
        late = [one.late_deg for one in of_rate if one.late_deg is not None]
        words = f"{times:,.0f} times our {ours_s:.2g} s at the median, and its bolt ends {apart:.1e} r from ours"
        if late:
            side = "after" if np.median(late) > 0.0 else "before"
            words += f"; its snap comes {abs(np.median(late)):.1f} deg {side} ours"
        lines.append(f"- At {rate:g} deg a unit of its time MuJoCo takes {words}.")
    return f"""## Whole paths

The same device, its twist rigid here, settles the bolt and turns it by `ccw_then_cw`, without friction. MuJoCo turns it
as far each way as that path goes, at several rates: a slower one is nearer to the quasi-static path, and takes as much
longer. *Snap after ours*: how much farther its bolt has been turned than ours when it is half-way down the fall of the
snap, in a run of its own; ours is bracketed to 0.001 deg. It comes before ours (negative) as its rounded edges let the
bolt in before the exact ones do, and the later the faster it is turned, as a fall takes time: a rate is slow enough
where a slower one moves the snap no more.

{chr(10).join(lines)}

{table(columns, rows)}
"""


def main() -> None:
    """Compare and write the page."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.settle_peer", description=__doc__)
    parser.add_argument("--mujoco", type=Path, required=True, help="the Python that has mujoco")
    parser.add_argument("--count", type=int, default=20, help="random commands [%(default)s]")
    parser.add_argument("--paths", type=int, default=5, help="random paths [%(default)s]")
    parser.add_argument("--rates", type=float, nargs="+", default=[40.0, 10.0], help="degrees a unit of time [40 10]")
    parser.add_argument("--preset", type=Preset, default=Preset.COARSE, help="meshes [%(default)s]")
    parser.add_argument("--into", type=Path, default=DOCS, help="folder of the page [docs]")
    chosen = parser.parse_args()
    found = compared(chosen.mujoco, chosen.count, chosen.preset)
    paths = compared_paths(chosen.mujoco, chosen.paths, chosen.preset, chosen.rates)
    (chosen.into / "settle-peer.md").write_text(page(found, paths, chosen.preset))


if __name__ == "__main__":
    main()
