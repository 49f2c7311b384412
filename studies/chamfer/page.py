"""The page of chamfers, and its pictures."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from studies.chamfer.study import ANGLE_DEG, ENDS, TILTS_DEG, Found, orientations
from studies.pictures import picture
from threadstate.thread.catalogue import pair_by_designation

SIZE_IN = (9.0, 4.2)
COLOURS = ("#00493a", "#d55e00", "#175582", "#b38600")
SHOWN = (0.0, 0.5, 1.0, 1.1)
"""End diameters whose heights are drawn along the phase."""
BELOW_MINOR = 1.1
"""The end diameter of those in ``ENDS`` that is nearest to that of the designation ``with chamfer``."""
KINDS = {
    "outline-surface": "the base's edge on the surface",
    "outline-edge": "the base's edge on the nut's edge",
    "outline-thread": "the base's edge on the nut's thread",
    "base-edge": "the base on the nut's edge",
    "cone-edge": "the cone on the nut's edge",
    "cone-thread": "the cone on the nut's thread",
    "rim-surface": "the cone's edge with the thread on the surface",
    "rim-edge": "that edge on the nut's edge",
    "rim-thread": "that edge on the nut's thread",
    "thread-edge": "the thread on the nut's edge",
    "thread-thread": "thread on thread",
    "thread-surface": "the thread on the surface",
}


def page(found: Sequence[Found], step_deg: float) -> str:
    """The page as Markdown."""
    names = list(dict.fromkeys(one.designation for one in found))
    count = len(found[0].courses)
    tables = "\n\n".join(f"### {name}\n\n{_table(_of(found, name))}" for name in names)
    kinds = "\n\n".join(f"### {name}\n\n{_kinds(_of(found, name))}" for name in names)
    return f"""# Chamfered bolts

`make chamfer` writes this page: what a chamfer of the bolt's base, which real bolts have, changes of first contacts
along the phase. Each bolt was looked at in {count} orientations (rolls and pitches of
{", ".join(f"{tilt:.0f}" for tilt in TILTS_DEG)} deg without the level one), every {step_deg:g} deg of phase, by the
[brute force](oracle.md): the exact method is for bolts that are cut flat, and meshes take a hundred times as long
([decision 28](decisions/0028-chamfer.md)).

The chamfer is a cone of {ANGLE_DEG:.0f} deg from a circle on the base plane, whose **end diameter** goes here from the
major diameter, which is a flat bolt, to below the minor one. ISO 4753 draws chamfered ends (CH) at 45 deg; ASME B18.2.1
has points chamfered or rounded from some 0.016 in below the minor diameter; both figures are from memory.

- **Window**: how much phase the first contact is within the thread: on the nut's thread, or of the bolt's thread with
  the nut's edge. The cone, or its edge, on the nut's edge or surface is at the mouth.
- **Fall**: the largest fall of the height of first contact within 3 deg of phase, over the thread pitch; a **snap** is
  one of more than 5 %. Of sampled heights: where the height jumps it is as in [windows](windows.md), elsewhere no
  larger.
- **Highest**, **lowest**: the bolt's origin at first contact, over the thread pitch. It is the middle of the base.

All are medians over the orientations. The flat bolts' windows and snaps are those that the exact method gives
([threads compared](threads-compared.md)); sampled falls are a little smaller.

## Windows and falls

{tables}

![Median window and fall over the end diameter.](chamfer/windows.svg)

![Height of first contact along the phase for four end diameters.](chamfer/courses.svg)

## By orientation

{names[0]}, flat and with an end diameter below the minor one:

{_by_orientation(_of(found, names[0]))}

## What touches first

Shares of all phases (%), by end diameter.

{kinds}

## What follows for a designer

- A chamfer that ends above the minor diameter takes only the crest off the base: at its highest the bolt is about where
  the flat one is, with as many snaps and the same median fall. One that ends below the minor diameter, as standards
  have it, changes what touches first: the base's edge never does, at most phases the cone or its edge rests on the
  nut's edge, and the bolt sits deeper.
- Then the median window is clearly wider (in a few orientations it is gone) and the median of the steepest falls about
  three times as large. That hides what matters to a device that turns the bolt back until it falls: the snaps are in
  other orientations. A flat bolt snaps where the pitch is negative. The chamfered one hardly falls at roll and pitch
  -4, where the flat one falls by 19 % of the pitch, and snaps at positive rolls at nearly every pitch, where the flat
  one does so at negative pitch alone. The tilt at which a device waits for the snap is to be chosen for the bolt's own
  end.
