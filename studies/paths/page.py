"""The page of paths with friction checked by energy and by half the step."""

from __future__ import annotations

from collections import Counter

import numpy as np

from harness.markdown import table
from studies.paths.study import ACCURACY, ACCURACY_DEG, FRICTIONS, TILT_DEG, Compared, Followed, Found
from threadstate.numbers import number_text

MOST_LISTED = 40


def page(found: Found) -> str:
    """The page as Markdown."""
    paths = found.paths
    followed = [one for one in paths if one.whole is not None]
    starts = Counter(one.start for one in paths)
    ends = Counter(_end(one.whole) for one in followed if one.whole is not None)
    ended = [one for one in followed if one.is_ended]
    changed = [one for one in ended if _end(one.whole) != _end(one.half)]
    falls = [one for one in ended if one.moved_fall_deg is None or one.moved_fall_deg > ACCURACY_DEG]
    moved = [one for one in ended if one.moved > ACCURACY]
    starts_changed = [one for one in paths if one.start != one.half_start]
    lists = {
        "Other starts with half the step": starts_changed,
        "Other outcomes with half the step": changed,
        "Falls moved by more, or in other numbers": falls,
        "Ends moved by more": moved,
    }
    return f"""# Paths with friction checked

`make paths` writes this page: bolts that settle with friction and are turned clockwise by
{number_text(found.turn_deg)} deg ([the device](device.md#friction)), of the default pair and device. Roll and pitch
are random within {number_text(TILT_DEG)} deg, the phase is any, the friction {", ".join(map(number_text, FRICTIONS))}
in turns. Each path is followed twice, with the usual longest steps and with half of them.

Of {len(paths):,} commands:

{table(("start", "commands"), [[name, f"{count:,}"] for name, count in sorted(starts.items())])}

With half the step {len(starts_changed):,} of them start otherwise. The paths of those that settle end so:

{table(("end", "paths"), [[name, f"{count:,}"] for name, count in sorted(ends.items())])}

## Energy

Work of hand and push are the change of elastic energy, loss by friction and loss in falls; energies over push times
nominal radius, of all paths up to their end.

{_energies(followed)}

## Half the step

Of the {len(ended):,} paths that end turned, jammed or slipped with both steps, none ambiguous, {len(changed):,} have
another outcome with half the step. In {len(falls):,} a fall is moved by more than {number_text(ACCURACY_DEG)} deg, or
there are more or fewer of them; in {len(moved):,} the bolt ends more than {number_text(ACCURACY)} r elsewhere.

{_halves(ended)}
{"".join(_listed(title, some) for title, some in lists.items())}"""


def _end(path: Followed | None) -> str:
    assert path is not None
    return "ambiguous" if path.ambiguous else path.end


def _energies(followed: list[Compared]) -> str:
    rows = []
    for name, paths in (
        ("usual", [one.whole for one in followed if one.whole is not None]),
        ("half", [one.half for one in followed if one.half is not None]),
    ):
        if not paths:
            continue
        sizes = np.array([abs(path.balance) for path in paths])
        rows.append(
            [
                name,
                f"{len(paths):,}",
                f"{np.median(sizes):.1e}",
                f"{sizes.max():.1e}",
                f"{np.median([path.friction for path in paths]):.2g}",
                f"{min(path.least_loss for path in paths):.1e}",
                f"{sum(path.falls > 0.0 for path in paths):,}",
                f"{np.median([path.seconds for path in paths]):.2g} s",
            ]
        )
    head = (
        "step",
        "paths",
        "balance: median",
        "largest",
        "friction: median",
        "least in a step",
        "with falls",
        "time: median",
    )
    return table(head, rows)


def _halves(ended: list[Compared]) -> str:
    if not ended:
        return "None."
    moved = np.array([one.moved for one in ended])
    falls = [one.moved_fall_deg for one in ended if one.moved_fall_deg is not None and one.moved_fall_deg > 0.0]
    rows = [["end of the path, r", f"{np.median(moved):.1e}", f"{np.percentile(moved, 90):.1e}", f"{moved.max():.1e}"]]
    if falls:
        rows.append(["falls, deg", *(f"{value:.1e}" for value in np.percentile(falls, (50, 90, 100)))])
    return table(("moved by half the step", "median", "90 %", "most"), rows)


def _listed(title: str, some: list[Compared]) -> str:
    shown = [f"- {one.name}" for one in some[:MOST_LISTED]]
    if len(some) > MOST_LISTED:
        shown.append(f"- and {len(some) - MOST_LISTED:,} more")
    return "\n".join(["", f"## {title}", "", *shown, ""]) if some else ""
