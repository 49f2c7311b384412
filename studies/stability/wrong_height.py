"""Wrong heights of descents looked at again: about their poses, and by finer meshes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

from studies.methods.case import Case
from studies.methods.mesh import MeshStates
from studies.methods.method import Method
from studies.stability.agreement import Outcome, truths
from studies.stability.descent_study import DescentRow, first_height, judged
from threadstate.mesh.presets import Preset
from threadstate.thread.pair import Pair

FINER = Preset.FINE


@dataclass(frozen=True, slots=True)
class WrongHeight:
    """A height that a descent gets wrong, and the exact one; lengths in the pair's unit."""

    method: MeshStates
    case: Case
    height: float
    exact: float


@dataclass(frozen=True, slots=True)
class SecondLook:
    """What a wrong height is seen to be.

    ``beside_event``: it lies, to within the declared error, between the exact heights of poses and bolts that are off
    by no more than that. ``finer`` is what the same descent of ``FINER`` meshes gives.
    """

    wrong: WrongHeight
    beside_event: bool
    finer: Outcome


def wrong_heights(methods: Iterable[MeshStates], pair: Pair, rows: Iterable[DescentRow]) -> Iterator[WrongHeight]:
    """All of them, descent by descent in the order of the grid."""
    known = list(rows)
    for number, method in enumerate(methods):
        for row in known:
            for pose, outcome, found, exact in zip(
                row.poses_deg, row.outcomes(number), row.heights[number], row.exact, strict=True
            ):
                if outcome is Outcome.HEIGHT and found.height is not None and exact is not None:
                    yield WrongHeight(method, Case(pair, pose), found.height, exact)


def second_look(exact: Method, wrong: WrongHeight) -> SecondLook:
    """Look again at one."""
    pair = wrong.case.pair
    error = wrong.method.declared_error(pair)
    heights = [known.state.poses[0].translation[2] for known in truths(exact, wrong.case, error)]
    finer = replace(wrong.method, preset=FINER)
    return SecondLook(
        wrong,
        min(heights) - error <= wrong.height <= max(heights) + error,
        judged(wrong.exact, first_height(finer, wrong.case).height, finer.declared_error(pair)),
    )
