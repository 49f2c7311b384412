"""The collision of meshes, as a method that answers or refuses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studies.methods.case import Case
from studies.methods.method import Answer, Refusal
from threadstate.errors import MeshUndecidedError
from threadstate.mesh.options import Descent, FinalStep, MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import mesh_method, solve_poses_by_mesh
from threadstate.thread.pair import Pair


@dataclass(frozen=True)
class MeshStates:
    """States by meshes of a preset, stepped to a final step in thread pitches (decision 4).

    A safe descent is checked by a second tessellation; decades are not, as the paper has no such check.
    """

    preset: Preset
    descent: Descent
    final_step: float = FinalStep.ONE_MICROINCH.thread_pitches

    @property
    def name(self) -> str:
        """What it is called on the page."""
        return f"mesh {self.descent}, {self.preset}"

    @property
    def options(self) -> MeshOptions:
        """Its settings."""
        checked = self.descent is Descent.SAFE
        return MeshOptions(self.preset.tessellation, self.descent, self.final_step, checked=checked)

    def declared_error(self, pair: Pair) -> float:
        """How far both meshes' edges are off the true ones, and the final step."""
        return mesh_method(pair, self.options).edge_deviation + self.final_step * pair.thread_pitch

    def answers(self, cases: Sequence[Case]) -> list[Answer]:
        """The answers in the order of the cases."""
        return [self._answer(case) for case in cases]

    def _answer(self, case: Case) -> Answer:
        try:
            return solve_poses_by_mesh(case.pair, [case.pose_deg], self.options, case.options)[0]
        except MeshUndecidedError as error:
            return Refusal(error.reason)
