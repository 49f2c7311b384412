from __future__ import annotations

import json

import pytest

from tests.worker.conftest import CommandLine
from threadstate.library.engine import reader_engine
from threadstate.library.pose import state_of_pose
from threadstate.library.read import latest_library, undecided_between
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import MeshOptions
from threadstate.mesh.presets import Preset
from threadstate.mesh.solve import solve_poses_by_mesh
from threadstate.state.model import UndecidedPose
from threadstate.state.options import SolveOptions
from threadstate.state.solve import solve_poses
from threadstate.stored_histories.compute import exact_answers
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = [pytest.mark.sqlite_alone, pytest.mark.slow]

GRID = ["--tilt-max", "0", "--phase-step", "180"]
"""Level and in phase, which meshes cannot decide, and out of phase, which they can."""
BY_MESH = ["--method", "mesh", "--preset", "coarse", "--final-step", "10uin", "--unchecked"]


def test_a_library_by_meshes_stands_beside_the_exact_one(command_line: CommandLine) -> None:
    exact = json.loads(command_line.out("rebuild", "--json", "--workers", "2", *GRID))
    by_mesh = json.loads(command_line.out("rebuild", "--json", "--workers", "2", *GRID, *BY_MESH))
    assert by_mesh["library"] != exact["library"]
    assert exact["undecided"] == 0
    assert by_mesh["undecided"] > 0
    assert by_mesh["states"] + by_mesh["undecided"] == by_mesh["computed"] == exact["states"] == 2

    options = MeshOptions(Preset.COARSE.tessellation, final_step=2e-4, checked=False)
    engine = reader_engine(command_line.database)
    with engine.connect() as connection:
        assert latest_library(connection).id == exact["library"]
        library = latest_library(connection, method=SolverMethod.MESH)
        assert library.id == by_mesh["library"]
        level = undecided_between(connection, library.id, 0, 1)
        assert (0.0, 0.0, 0.0) in [(pose.roll_deg, pose.pitch_deg, pose.phase_deg) for _, pose in level]
        stored = state_of_pose(connection, library.id, 0.0, 0.0, 180.0)
    engine.dispose()
    assert [stored] == solve_poses_by_mesh(quarter_twenty_unc(), [(0.0, 0.0, 180.0)], options)

    again = json.loads(command_line.here("rebuild", "--json", "--workers", "1", *GRID, *BY_MESH)[1])
    assert again["was_published"]
    counted = json.loads(command_line.here("summary", "--json", "--method", "mesh")[1])
    assert counted["content_sha256"] == by_mesh["content_sha256"]
    assert sum(counted["undecided"].values()) == by_mesh["undecided"]
    assert "rests on a strip of its thread" in command_line.here("summary", "--method", "mesh")[1]


def test_a_setting_of_meshes_needs_their_method(command_line: CommandLine) -> None:
    code, _, error = command_line.here("rebuild", "--preset", "coarse", *GRID)
    assert code == 2
    assert "--method mesh" in error


def test_the_exact_method_names_the_poses_that_it_cannot_decide() -> None:
    """Of grazing edges an onset may stay doubtful; the poses beside one keep their states."""
    grazing = (0.1790897872180624, 0.2289943449118028, 2.2930289846362895)
    poses = [(1.0, 2.0, 30.0), *((1e-6 * i, 2e-6 * i, 0.01 * i) for i in range(1, 6)), grazing, (3.0, -2.0, 200.0)]
    found = exact_answers(quarter_twenty_unc(), SolveOptions(), poses)
    undecided = [answer for answer in found if isinstance(answer, UndecidedPose)]
    assert [(one.roll_deg, one.pitch_deg, one.phase_deg) for one in undecided] == [grazing]
    assert all(one.reason for one in undecided)
    for answer, pose in zip(found, poses, strict=True):
        assert (answer.roll_deg, answer.pitch_deg, answer.phase_deg) == pose
    assert [found[0], found[-1]] == solve_poses(quarter_twenty_unc(), [poses[0], poses[-1]])
