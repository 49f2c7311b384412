"""The page that reads the chart in words; every number in it is measured."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from studies.chart.contestant import DEFAULT, FINAL_STEPS, TURN_LIMIT_DEG, Series
from studies.chart.errors import Spread
from studies.chart.findings import (
    MESHES,
    Ratio,
    agreement,
    as_built,
    backing,
    better_in_something,
    modes,
    name_of,
    on_the_front,
    poses_both_faster_and_nearer,
    ratios,
)
from studies.chart.study import Measured, Study
from threadstate.mesh.options import DEFAULT_SCENE, Scene

WIDTH = 118
SERIES_OF_SCENE = {
    Scene.FULL: Series.FULL,
    Scene.BAND: Series.BAND,
    Scene.EDGES: Series.EDGES,
    Scene.CURVES: Series.CURVES,
}


def page(study: Study) -> str:
    """The whole page as Markdown."""
    parts = [
        "# Speed against accuracy",
        "![Errors of the height of first contact and of the turns against the time per pose, both logarithmic, one "
        "mark a method and setting.](speed-accuracy.svg)",
        _wrapped(_opening(study)),
        "## The exact method and what samples",
        _wrapped(_front(study)),
        _ratio_table("meshes", ratios(study, MESHES)),
        _ratio_table("edge curves without a mesh", ratios(study, (Series.CURVES,))),
        "## The finest mesh against the exact method",
        _wrapped(_agreement(study)),
        _disagreements(study),
        "## What a scene needs",
        _wrapped(_scenes(study)),
        _scene_table(study),
        "## Every contestant",
        _wrapped(_columns()),
        _table(study),
        "## How it was measured",
        _wrapped(_measured()),
        _wrapped(_truth(study)),
        _wrapped(_densities(study)),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def _opening(study: Study) -> str:
    exact = as_built(study).score
    meshes = [one for one in study.measured if one.run.contestant.series in MESHES]
    fastest = min(meshes, key=lambda one: one.score.seconds.median)
    nearest = min(meshes, key=lambda one: one.score.height.p95)
    curves = min(study.of(Series.CURVES), key=lambda one: one.score.height.p95)
    return (
        f"`make chart` wrote this page, its numbers ([json](speed-accuracy.json)) and the picture. All contacts of "
        f"{study.scale.poses} poses take the exact method {_time(exact.seconds.median)} a pose, and its heights are "
        f"within {exact.height.p95:.0e} in of the truth. The fastest mesh takes {_time(fastest.score.seconds.median)} "
        f"({name_of(fastest)}) and is within {fastest.score.height.p95:.0e} in in 95 of 100 poses; the nearest one "
        f"({name_of(nearest)}) is within {nearest.score.height.p95:.0e} in and takes "
        f"{_time(nearest.score.seconds.median)}. The two edge curves without a mesh come to "
        f"{curves.score.height.p95:.0e} in in {_time(curves.score.seconds.median)}."
    )


def _front(study: Study) -> str:
    better = better_in_something(study)
    front = on_the_front(study)
    others = [name_of(one) for one in front if one.run.contestant.series is not Series.EXACT]
    sampling = [one for one in study.measured if one.run.contestant.series is not Series.EXACT]
    answers = sum(one.score.answered for one in sampling)
    return (
        f"Of {len(sampling)} contestants that sample, {len(better)} are faster than the exact method or nearer to the "
        f"truth in height, contact points or turns{_named(better)}. The Pareto front of time and error of height is "
        f"{', '.join(name_of(one) for one in front)}: {len(others)} of them sample. Of {answers:,} single answers by "
        f"sampling {poses_both_faster_and_nearer(study)} were both faster and nearer than the exact one to the same "
        "pose. At equal accuracy, the fastest contestant that is within the error in 95 of 100 poses takes this many "
        "times as long as the exact method, which is more accurate still (median, and 5th to 95th percentile over the "
        "poses):"
    )


def _named(found: Iterable[Measured]) -> str:
    names = "; ".join(name_of(one) for one in found)
    return f" ({names})" if names else ""


def _ratio_table(what: str, found: list[Ratio]) -> str:
    lines = [f"| error of height (in) | fastest of {what} | times as long | 5 to 95 % |", "|---|---|---|---|"]
    lines += [
        f"| {one.level:.0e} | {one.name} | {one.median:,.0f} | {one.low:,.0f} to {one.high:,.0f} |" for one in found
    ]
    return "\n".join(lines)


def _agreement(study: Study) -> str:
    found = agreement(study)
    explained = sum(one.mode.name != "UNEXPLAINED" for one in found.disagreements)
    return (
        f"The `{study.scale.presets[-1].value}` mesh, fine along the edges, final step 1 microinch, was compared on "
        f"{found.asked} poses; {found.asked - found.answered} it refused. Heights are within {found.height.median:.1e} "
        f"in at the median, {found.height.p95:.1e} in in 95 of 100 poses, {found.height.largest:.1e} in at most. In "
        f"{found.clear} poses the exact margins exceed the mesh's own error; in {found.same} of them "
        f"({found.same_share:.1%}) second and third contacts are the same components. Of all answers "
        f"{len(found.disagreements)} differ in a contact, a feature or a flag; {explained} of these follow a named "
        "failure mode."
    )


def _disagreements(study: Study) -> str:
    found = agreement(study).disagreements
    if not found:
        return ""
    lines = ["| roll, pitch, phase (deg) | why | margins exceed the mesh's error |", "|---|---|---|"]
    for one in found:
        pose = ", ".join(f"{angle:.4g}" for angle in one.pose)
        lines.append(f"| {pose} | {one.mode.value} | {'yes' if one.clear else 'no'} |")
    return "\n".join(lines)


def _share(part: int, whole: int) -> str:
    """A part of a whole; where the process had room for small meshes anyway, they add no memory to be measured."""
    return f"{part / whole:.0%}" if whole else "as much"


def _scenes(study: Study) -> str:
    preset = study.scale.presets[len(study.scale.presets) // 2]
    costs = {cost.scene: cost for cost in study.costs if cost.preset is preset}
    full, chosen = costs[Scene.FULL], costs[DEFAULT_SCENE]
    whole, used = (_at(study, scene, preset.value) for scene in (Scene.FULL, DEFAULT_SCENE))
    memory = _share(chosen.memory, full.memory)
    return (
        f"The mesh method uses `{DEFAULT_SCENE.value}` by default. At `{preset.value}` that is "
        f"{chosen.triangles / full.triangles:.0%} of the full solids' triangles and {memory} "
        f"of their memory; a pose takes {used.score.seconds.median / whole.score.seconds.median:.0%} of the time, its "
        f"height is off by {used.score.height.p95:.1e} in against {whole.score.height.p95:.1e}, its turns by "
        f"{used.score.turn.p95:.1e} deg against {whole.score.turn.p95:.1e}. `curves` is faster still and nearer, but "
        "blind to thread on thread, so it is not the default ([decision 6](decisions/0006-scene-and-chart.md)). The "
        "exact method's scene is the two edge curves and the closed form: no triangle at all. `band` is cut from the "
        "full solids, which are made first: its memory is theirs."
    )


def _at(study: Study, scene: Scene, preset: str) -> Measured:
    return next(one for one in study.of(SERIES_OF_SCENE[scene]) if one.run.contestant.label == f"{preset}, 1 uin")


def _scene_table(study: Study) -> str:
    lines = [
        "| scene | fineness | triangles | memory (MB) | set-up (s) | a pose (ms) | height, p95 (in) | turns, p95 (deg) "
        "| same contacts |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for cost in study.costs:
        one = _at(study, cost.scene, cost.preset.value).score
        lines.append(
            f"| {cost.scene.value} | {cost.preset.value} | {cost.triangles:,} | {cost.memory / 1e6:.0f} | "
            f"{cost.seconds:.2f} | {1e3 * one.seconds.median:.0f} | {one.height.p95:.1e} | {one.turn.p95:.1e} | "
            f"{one.same_contacts:.0%} |"
        )
    return "\n".join(lines)


def _columns() -> str:
    return (
        "Errors are median / 95th percentile / largest of the poses that were answered: of the height of first "
        "contact, of the contact points, and of the turns. Contacts are the same where features and flags are, in "
        "order."
    )


def _table(study: Study) -> str:
    lines = [
        "| contestant | a pose (ms) | height (in) | points (in) | turns (deg) | same class | same contacts | refused | "
        "why others differ |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for one in study.measured:
        found = one.score
        why = ", ".join(f"{count} {mode.value}" for mode, count in modes(one, study).most_common())
        lines.append(
            f"| {name_of(one)} | {1e3 * found.seconds.median:.3g} | {_spread(found.height)} | {_spread(found.point)} | "
            f"{_spread(found.turn)} | {found.same_class:.0%} | {found.same_contacts:.0%} | "
            f"{found.asked - found.answered} | {why} |"
        )
    return "\n".join(lines)


def _spread(found: Spread) -> str:
    return f"{found.median:.0e} / {found.p95:.0e} / {found.largest:.0e}"


def _measured() -> str:
    steps = ", ".join(f"{step:g}" for step in FINAL_STEPS)
    return (
        f"Poses are a seed's choice within 4 deg of roll and pitch, on the grid of whole degrees and off it by turns, "
        f"level ones left out. Times are CPU time of the process (`time.process_time`) on one thread, two contestants "
        f"side by side, each pose alone; of what takes milliseconds the best of five. Meshing, search trees and "
        f"compiled kernels come before. Final steps are {steps} microinches. A turn ends at {TURN_LIMIT_DEG:g} deg "
        f"here and not at 45: the contacts beyond are few, and on the way to none a mesh takes seconds. The exact "
        f"method is asked for the phase a whole turn on, the same pose but for round-off; otherwise its error would be "
        "0 and not shown."
    )


def _truth(study: Study) -> str:
    found = backing(study)
    return (
        f"Truth is the exact method at its tightest: thread on thread closed by rectangles in every stage. That it is "
        f"no truth of its own making is seen by meshes: their heights on {study.scale.extrapolated} poses, "
        f"extrapolated over eight chord heights to none (Richardson), are within {found.extrapolated.median:.1e} in of "
        f"it at the median and {found.extrapolated.largest:.1e} in at most; those of the finest of the eight are "
        f"within {found.finest.median:.1e} and {found.finest.largest:.1e} in."
    )


def _densities(study: Study) -> str:
    exact = study.of(Series.EXACT)
    times = "; ".join(f"{one.run.contestant.label} {_time(one.score.seconds.median)}" for one in exact)
    worst = max(exact, key=lambda one: one.score.height.p95)
    return (
        f"The exact method's settings change its time and not its answers, as it closes every box by a bound whatever "
        f"it begins with ({DEFAULT.label}: 32 boxes of azimuth an edge, tie tolerance 2e-11 pitches): {times}. The "
        f"largest 95th percentile of the height's error among them is {worst.score.height.p95:.0e} in. The number of "
        f"boxes is a constant of the compiled kernels, which an argument would slow; the study compiles others in "
        "processes of their own."
    )


def _time(seconds: float) -> str:
    return f"{seconds:.2g} s" if seconds >= 1.0 else f"{round(1e3 * seconds, 2 if seconds < 1e-2 else 0):g} ms"


def _wrapped(words: str) -> str:
    return textwrap.fill(words, WIDTH, break_long_words=False, break_on_hyphens=False)
