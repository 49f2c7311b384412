"""What the page says of the grid: classes, events, and the heights at which the meshes' descents end."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from studies.stability.agreement import Outcome
from studies.stability.descent_study import OutcomeRow
from studies.stability.findings import Findings
from studies.stability.table import table
from studies.stability.wrong_height import FINER
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
        off = sorted(_errors(found, number))
        looks = [look for look in found.looks if look.wrong.method == method]
        low = sum(look.wrong.height < look.wrong.exact for look in looks)
        lines.append(
            (
                method.name,
                f"{sum(counts.values()):,}",
                f"{counts[Outcome.RIGHT]:,}",
                f"{counts[Outcome.REFUSED]:,}",
                f"{counts[Outcome.HEIGHT]:,}",
                f"{low:,} / {len(looks) - low:,}",
                f"{sum(look.beside_event for look in looks):,}",
                f"{sum(look.finer is Outcome.HEIGHT for look in looks):,}",
                f"{rows[0].errors[number]:.2g}",
                f"{off[len(off) // 2]:.1g}",
                f"{off[-1]:.2g}",
            )
        )
    head = ("descent", "poses", "right", "refused", "wrong", "too low / too high", "beside a jump")
    errors = ("declared error (in)", "median error (in)", "largest error (in)")
    return table((*head, f"wrong by {FINER} meshes as well", *errors), lines)


def _errors(found: Findings, number: int) -> Iterator[float]:
    """How far each height in which a descent ends is from the exact one."""
    for row in found.descents:
        for height, exact in zip(row.heights[number], row.exact, strict=True):
            if height.height is not None and exact is not None:
                yield abs(height.height - exact)


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
    looks = {(look.wrong.method.name, look.wrong.case.pose_deg): look for look in found.looks}
    lines = [
        "method,roll_deg,pitch_deg,phase_deg,outcome,height_in,exact_height_in,beside_event,by_finer_meshes,reason"
    ]
    for number, method in enumerate(found.extent.descents):
        for row in found.descents:
            for pose, outcome, height, exact in zip(
                row.poses_deg, row.outcomes(number), row.heights[number], row.exact, strict=True
            ):
                if outcome is not Outcome.RIGHT:
                    angles = ",".join(f"{angle:g}" for angle in pose)
                    told = "" if height.height is None else f"{height.height:.9f}"
                    true = "" if exact is None else f"{exact:.9f}"
                    look = looks.get((method.name, pose))
                    seen = "," if look is None else f"{'yes' if look.beside_event else 'no'},{look.finer.value}"
                    lines.append(f'"{method.name}",{angles},{outcome.value},{told},{true},{seen},"{height.reason}"')
    return "\n".join(lines) + "\n"


def decade_rows(found: Findings) -> list[OutcomeRow]:
    """The outcomes of the descent in decades, for its map."""
    number = next(i for i, one in enumerate(found.extent.descents) if one.descent is Descent.DECADES)
    return [OutcomeRow(row.roll_deg, row.pitch_deg, row.outcomes(number)) for row in found.descents]
