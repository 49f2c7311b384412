"""What the page says of the grid: classes, events, and the heights at which the meshes' descents end."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from studies.stability.agreement import Outcome
from studies.stability.descent_study import OutcomeRow
from studies.stability.findings import Findings
from studies.stability.table import table
from threadstate.mesh.options import Descent
from threadstate.state.model import StateClass


def grid_text(found: Findings) -> str:
    """Classes, and how near events are."""
    poses = [pose for row in found.rows for pose in row.poses]
    classes = Counter(pose.state_class for pose in poses)
    events = Counter(pose.event_decade for pose in poses)
    named = ", ".join(f"{classes[one]:,} {one.value.replace('_', ' ')}" for one in StateClass)
    near = ", ".join(
        f"{count:,} within 1e{decade} deg"
        for decade, count in sorted((d, c) for d, c in events.items() if d is not None)
    )
    refused = sum(row.refused for row in found.rows)
    return (
        f"Of {len(poses):,} poses {named}, {classes[None]:,} refused. Each was changed in one direction by 1e-12, "
        f"1e-9, 1e-6 and 1e-3 deg; {refused:,} of these neighbours were refused. Other contacts take over: "
        f"{near or 'nowhere'}. In each map a row is an orientation; within a band of one roll, pitch grows downwards."
    )


def descents_text(found: Findings) -> str:
    """How many heights each descent gets wrong, and by how much."""
    lines = []
    for number, method in enumerate(found.extent.descents):
        rows = found.descents
        counts = Counter(one for row in rows for one in row.outcomes(number))
        off = sorted(abs(told - true) for _, told, true in _ended(found, number))
        wrong = [true - told for outcome, told, true in _ended(found, number) if outcome is Outcome.HEIGHT]
        low, high = sum(fall > 0.0 for fall in wrong), sum(fall < 0.0 for fall in wrong)
        lines.append(
            (
                method.name,
                f"{sum(counts.values()):,}",
                f"{counts[Outcome.RIGHT]:,}",
                f"{counts[Outcome.REFUSED]:,}",
                f"{counts[Outcome.HEIGHT]:,}",
                f"{low:,} too low, {high:,} too high" if wrong else "",
                f"{rows[0].errors[number]:.2g}",
                f"{off[len(off) // 2]:.1g}",
                f"{off[-1]:.2g}",
            )
        )
    head = ("descent", "poses", "right", "refused", "wrong", "which way", "declared error (in)")
    return table((*head, "median error (in)", "largest error (in)"), lines)


def _ended(found: Findings, number: int) -> Iterator[tuple[Outcome, float, float]]:
    """Outcome, height and exact height of every pose in which a descent ends."""
    for row in found.descents:
        for outcome, height, exact in zip(row.outcomes(number), row.heights[number], row.exact, strict=True):
            if height.height is not None and exact is not None:
                yield outcome, height.height, exact


def refusals_text(found: Findings) -> str:
    """Why descents refuse."""
    reasons = Counter(
        (method.name, height.reason)
        for number, method in enumerate(found.extent.descents)
        for row in found.descents
        for height in row.heights[number]
        if height.height is None
    )
    if not reasons:
        return "No descent is refused."
    return "Refused: " + "; ".join(f"{count:,} by {name}: {reason}" for (name, reason), count in reasons.items()) + "."


def descents_csv(found: Findings) -> str:
    """Every pose that a descent gets wrong or refuses, one a line; heights in inches."""
    lines = ["method,roll_deg,pitch_deg,phase_deg,outcome,height_in,exact_height_in,reason"]
    for number, method in enumerate(found.extent.descents):
        for row in found.descents:
            for pose, outcome, height, exact in zip(
                row.poses_deg, row.outcomes(number), row.heights[number], row.exact, strict=True
            ):
                if outcome is not Outcome.RIGHT:
                    angles = ",".join(f"{angle:g}" for angle in pose)
                    told = "" if height.height is None else f"{height.height:.9f}"
                    true = "" if exact is None else f"{exact:.9f}"
                    lines.append(f'"{method.name}",{angles},{outcome.value},{told},{true},"{height.reason}"')
    return "\n".join(lines) + "\n"


def decade_rows(found: Findings) -> list[OutcomeRow]:
    """The outcomes of the descent in decades, for its map."""
    number = next(i for i, one in enumerate(found.extent.descents) if one.descent is Descent.DECADES)
    return [OutcomeRow(row.roll_deg, row.pitch_deg, row.outcomes(number)) for row in found.descents]
