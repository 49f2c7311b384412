"""docs/paper-case.md and its pictures."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from studies.paper_case.study import NARROW, PHASE_DEG, PITCH_DEG, ROLL_DEG, Ended, Limit
from studies.pictures import FAINT, INK, picture
from threadstate.device.assembly_model import AssemblyPath, PathEventKind
from threadstate.units import LengthUnit, conversion_factor

WIDTH = 118
LET_GO = "([the device](device.md#friction)): there the torque jumps to the frictionless one for a point."
MM = conversion_factor(LengthUnit.INCH, LengthUnit.MILLIMETRE)
TURN_COLORS = ("#9aa7b4", "#b3261e")
"""Of the counter-clockwise turn and of the clockwise one."""


def page(shown: Sequence[AssemblyPath], by_tilt: Mapping[float, Limit], by_centre: Mapping[float, Limit]) -> str:
    """The page, of the plotted paths, and of the limits by tilt stiffness (N mm/rad) and by centre (mm)."""
    lines = [
        "# The paper's case in a compliant hand",
        "",
        _paragraph(
            f"The paper turns a 1/4-20 UNC bolt that is tilted by {-PITCH_DEG:g} deg in pitch",
            f"(roll {ROLL_DEG:g}) through",
            "all phases and finds those at which it can go down. Here the same bolt is held by the",
            "[default device](device.md#the-device), pushed down with 10 N from phase",
            f"{PHASE_DEG:g} deg, turned counter-clockwise until it snaps onto the thread, and then clockwise",
            "([forces](forces.md), section 5). Does that assemble it, and up to which friction and stiffness?",
            "`make paper-case` computed this page.",
        ),
        "",
        "## The path",
        "",
    ]
    for path in shown:
        lines += [_story(path), ""]
    lines += [
        "![Height, torque, tilt and shift over the phase, without and with friction.](paper-case/path.svg)",
        "",
        _paragraph(
            "Grey is the counter-clockwise turn, red the clockwise one; the dashed line is the",
            "snap. Once the bolt follows",
            "the thread its height falls by the lead a turn, and tilt and shift go on with the",
            "phase, as the commanded axis",
            "goes round.",
        ),
        "",
        "## Up to which friction",
        "",
        _paragraph(
            "Frictions are doubled until a path does not end engaged, and the change is bracketed to",
            f"{NARROW:g}. Beyond it the outcome may change again; `undecided` says that the path",
            "cannot be followed with",
            "certainty, with the flag that says why, not that the bolt sticks.",
        ),
        "",
        *_table("tilt stiffness (N mm/rad)", by_tilt),
        "",
        "With the default tilt stiffness, and another compliance centre:",
        "",
        *_table("centre over the base (mm)", by_centre),
        "",
        "![The outcome of every path: friction against tilt stiffness, and the centre.](paper-case/limits.svg)",
        "",
    ]
    return "\n".join(lines)


def _paragraph(*sentences: str) -> str:
    return textwrap.fill(" ".join(sentences), WIDTH, break_long_words=False, break_on_hyphens=False)


def _story(path: AssemblyPath) -> str:
    snap = next((event for event in path.events if event.kind is PathEventKind.SNAP), None)
    how = "Without friction" if path.mu == 0.0 else f"With a friction of {path.mu:g}"
    if snap is None or path.travel is None or path.energy is None:
        return f"{how} the path ends `{path.outcome.value}`."
    falls = sum(event.kind is PathEventKind.FALL for event in path.events)
    unsolved = sum(point.solutions == 0 for point in path.points[1:])
    let_go = (
        [f"Steps without a solution with friction: {unsolved}; after such a step the bolt is let go without it", LET_GO]
        if unsolved
        else []
    )
    travel, energy = path.travel, path.energy
    return _paragraph(
        f"{how} it snaps at {snap.phase_deg:.2f} deg, by {MM * (snap.drop or 0.0):.3f} mm, and ends",
        f"`{path.outcome.value}`; falls on the way: {falls}. The largest torque is",
        f"{MM * travel.torque:.2f} N mm, the device gives way by {travel.tilt_deg:.2f} deg and",
        f"{MM * travel.shift:.3f} mm.",
        f"Friction takes {MM * energy.friction:.2f} N mm, falls take {MM * energy.falls:.3f} N",
        "mm; the energies add up to",
        f"{MM * abs(energy.balance):.1e} N mm.",
        *let_go,
    )


def _table(what: str, limits: Mapping[float, Limit]) -> list[str]:
    lines = [
        f"| {what} | without friction | snap (deg, mm) | engages up to | does not from | then |",
        "|---|---|---|---|---|---|",
    ]
    for value, limit in limits.items():
        first, last, other = limit.frictionless, limit.last_engaged, limit.first_other
        cells = [
            f"{value:g}",
            _said(first),
            "none" if first.snap is None else f"{first.snap[0]:.2f}, {MM * first.snap[1]:.3f}",
            "-" if last is None else f"{last.mu:g}",
            "-" if other is None else f"{other.mu:g}",
            "-" if other is None else _said(other),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return lines


def _said(path: Ended) -> str:
    flags = ", ".join(f"`{flag.value}`" for flag in path.flags)
    return f"`{path.outcome.value}`" + (f" ({flags})" if flags else "")


def path_picture(shown: Sequence[AssemblyPath]) -> str:
    """Height, torque, tilt and shift over the phase, a column for each path, as SVG."""
    rows = ("height (mm)", "torque (N mm)", "tilt (deg)", "shift (mm)")

    def draw(figure: Figure) -> None:
        axes = figure.subplots(len(rows), len(shown), sharex=True, sharey="row", squeeze=False)
        for column, path in enumerate(shown):
            phases = np.array([point.phase_deg for point in path.points])
            values = (
                [MM * point.pose.translation[2] for point in path.points],
                [MM * point.torque for point in path.points],
                [float(np.hypot(*point.rotation_deg[:2])) for point in path.points],
                [MM * float(np.hypot(*point.shift[:2])) for point in path.points],
            )
            turn = int(np.argmax(phases)) if len(phases) else 0
            for row, (name, series) in enumerate(zip(rows, values, strict=True)):
                one = axes[row, column]
                one.plot(phases[: turn + 1], series[: turn + 1], color=TURN_COLORS[0])
                one.plot(phases[turn:], series[turn:], color=TURN_COLORS[1])
                one.axvline(phases[turn], color=FAINT, linestyle="--", linewidth=0.8)
                if column == 0:
                    one.set_ylabel(name)
            axes[0, column].set_title("without friction" if path.mu == 0.0 else f"friction {path.mu:g}")
            axes[-1, column].set_xlabel("phase of the hand (deg)")

    return picture((10.0, 9.0), "The paper's case: the path", draw)


def limits_picture(by_tilt: Mapping[float, Limit], by_centre: Mapping[float, Limit]) -> str:
    """The outcome of every path, by friction and by the device, as SVG."""
    marks = {"engaged": ("o", "#2e7d32"), "undecided": ("x", FAINT)}

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2, sharey=True)
        seen = set()
        for axes, limits in ((left, by_tilt), (right, by_centre)):
            for i, limit in enumerate(limits.values()):
                for path in limit.paths:
                    name = path.outcome.value
                    mark, color = marks.get(name, ("v", "#b3261e"))
                    label = name if name not in seen else None
                    seen.add(name)
                    axes.plot(i, path.mu, mark, color=color, label=label, clip_on=False)
            axes.set_xticks(range(len(limits)), [f"{value:g}" for value in limits])
        left.set(xlabel="tilt stiffness (N mm/rad)", ylabel="friction")
        right.set(xlabel="compliance centre over the base (mm)")
        left.yaxis.label.set_color(INK)
        figure.legend(loc="outside right upper")

    return picture((10.0, 4.2), "The paper's case: limits", draw)
