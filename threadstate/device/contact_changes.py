"""Contacts gained and lost on two paths of one bolt, compared."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from threadstate.device.assembly_model import PathEvent, PathEventKind
from threadstate.state.model import FeaturePair

WITHIN_DEG = 0.05
"""How far apart two changes are at most that are the same: within ten of the steps in which they are told."""

RESOLVED_DEG, RESOLVED_WITH_FRICTION_DEG = 0.01, 0.1
"""What a contact loses to another one of the same features within so much of phase is not told apart: twice the width
of the steps in which contacts change.
"""


class ContactChange(NamedTuple):
    """A contact of these features is gained or lost (a kind of event) at a phase in degrees."""

    kind: PathEventKind
    features: FeaturePair
    phase_deg: float


class Comparison(NamedTuple):
    """How far (deg) the changes are apart that two paths have in common, and those that one of them has alone."""

    apart_deg: tuple[float, ...]
    first_alone: tuple[ContactChange, ...]
    second_alone: tuple[ContactChange, ...]

    @property
    def is_alike(self) -> bool:
        """Whether no path has a change alone."""
        return not self.first_alone and not self.second_alone


def contact_changes(events: Iterable[PathEvent]) -> tuple[ContactChange, ...]:
    """The contacts gained and lost in a path's events; one that moves to other features is lost and gained."""
    found = []
    for event in events:
        if event.kind in (PathEventKind.GAINED, PathEventKind.MOVED) and event.features is not None:
            found.append(ContactChange(PathEventKind.GAINED, event.features, event.phase_deg))
        if event.kind in (PathEventKind.LOST, PathEventKind.MOVED) and event.features_before is not None:
            found.append(ContactChange(PathEventKind.LOST, event.features_before, event.phase_deg))
    return tuple(found)


def compare_changes(
    one: Sequence[ContactChange],
    other: Sequence[ContactChange],
    within_deg: float,
    resolved_deg: float = RESOLVED_DEG,
) -> Comparison:
    """The changes of two paths that are the same within ``within_deg``, each with the nearest one that is left.

    What one path alone loses and gains of the same features within ``resolved_deg`` is left out.
    """
    left = list(other)
    apart, alone = [], []
    for change in one:
        same = [found for found in left if found[:2] == change[:2]]
        nearest = min(same, key=lambda found: abs(found.phase_deg - change.phase_deg), default=None)
        if nearest is None or abs(nearest.phase_deg - change.phase_deg) > within_deg:
            alone.append(change)
            continue
        apart.append(abs(nearest.phase_deg - change.phase_deg))
        left.remove(nearest)
    return Comparison(tuple(apart), _without_exchanges(alone, resolved_deg), _without_exchanges(left, resolved_deg))


def _without_exchanges(changes: list[ContactChange], resolved_deg: float) -> tuple[ContactChange, ...]:
    """Changes without pairs of a gain and a loss of the same features that are not told apart."""
    kept: list[ContactChange] = []
    for change in changes:
        opposite = next(
            (
                found
                for found in kept
                if found.features is change.features
                and found.kind is not change.kind
                and abs(found.phase_deg - change.phase_deg) <= resolved_deg
            ),
            None,
        )
        if opposite is None:
            kept.append(change)
        else:
            kept.remove(opposite)
    return tuple(kept)
