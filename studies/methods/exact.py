"""The exact method, as one that answers or refuses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from studies.methods.case import Case
from studies.methods.method import Answer, Refusal
from threadstate.errors import UnresolvedPoseError
from threadstate.state.solve import solve_poses
from threadstate.thread.pair import Pair

BATCH = 32
DECLARED_PITCHES = 2e-8


@dataclass(frozen=True)
class ExactMethod:
    """Contacts from edge curves, closed by bounds (decision 1)."""

    name: str = "exact"

    def declared_error(self, pair: Pair) -> float:
        """1e-9 in on a 1/4-20."""
        return DECLARED_PITCHES * pair.thread_pitch

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases; neighbours of one pair are solved together."""
        found: list[Answer] = []
        for _, group in groupby(cases, key=lambda case: (id(case.pair), case.options)):
            together = list(group)
            for start in range(0, len(together), BATCH):
                found += _batch(together[start : start + BATCH])
        return found


def _batch(cases: list[Case]) -> list[Answer]:
    try:
        return [*solve_poses(cases[0].pair, [case.pose_deg for case in cases], cases[0].options)]
    except UnresolvedPoseError as error:
        if len(cases) == 1:
            return [Refusal(str(error).rpartition("deg: ")[2])]
        return [answer for case in cases for answer in _batch([case])]
