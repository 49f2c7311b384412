from __future__ import annotations

import pytest
from sqlalchemy import Engine

from tests.library.states import plain_state
from threadstate.errors import NotFoundError, UndecidedPoseError
from threadstate.library import read, write
from threadstate.library.fingerprint import answers_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.pose import state_of_pose
from threadstate.library.rows import chunk_rows
from threadstate.library.solver_method import SolverMethod
from threadstate.mesh.options import MeshOptions
from threadstate.state.model import Answer, UndecidedPose
from threadstate.state.solve import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc

GRID = Grid(1.0, 1.0, 120.0)
INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions(), MeshOptions())
UNDECIDED_PHASE_DEG = 120.0


def _answers(index: int) -> list[Answer]:
    """One pose of each orientation is undecided, and all of orientation 4."""
    return [
        UndecidedPose(*pose, f"reason {index % 2}")
        if index == 4 or pose[2] == UNDECIDED_PHASE_DEG
        else plain_state(*pose)
        for pose in GRID.poses(index)
    ]


def published(writer: Engine) -> int:
    """The number of a library with undecided poses, published in a migrated database."""
    library_id = write.open_library(writer, INPUTS)
    for index in range(GRID.orientation_count):
        rows = chunk_rows(GRID.orientation(index), GRID.first_ordinal(index), _answers(index))
        assert rows.content_sha256 == answers_sha256(_answers(index))
        write.write_chunk(writer, library_id, rows)
    write.publish(writer, library_id, GRID)
    return library_id


def test_a_library_with_undecided_poses_is_whole(writer: Engine, reader: Engine) -> None:
    library_id = published(writer)
    with reader.connect() as connection:
        record = read.latest_library(connection, method=SolverMethod.MESH)
        assert (record.id, record.state_count, record.undecided_count) == (library_id, 16, 11)
        found = read.undecided_between(connection, library_id, 0, GRID.pose_count - 1)
        assert [pose for _, pose in found] == [
            answer for i in range(9) for answer in _answers(i) if isinstance(answer, UndecidedPose)
        ]
        assert read.undecided_between(connection, library_id, found[3][0], 26, limit=2) == found[3:5]
        assert read.undecided_reasons(connection, library_id) == [("reason 0", 7), ("reason 1", 4)]
        assert len(read.states_between(connection, library_id, 0, GRID.pose_count - 1)) == 16


def test_an_undecided_pose_says_why_it_has_no_state(writer: Engine, reader: Engine) -> None:
    library_id = published(writer)
    with reader.connect() as connection:
        assert state_of_pose(connection, library_id, -1.0, -1.0, 240.0) == plain_state(-1.0, -1.0, 240.0)
        with pytest.raises(UndecidedPoseError, match="pitch 0, phase 120 deg: reason 1"):
            state_of_pose(connection, library_id, -1.0, 0.0, 120.0)
        with pytest.raises(NotFoundError) as raised:
            state_of_pose(connection, library_id, -1.0, 0.0, 121.0)
        assert not isinstance(raised.value, UndecidedPoseError)


def test_a_library_by_meshes_does_not_pass_for_the_latest(writer: Engine, reader: Engine) -> None:
    library_id = published(writer)
    with reader.connect() as connection:
        with pytest.raises(NotFoundError):
            read.latest_library(connection)
        assert read.latest_library(connection, method=None).id == library_id


def test_the_hash_of_a_chunk_knows_where_and_why_a_pose_is_undecided() -> None:
    state, pose = plain_state(), UndecidedPose(1.0, -2.0, 31.0, "a reason")
    variants: list[list[Answer]] = [
        [state, pose],
        [pose, state],
        [state],
        [state, UndecidedPose(1.0, -2.0, 31.0, "another")],
        [state, UndecidedPose(1.0, -2.0, 32.0, "a reason")],
    ]
    assert len({answers_sha256(answers) for answers in variants}) == len(variants)
