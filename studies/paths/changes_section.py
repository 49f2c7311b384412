"""The section of the page of paths on those without friction."""

from __future__ import annotations

from collections.abc import Sequence

from harness.markdown import table
from studies.paths.changes import STEPS_DEG, Pose
from studies.paths.listing import listed, percentiles
from threadstate.device.confirmation import LEAST_FALL
from threadstate.device.contact_changes import RESOLVED_DEG, WITHIN_DEG
from threadstate.numbers import number_text


def changes_section(poses: Sequence[Pose]) -> str:
    """The section as Markdown, from its first paragraph on."""
    rows, exceptions = [], []
    for number, step_deg in enumerate(STEPS_DEG[:-1]):
        decided = [pose for pose in poses if pose.is_decided(number)]
        others = [pose for pose in decided if pose.turned[number].outcome is not pose.turned[number + 1].outcome]
        unlike = [pose for pose in decided if not pose.halves[number].changes.is_alike]
        falls = [pose for pose in decided if not pose.halves[number].same_falls]
        apart = [deg for pose in decided for deg in pose.halves[number].changes.apart_deg]
        steps = f"{number_text(step_deg)}, {number_text(STEPS_DEG[number + 1])}"
        counts = [f"{len(some):,}" for some in (decided, others, falls, unlike, apart)]
        rows.append([steps, *counts, percentiles(apart)])
        exceptions.append(listed(f"Other outcomes, steps of {steps} deg", [pose.name for pose in others]))
        exceptions.append(listed(f"Other falls, steps of {steps} deg", [pose.name for pose in falls]))
        exceptions.append(
            listed(f"Other changes, steps of {steps} deg", [_changes_text(pose, number) for pose in unlike])
        )
    head = (
        "steps, deg",
        "paths decided",
        "other outcomes",
        "other falls",
        "other changes",
        "changes in common",
        "apart by, deg: median, 90 %, most",
    )
    flagged = sum(pose.turned[0].is_flagged for pose in poses)
    bridged = sum(pose.turned[0].bridged > 0 for pose in poses)
    return f"""{len(poses):,} paths by `ccw_then_cw`. A *change* is a contact gained or lost; one that moves to other
features is both. Changes of the same kind and features that are within {number_text(WITHIN_DEG)} deg are the same, and
what a path alone loses and gains of the same features within {number_text(RESOLVED_DEG)} deg is left out. *Other
changes* are paths of which one step has a change alone; *other falls* those whose snap, or a fall that loses more than
{number_text(LEAST_FALL)} F r, is moved by more than the step or is there with one of them alone.

{table(head, rows)}

With the usual steps {bridged:,} of the paths are bridged somewhere, and {flagged:,} flagged `step_dependent`.
{"".join(exceptions)}"""


def _changes_text(pose: Pose, number: int) -> str:
    changes = pose.halves[number].changes
    told = [
        f"{change.kind.value} {change.features.value} at {change.phase_deg:.2f} by {who}"
        for who, some in (("the first", changes.first_alone), ("the second", changes.second_alone))
        for change in some
    ]
    return f"{pose.name}: {'; '.join(told)}"
