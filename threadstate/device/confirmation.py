"""Paths confirmed by half the step: whether outcome, falls and contacts hang on how long steps are."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from threadstate.device.assembly_model import AssemblyOutcome, AssemblyPath, PathEventKind
from threadstate.device.contact_changes import (
    RESOLVED_DEG,
    RESOLVED_WITH_FRICTION_DEG,
    WITHIN_DEG,
    compare_changes,
    contact_changes,
)
from threadstate.device.model import SettledFlag

LEAST_FALL = 1e-3
"""Loss (push times nominal radius) of the falls that are compared: whether a lighter one is followed as steps hangs on
their length.
"""


def confirmed(path: AssemblyPath, half: AssemblyPath, longest_deg: float, energy: float) -> AssemblyPath:
    """A path that is followed in steps of at most ``longest_deg``, flagged where ``half``, with half of that, differs.

    ``energy`` is push times nominal radius. Where the outcomes differ the path is undecided, with the flag
    ``step_dependent``. Where only a snap or a fall that loses more than ``LEAST_FALL`` is moved by more than the
    longest step, or is there with one of them alone, it has that flag beside its outcome; so where a contact gained or
    lost is, with friction; without, where it is moved by more than ``WITHIN_DEG``.
    """
    flags = tuple(dict.fromkeys((*path.flags, SettledFlag.STEP_DEPENDENT)))
    if half.outcome is not path.outcome:
        return replace(path, outcome=AssemblyOutcome.UNDECIDED, flags=flags)
    accuracies = (WITHIN_DEG, RESOLVED_DEG) if path.mu == 0.0 else (longest_deg, RESOLVED_WITH_FRICTION_DEG)
    changes = compare_changes(contact_changes(path.events), contact_changes(half.events), *accuracies)
    is_alike = have_same_falls(path, half, longest_deg, LEAST_FALL * energy) and changes.is_alike
    return path if is_alike else replace(path, flags=flags)


def have_same_falls(one: AssemblyPath, other: AssemblyPath, within_deg: float, least: float) -> bool:
    """Whether two paths have the same snap and the same falls that lose more than ``least`` (an energy of the path's),
    none moved by more than ``within_deg``.
    """
    happened = []
    for path in (one, other):
        falls = [(event.phase_deg, event.energy or 0.0) for event in path.events if event.kind is PathEventKind.FALL]
        snaps = [event.phase_deg for event in path.events if event.kind is PathEventKind.SNAP]
        happened.append([*snaps, *heavy_falls(falls, within_deg, least)])
    first, second = happened
    return len(first) == len(second) and all(abs(a - b) <= within_deg for a, b in zip(first, second, strict=True))


def heavy_falls(falls: Iterable[tuple[float, float]], within_deg: float, least: float) -> tuple[float, ...]:
    """The phases (deg) of falls, each a phase and a loss, with those within so much after it; of those that lose more
    than ``least`` together.
    """
    found: list[tuple[float, float]] = []
    for phase_deg, loss in falls:
        if found and abs(phase_deg - found[-1][0]) <= within_deg:
            found[-1] = (found[-1][0], found[-1][1] + loss)
        else:
            found.append((phase_deg, loss))
    return tuple(phase_deg for phase_deg, loss in found if loss > least)
