"""The page of threads compared, and its picture."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from studies.pictures import picture
from studies.threads.study import CLASSES, FITS, FORMS, SIZES, TILTS_DEG, Thread

SIZE_IN = (9.0, 4.2)
COLOURS = ("#00493a", "#d55e00", "#175582", "#b38600", "#7a3b8f", "#4a5563", "#c2185b")


def page(found: dict[str, Thread]) -> str:
    """The page as Markdown; ``found`` by the designations of the study."""
    tight, loose = found["1/4-20 UNC-3A/3B"], found["1/4-20 UNC-1A/1B at minimum material"]
    fine, coarse = found["1/4-20 UNC-3A/3B at minimum material"], found["1/4-20 UNC-1A/1B"]
    shares = [other.window_deg / one.window_deg for one, other in _ends(found)]
    falls = [other.fall / one.fall for one, other in _ends(found)]
    return f"""# Threads compared

`make threads` writes this page: how classes, positions in their tolerances, forms and sizes of
[standard threads](threads.md#pairs) change where a tilted bolt, turned counter-clockwise, can go into the thread, and
how far it falls there. Each pair was solved at {len(tight.windows_deg)} orientations by the exact method: rolls and
pitches of {", ".join(f"{tilt:.0f}" for tilt in TILTS_DEG)} deg without the level one.

- **Play**: how far a bolt in phase can shift along the nut's axis, over the thread pitch.
- **Window**: how much phase the [clearance windows](windows.md#clearance-windows) of an orientation cover.
- **Fall**: the [steepest fall](windows.md) of an orientation, over the thread pitch.
- **Snaps**: orientations whose steepest fall exceeds 5 % of the thread pitch.

Windows and falls are medians over the orientations, and beside them the largest.

![Median window and fall of each pair over its play.](threads/play.svg)

## Classes of 1/4-20 UNC at both ends of their tolerances

{_table([found[name] for name in CLASSES])}

From 3A/3B at maximum material to 1A/1B at minimum material the median window goes from {tight.window_deg:.1f} to
{loose.window_deg:.1f} deg, the median of the steepest falls from {100 * tight.fall:.1f} to {100 * loose.fall:.1f} % of
the pitch, and the orientations that snap from {tight.snaps} to {loose.snaps} of {len(tight.falls)}. How much of that is
the class and how much the part: 3A/3B at minimum material has a median window of {fine.window_deg:.1f} deg, 1A/1B at
maximum material {coarse.window_deg:.1f} deg.

## Forms

{_table([found[name] for name in FORMS])}

{_widest(found)}

## Fits of M6

{_table([found[name] for name in FITS])}

## Sizes

{_table([found[name] for name in SIZES])}

## What follows for a designer

- Of the same class, parts at minimum material have {min(shares):.1f} to {max(shares):.1f} times the median window of
  parts at maximum material, and {min(falls):.1f} to {max(falls):.1f} times the fall: a device is to be tried with both.
- The default pair is at maximum material. Its windows are those of the tightest parts that class 2A/2B allows.
"""


def play_picture(found: Sequence[Thread]) -> str:
    """Median window and median fall over the play, by form, as SVG."""
    forms = list(dict.fromkeys(one.form for one in found))

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2)
        for axes, name, values in (
            (left, "window (deg)", [one.window_deg for one in found]),
            (right, "steepest fall (% of the pitch)", [100.0 * one.fall for one in found]),
        ):
            for form, colour in zip(forms, COLOURS, strict=False):
                at = [number for number, one in enumerate(found) if one.form == form]
                play = [100.0 * found[number].play for number in at]
                axes.scatter(play, [values[number] for number in at], s=26, color=colour, label=form, zorder=3)
            axes.set_title(name)
            axes.set_xlabel("axial play (% of the pitch)")
            axes.set_ylim(bottom=0.0)
        right.legend(fontsize=8.0, loc="upper left")

    return picture(SIZE_IN, "Median window and fall over the play", draw)


def _ends(found: dict[str, Thread]) -> list[tuple[Thread, Thread]]:
    """Pairs at maximum material with those at minimum material."""
    ending = " at minimum material"
    return [(found[name.removesuffix(ending)], one) for name, one in found.items() if name.endswith(ending)]


def _widest(found: dict[str, Thread]) -> str:
    tight = [found[name] for name in FORMS if not name.endswith("material")]
    widest, narrowest = max(tight, key=lambda one: one.window_deg), min(tight, key=lambda one: one.window_deg)
    return (
        f"At maximum material {widest.designation} has the widest median window ({widest.window_deg:.0f} deg),\n"
        f"{narrowest.designation} the narrowest ({narrowest.window_deg:.0f} deg)."
    )


def _table(rows: Sequence[Thread]) -> str:
    head = "| pair | play (%) | window (deg) | widest | fall (%) | largest | snaps |\n|---|---|---|---|---|---|---|"
    lines = [
        f"| {one.designation} | {100 * one.play:.1f} | {one.window_deg:.1f} | {max(one.windows_deg):.1f} "
        f"| {100 * one.fall:.1f} | {100 * max(one.falls):.1f} | {one.snaps} of {len(one.falls)} |"
        for one in rows
    ]
    return "\n".join([head, *lines])
