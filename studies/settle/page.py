"""The page of settled states checked apart from the solver."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from harness.markdown import table
from studies.settle.check import APART, LOWER, OVERLAP, RESIDUAL
from studies.settle.study import BESIDE, CAME_BACK, CHANGES, DEVICES, DIRECTIONS, FOLLOW_PARTS, PAIRS, Found, Part
from threadstate.numbers import number_text

MOST_LISTED = 40


def page(found: Mapping[Part, Found]) -> str:
    """The page as Markdown."""
    whole = Found()
    for one in found.values():
        whole.add(one)
    minima = [_minima(found, part) for part in (Part.BESIDE, Part.FOLLOWED)]
    lists = {
        "Without an answer": whole.undecided,
        "Lower beyond a barrier": whole.beyond,
        "Contradicted": whole.faults,
    }
    return f"""# Settled states checked

`make settle` writes this page: [settled states](device.md) without friction, checked by a brute force
(`oracle/rest.py`) that is written apart from the solver. Commands are random, roll and pitch within 4 deg, every third
within 20 deg of in phase. Every other one is of the first pair, every other held by the first device, the others of
any:

- pairs: {"; ".join(PAIRS)}
- devices: {"; ".join(DEVICES)}

In all {whole.states:,} states: {_undecided(whole):,} without an answer, each with a reason, and {len(whole.faults):,}
contradicted by a check (silent failures). Times are those of a core without AVX-512 where numba is told so
(`NUMBA_CPU_NAME=haswell`).

## Random commands

Of each settled state: the samples overlap by less than {number_text(OVERLAP)} r and are no farther apart than
{number_text(APART)} r, at the end and at the first contact; forces are >= 0; the wrench of contacts, device and push is
below {number_text(RESIDUAL)} F (moments over r); and of {DIRECTIONS} random places beside it, 1e-5 to 1e-3 r away, none
is free of overlap where the potential is by {number_text(LOWER)} F r lower. Places beyond a barrier, with the potential
by more than that higher on the straight way there, are another minimum's, and are listed apart.

{_figures(found[Part.RANDOM])}

## Minima by brute force

The brute force minimises the potential over peaks of densely sampled boundaries, with differences for slopes. *Beside*:
it begins {number_text(BESIDE)} r beside the state. *Followed*: it begins at the first contact and follows the push in
{FOLLOW_PARTS} parts. It has found the state again where its potential is within {number_text(CAME_BACK)} F r of the
state's. Where it is higher it has found another minimum, or has stopped before one; lower from beside contradicts the
state unless there is a barrier between, as above. A push that is followed may end elsewhere where the bolt falls: the
search does not descend steepest.

{table(("search", "states", "found again", "higher", "lower", "least (F r)"), minima)}

## Changed commands, dimensions and devices

{CHANGES} changes each of random commands and of level ones, nearly level ones, those in phase, symmetric ones and those
of the grid: by 1e-12 to 0.1 deg, every fourth with dimensions changed too, every fourth with stiffness and push.
Checked as above, with 5 places beside.

{_figures(found[Part.CHANGED])}
{"".join(_listed(title, lines) for title, lines in lists.items())}"""


def _undecided(found: Found) -> int:
    return sum(count for name, count in found.outcomes.items() if name.startswith("undecided"))


def _figures(found: Found) -> str:
    if not found.states:
        return "None."
    times = np.percentile(found.milliseconds, (50, 90, 99, 100))
    rows = [[name, f"{count:,}"] for name, count in sorted(found.outcomes.items())]
    rows += [
        [
            "contacts: " + ", ".join(map(str, sorted(found.contacts))),
            ", ".join(f"{found.contacts[count]:,}" for count in sorted(found.contacts)),
        ],
        ["with a fall on the way", f"{found.falls:,}"],
        ["largest overlap, largest gap", f"{found.overlap:.1e} r, {found.apart:.1e} r"],
        ["least contact force", f"{found.least_force:.1e} F"],
        ["largest unbalanced wrench", f"{found.residual:.1e} F"],
        ["processor time: median, 90 %, 99 %, most", ", ".join(f"{ms:.3g}" for ms in times) + " ms"],
        ["lower within 1e-3 r, beyond a barrier", f"{len(found.beyond):,}"],
        ["contradicted", f"{len(found.faults):,}"],
    ]
    return table(("", "states"), rows)


def _minima(found: Mapping[Part, Found], part: Part) -> list[str]:
    gains = np.array(found[part].gains)
    again = np.abs(gains) <= CAME_BACK
    higher, lower = int((gains > CAME_BACK).sum()), int((gains < -CAME_BACK).sum())
    least = f"{gains.min():.1e}" if len(gains) else ""
    return [part.value, f"{len(gains):,}", f"{int(again.sum()):,}", f"{higher:,}", f"{lower:,}", least]


def _listed(title: str, lines: list[str]) -> str:
    shown = [f"- {line}" for line in lines[:MOST_LISTED]]
    if len(lines) > MOST_LISTED:
        shown.append(f"- and {len(lines) - MOST_LISTED:,} more")
    return "\n".join(["", f"## {title}", "", *shown, ""]) if lines else ""
