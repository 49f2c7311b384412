"""Heights of first contact over the grid by both descents of the mesh method, against the exact ones.

Those that are wrong are checked again: about their poses, and by finer meshes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from studies.methods import Case, MeshStates, Method
from studies.stability.agreement import Outcome, truths
from threadstate.errors import MeshUndecidedError
from threadstate.library.grid import Grid
from threadstate.mesh.options import Descent
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import mesh_procedure
from threadstate.state.model import ContactState
from threadstate.thread.pair import Pair

DESCENTS = (MeshStates(Preset.COARSE, Descent.SAFE), MeshStates(Preset.COARSE, Descent.DECADES))


@dataclass(frozen=True, slots=True)
class Height:
    """What a descent ends at: a height in the pair's unit, or None and the reason."""

    height: float | None
    reason: str = ""


@dataclass(frozen=True)
class DescentRow:
    """An orientation at all phases: the exact heights, and those of each descent."""

    poses_deg: tuple[tuple[float, float, float], ...]
    exact: tuple[float | None, ...]
    heights: tuple[tuple[Height, ...], ...]
    errors: tuple[float, ...]

    @property
    def roll_deg(self) -> float:
        """Of all poses."""
        return self.poses_deg[0][0]

    @property
    def pitch_deg(self) -> float:
        """Of all poses."""
        return self.poses_deg[0][1]

    def outcomes(self, descent: int) -> tuple[Outcome, ...]:
        """Of each pose: right within the method's declared error, refused, or a wrong height."""
        pairs = zip(self.exact, self.heights[descent], strict=True)
        return tuple(height_outcome(exact, found.height, self.errors[descent]) for exact, found in pairs)


@dataclass(frozen=True)
class OutcomeRow:
    """An orientation with the outcome at each phase."""

    roll_deg: float
    pitch_deg: float
    poses: tuple[Outcome, ...]


def height_outcome(exact: float | None, found: float | None, error: float) -> Outcome:
    """A height against the exact one."""
    if found is None:
        return Outcome.REFUSED
    if exact is None:
        return Outcome.NO_TRUTH
    return Outcome.HEIGHT if abs(found - exact) > error else Outcome.RIGHT


def descent_row(exact: Method, descents: Sequence[MeshStates], pair: Pair, grid: Grid, orientation: int) -> DescentRow:
    """One orientation, by its number in the grid."""
    cases = [Case(pair, pose) for pose in grid.poses(orientation)]
    states = exact.answers(cases)
    return DescentRow(
        poses_deg=tuple(case.pose_deg for case in cases),
        exact=tuple(state.poses[0].translation[2] if isinstance(state, ContactState) else None for state in states),
        heights=tuple(tuple(first_height(method, case) for case in cases) for method in descents),
        errors=tuple(method.declared_error(pair) for method in descents),
    )


def first_height(method: MeshStates, case: Case) -> Height:
    """Where the descending meshes first collide."""
    try:
        pose, _ = mesh_procedure(case.pair, method.options).first_pose(case.pose_deg)
    except MeshUndecidedError as error:
        return Height(None, error.reason)
    return Height(float(pose[2, 3]))


FINER = Preset.FINE


@dataclass(frozen=True, slots=True)
class WrongHeight:
    """A height that a descent gets wrong, and the exact one; lengths in the pair's unit."""

    method: MeshStates
    case: Case
    height: float
    exact: float


@dataclass(frozen=True, slots=True)
class Recheck:
    """What a second check of a wrong height shows.

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


def recheck(exact: Method, wrong: WrongHeight) -> Recheck:
    """Check one wrong height again."""
    pair = wrong.case.pair
    error = wrong.method.declared_error(pair)
    heights = [known.state.poses[0].translation[2] for known in truths(exact, wrong.case, error)]
    finer = replace(wrong.method, preset=FINER)
    return Recheck(
        wrong,
        min(heights) - error <= wrong.height <= max(heights) + error,
        height_outcome(wrong.exact, first_height(finer, wrong.case).height, finer.declared_error(pair)),
    )
