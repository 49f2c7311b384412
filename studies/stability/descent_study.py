"""Heights of first contact over the grid by both descents of the mesh method, against the exact ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studies.methods.case import Case
from studies.methods.mesh import MeshStates
from studies.methods.method import Method
from studies.stability.agreement import Outcome
from threadstate.errors import MeshUndecidedError
from threadstate.library.grid import Grid
from threadstate.mesh.options import Descent
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import mesh_method
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
        """Of each pose: right within the error that the method declares, refused, or a wrong height."""
        pairs = zip(self.exact, self.heights[descent], strict=True)
        return tuple(judged(exact, found.height, self.errors[descent]) for exact, found in pairs)


@dataclass(frozen=True)
class OutcomeRow:
    """An orientation with the outcome at each phase."""

    roll_deg: float
    pitch_deg: float
    poses: tuple[Outcome, ...]


def judged(exact: float | None, found: float | None, error: float) -> Outcome:
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
        pose, _ = mesh_method(case.pair, method.options).first_pose(case.pose_deg)
    except MeshUndecidedError as error:
        return Height(None, error.reason)
    return Height(float(pose[2, 3]))