- Heights and labels of the flat bolt do not hold for one with a standard chamfer: a library of contact states is for
  bolts that are cut flat.
{_conclusions(found, names)}
"""


def _of(found: Sequence[Found], name: str) -> list[Found]:
    return [one for one in found if one.designation == name]


def _end_text(one: Found) -> str:
    """The end diameter of a bolt with its unit, and where that lies."""
    pair = pair_by_designation(one.designation)
    major, minor = pair.fit.bolt_major_diameter, pair.fit.bolt_minor_diameter
    diameter = major - one.end * (major - minor)
    where = {0.0: ", major: flat", 1.0: ", minor"}.get(one.end, "")
    return f"{diameter:.4g} {pair.unit}{where}"


def _table(rows: Sequence[Found]) -> str:
    head = "| end diameter | window (deg) | fall (%) | snaps | highest (%) | lowest (%) |\n|---|---|---|---|---|---|"
    lines = [
        f"| {_end_text(one)} | {one.window_deg:.1f} | {100 * one.steepest:.1f} | {one.snaps} of {len(one.courses)} "
        f"| {100 * one.highest:.1f} | {100 * one.lowest:.1f} |"
        for one in rows
    ]
    return "\n".join([head, *lines])


def _by_orientation(rows: Sequence[Found]) -> str:
    """Falls and windows of the flat bolt and of one that ends below the minor diameter, by orientation."""
    by_end = {one.end: one for one in rows}
    flat, full = by_end[0.0], by_end[BELOW_MINOR]
    lines = [
        f"| roll | pitch | fall (%), flat | {_end_text(full)} | window (deg), flat | {_end_text(full)} |",
        "|---|---|---|---|---|---|",
    ]
    for (roll, pitch), one, other in zip(orientations(), flat.courses, full.courses, strict=False):
        lines.append(
            f"| {roll:.0f} | {pitch:.0f} | {100 * one.steepest:.1f} | {100 * other.steepest:.1f} "
            f"| {one.window_deg:.1f} | {other.window_deg:.1f} |"
        )
    return "\n".join(lines)


def _kinds(rows: Sequence[Found]) -> str:
    head = f"| first contact | {' | '.join(_end_text(one) for one in rows)} |"
    lines = [head, "|---" * (len(rows) + 1) + "|"]
    known = set(KINDS) | {kind for one in rows for course in one.courses for kind in course.touching}
    for kind in sorted(known, key=lambda kind: (list(KINDS).index(kind) if kind in KINDS else len(KINDS), kind)):
        shares = [100 * one.share(kind) for one in rows]
        if max(shares) > 0.0:
            lines.append(f"| {KINDS.get(kind, kind)} | {' | '.join(f'{share:.1f}' for share in shares)} |")
    return "\n".join(lines)


def _conclusions(found: Sequence[Found], names: Sequence[str]) -> str:
    lines = []
    for name in names:
        rows = {one.end: one for one in _of(found, name)}
        flat, full = rows[0.0], rows[BELOW_MINOR]
        fit, pitch = pair_by_designation(name).fit, pair_by_designation(name).thread_pitch
        below = (full.end - 1.0) * (fit.bolt_major_diameter - fit.bolt_minor_diameter) / pitch
        mouth = sum(full.share(kind) for kind in ("cone-edge", "rim-edge", "rim-surface"))
        lines.append(
            f"- **{name}**: flat, the median window is {flat.window_deg:.0f} deg, the steepest fall "
            f"{100 * flat.steepest:.1f} % of the pitch; with an end {100 * below:.0f} % of the pitch below the minor "
            f"diameter {full.window_deg:.0f} deg and {100 * full.steepest:.1f} %, {full.snaps} snaps of "
            f"{len(full.courses)} for {flat.snaps}. At {100 * mouth:.0f} % of the phases the bolt then rests at the "
            f"mouth with its cone or the cone's edge; at its highest it is lower by "
            f"{100 * (flat.highest - full.highest):.0f} % of the pitch."
        )
    return "\n".join(lines)


def window_picture(found: Sequence[Found]) -> str:
    """Median window and fall over the end diameter, as SVG."""
    names = list(dict.fromkeys(one.designation for one in found))

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2)
        for axes, title, values in (
            (left, "window (deg)", [one.window_deg for one in found]),
            (right, "steepest fall (% of the pitch)", [100.0 * one.steepest for one in found]),
        ):
            for name, colour in zip(names, COLOURS, strict=False):
                at = [i for i, one in enumerate(found) if one.designation == name]
                axes.plot([100 * found[i].end for i in at], [values[i] for i in at], "o-", color=colour, label=name)
            axes.set_title(title)
            axes.set_xlabel("end diameter: way from major (0) to minor (100)")
            axes.set_ylim(bottom=0.0)
        left.legend(fontsize=8.0)

    return picture(SIZE_IN, "Median window and fall over the end diameter", draw)


def course_picture(found: Sequence[Found]) -> str:
    """Heights along the phase of the first pair's first orientation at some end diameters, as SVG."""
    rows = [one for one in _of(found, found[0].designation) if one.end in SHOWN and one.end in ENDS]

    def draw(figure: Figure) -> None:
        axes = figure.subplots()
        for one, colour in zip(rows, COLOURS, strict=False):
            heights = one.courses[0].heights
            phases = [360.0 * i / len(heights) for i in range(len(heights))]
            axes.plot(phases, [100.0 * h for h in heights], color=colour, linewidth=1.2, label=_end_text(one))
        axes.set_title(f"Height of first contact (% of the pitch), {rows[0].designation}")
        axes.set_xlabel(f"phase (deg), roll and pitch {TILTS_DEG[0]:.0f} deg")
        axes.legend(fontsize=8.0)

    return picture(SIZE_IN, "Height of first contact along the phase", draw)
