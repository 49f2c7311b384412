"""The page of paths checked by halves of the step, and of those with friction by energy."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

import numpy as np

from harness.markdown import table
from studies.paths.changes_section import changes_section
from studies.paths.listing import listed, percentiles
from studies.paths.study import ACCURACY, FRICTIONS, STEPS_DEG, TILT_DEG, Followed, Found, Halved
from threadstate.device.confirmation import LEAST_FALL
from threadstate.device.contact_changes import RESOLVED_WITH_FRICTION_DEG
from threadstate.numbers import number_text


def page(found: Found) -> str:
    """The page as Markdown."""
    paths = found.paths
    whole = [path for one in paths if (path := one.paths[0]) is not None]
    starts = Counter(one.starts[0] for one in paths)
    ends = Counter(_end(path) for path in whole)
    starts_changed = [one.name for one in paths if one.starts[0] != one.starts[1]]
    halves = [_halves(found, number) for number in range(len(STEPS_DEG) - 1)]
    return f"""# Paths checked

`make paths` writes this page, of the default pair and [device](device.md). Roll and pitch are random within
{number_text(TILT_DEG)} deg, the phase is any. Each path is followed with the usual longest steps, with half and with a
quarter of them.

## Without friction

{changes_section(found.frictionless)}
## With friction

Bolts that settle with friction and are turned clockwise by {number_text(found.turn_deg)} deg; the friction is
{", ".join(map(number_text, FRICTIONS))} in turns. Of {len(paths):,} commands:

{table(("start", "commands"), [[name, f"{count:,}"] for name, count in sorted(starts.items())])}

With half the step {len(starts_changed):,} of them start otherwise. The paths of those that settle end so:

{table(("end", "paths"), [[name, f"{count:,}"] for name, count in sorted(ends.items())])}

### Energy

Work of hand and push are the change of elastic energy, loss by friction and loss in falls; energies over push times
nominal radius, of all paths up to their end.

{_energies(found)}

### Half the step

Paths that end turned, jammed or slipped with a longest step and with half of it, none ambiguous. A fall is given to
within the longest step, and the end to {number_text(ACCURACY)} r: *moved falls* are paths where one is by more, or
where there are more or fewer of them; *moved ends* likewise. Falls are compared that lose more than
{number_text(LEAST_FALL)} F r, with what follows within {number_text(STEPS_DEG[0])} deg: a lighter one may be followed
as steps, and one in parts. *Other contacts* are paths of which one step has a contact gained or lost alone, within the
longest step; what is gained and lost again within {number_text(RESOLVED_WITH_FRICTION_DEG)} deg is left out. A contact
counts where it carries a force: which of two places carries it that are both within the accuracy of contacts, 1e-11 r,
of touching hangs on the steps.

{_halves_table(halves)}
{listed("Other starts with half the step", starts_changed)}{"".join(_exceptions(some) for some in halves)}"""


def _halves(found: Found, number: int) -> list[Halved]:
    """The paths that end with both steps."""
    both = [halved for one in found.paths if (halved := one.halved(number)) is not None]
    return [one for one in both if one.is_ended]


def _end(path: Followed) -> str:
    return "ambiguous" if path.ambiguous else path.end


def _other_ends(ended: Sequence[Halved]) -> list[Halved]:
    return [one for one in ended if _end(one.whole) != _end(one.half)]


def _moved_falls(ended: Sequence[Halved]) -> list[Halved]:
    return [one for one in ended if one.moved_fall_deg is None or one.moved_fall_deg > one.step_deg]


def _moved_ends(ended: Sequence[Halved]) -> list[Halved]:
    return [one for one in ended if one.moved > ACCURACY]


def _other_contacts(ended: Sequence[Halved]) -> list[Halved]:
    return [one for one in ended if not one.changes.is_alike]


def _energies(found: Found) -> str:
    rows = []
    for number, step_deg in enumerate(STEPS_DEG):
        paths = [path for one in found.paths if (path := one.paths[number]) is not None]
        if not paths:
            continue
        sizes = np.array([abs(path.balance) for path in paths])
        rows.append(
            [
                number_text(step_deg),
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
        "longest step, deg",
        "paths",
        "balance: median",
        "largest",
        "friction: median",
        "least in a step",
        "with falls",
        "time: median",
    )
    return table(head, rows)


def _halves_table(halves: Sequence[Sequence[Halved]]) -> str:
    rows = []
    for ended in halves:
        if not ended:
            continue
        step_deg = ended[0].step_deg
        falls = [fall for one in ended if (fall := one.moved_fall_deg) is not None and fall > 0.0]
        rows.append(
            [
                f"{number_text(step_deg)}, {number_text(step_deg / 2.0)}",
                f"{len(ended):,}",
                f"{len(_other_ends(ended)):,}",
                f"{len(_moved_falls(ended)):,}",
                percentiles(falls),
                f"{len(_moved_ends(ended)):,}",
                percentiles([one.moved for one in ended]),
                f"{len(_other_contacts(ended)):,}",
                percentiles([deg for one in ended for deg in one.changes.apart_deg]),
            ]
        )
    head = (
        "steps, deg",
        "paths",
        "other outcomes",
        "moved falls",
        "falls moved by, deg: median, 90 %, most",
        "moved ends",
        "ends moved by, r",
        "other contacts",
        "changes in common apart by, deg",
    )
    return table(head, rows) if rows else "None."


def _exceptions(ended: Sequence[Halved]) -> str:
    if not ended:
        return ""
    steps = f"steps of {number_text(ended[0].step_deg)} and {number_text(ended[0].step_deg / 2.0)} deg"
    return (
        listed(f"Other outcomes, {steps}", [one.name for one in _other_ends(ended)])
        + listed(f"Falls moved by more, {steps}", [_fall_text(one) for one in _moved_falls(ended)])
        + listed(f"Ends moved by more, {steps}", [f"{one.name}: {one.moved:.1e} r" for one in _moved_ends(ended)])
        + listed(f"Other contacts, {steps}", [_contacts_text(one) for one in _other_contacts(ended)])
    )


def _contacts_text(one: Halved) -> str:
    alone = (one.changes.first_alone, one.changes.second_alone)
    return f"{one.name}: {' and '.join(str(len(some)) for some in alone)} alone"


def _fall_text(one: Halved) -> str:
    if one.moved_fall_deg is not None:
        return f"{one.name}: {one.moved_fall_deg:.2f} deg"
    return f"{one.name}: {len(one.whole.falls_deg)} and {len(one.half.falls_deg)}"
