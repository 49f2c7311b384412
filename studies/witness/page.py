"""The page of the comparison with the witness."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from studies.witness.compare import AGREE, BRACKETS, SIDES, Bracket, Compared, Number, Outcome
from studies.witness.scenes import LARGEST_FRICTION, PATCH_EVERY, PATCH_TOLERANCE, LoadKind, Scene
from threadstate.numbers import number_text

Found = Sequence[tuple[Scene, Sequence[Compared]]]

MOST_LISTED = 30


def page(found: Found) -> str:
    """The page, in Markdown."""
    kinds = Counter(scene.kind for scene, _ in found)
    patches = sum(scene.patch for scene, _ in found)
    numbers = [one for _, numbers in found for one in numbers]
    outcomes = [one for one in Outcome if any(number.outcome is one for number in numbers)]
    mid = number_text(AGREE)
    return f"""# The numbers of loaded states beside a witness

`make witness` compares `mu_hold`, `mu_wedge` and `support_margin` of {len(found):,} random states under random
loads with the [oracle](oracle.md), which has them from Clarabel and HiGHS and proves by plain arithmetic what it says:
contact forces from above, a twist from below ([forces](forces.md), sections 2 and 3). It was written without sight of
the closed forms.

## States and loads

The states are those of 1/4-20 UNC, half of them on the grid of the default library, half off it; {patches:,} lie on a
level patch (every {PATCH_EVERY}th; corners of its hull nearer than {number_text(PATCH_TOLERANCE)} of the radius to its
chords are left out, for both sides). The loads:

{_lines(f"- {kinds[kind]:,}: {kind}{_more(kind)}" for kind in LoadKind)}

## What agrees

Angles of friction, atan(mu), and margins agree where both intervals are narrower than {mid} (rad) and no further
apart than that.

| number | {" | ".join(outcomes)} | largest distance |
|---|{"---|" * (len(outcomes) + 1)}
{_lines(_row(number, numbers, outcomes) for number in Number)}

Where the witness proves less, its interval holds that of the closed form, which forces or a twist of its own prove:
Clarabel's forces are then not accurate enough to lie within their cones. The forces of the closed form, just above its
least friction, are then checked by the witness's arithmetic, and the witness's own twist proves the rest: nearly all
are settled so. Where the closed form is less certain, its interval holds the witness's.

## Pyramids

A pyramid of {SIDES} sides within the cone of a friction a little above the closed form's, over cos(pi / {SIDES}), has
to hold the load, and one within a cone a little below must not: linear programs (HiGHS) and no cone. How far above and
below, in rad, that had to be:

| number | {" | ".join(number_text(step) for step in BRACKETS)} | violated |
|---|{"---|" * (len(BRACKETS) + 1)}
{_lines(_brackets(number, numbers) for number in (Number.HOLD, Number.WEDGE))}

## Exceptions

{_exceptions(found)}
"""


def _lines(lines: Iterable[str]) -> str:
    return "\n".join(lines)


def _more(kind: LoadKind) -> str:
    match kind:
        case LoadKind.PUSHED:
            return ", 0.2 of a normal deviate on each of force and moment over the radius"
        case LoadKind.HELD:
            return f", of frictions up to {number_text(LARGEST_FRICTION)}"
        case LoadKind.SUPPORTED:
            return ""


def _row(number: Number, numbers: Sequence[Compared], outcomes: Sequence[Outcome]) -> str:
    own = [one for one in numbers if one.number is number]
    counts = Counter(one.outcome for one in own)
    worst = max(one.apart for one in own)
    return f"| `{number}` | " + " | ".join(f"{counts[one]:,}" for one in outcomes) + f" | {worst:.1e} |"


def _brackets(number: Number, numbers: Sequence[Compared]) -> str:
    own = [one for one in numbers if one.number is number]
    at = Counter(one.bracket_angle for one in own if one.bracket is Bracket.HOLDS)
    violated = sum(one.bracket is Bracket.VIOLATED for one in own)
    return f"| `{number}` | " + " | ".join(f"{at[step]:,}" for step in BRACKETS) + f" | {violated:,} |"


def _exceptions(found: Found) -> str:
    rows = [
        _exception(scene, one)
        for scene, numbers in found
        for one in numbers
        if one.outcome not in (Outcome.AGREE, Outcome.VERIFIED) or one.bracket is Bracket.VIOLATED
    ]
    if not rows:
        return "None."
    head = ["| roll, pitch, phase | load | number | closed form | witness | |", "|---|---|---|---|---|---|"]
    return _lines([f"{len(rows):,}, of which these are the first:", "", *head, *rows[:MOST_LISTED]])


def _exception(scene: Scene, one: Compared) -> str:
    pose = ", ".join(number_text(round(angle, 6)) for angle in scene.pose_deg)
    ours, theirs = (f"{low:.10f} to {high:.10f}" for low, high in (one.ours, one.theirs))
    told = one.outcome if one.bracket is not Bracket.VIOLATED else f"{one.outcome}, pyramids violated"
    kind = f"{scene.kind}{', patch' if scene.patch else ''}"
    return f"| {pose} | {kind} | `{one.number}` | {ours} | {theirs} | {told} |"
