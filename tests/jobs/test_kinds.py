"""Jobs of every kind: their chunks go where they belong, and what is published is found from the job."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from sqlalchemy import Engine

from tests.jobs.jobs import GRID, INPUTS, SETTLED_INPUTS, SUCCESS_INPUTS, commit, made_up_orientation, read_job
from threadstate.device.model import Outcome, SettledMargins, SettledState
from threadstate.jobs.model import JobInputs, code_versions, kind_of
from threadstate.jobs.names import JobKind, JobState
from threadstate.jobs.queue import submit_job
from threadstate.jobs.stores import STORES
from threadstate.jobs.work import complete_chunk, lease_chunks, next_job, open_job, publish_job
from threadstate.jobs.workers import join
from threadstate.library.write import IncompleteLibraryError
from threadstate.settled.read import named_settled_library
from threadstate.settled.rows import settled_rows
from threadstate.settled.write import write_settled
from threadstate.success.document import map_sha256
from threadstate.success.read import committed_orientations, named_success_map, orientations_of_map
from threadstate.success.write import write_orientation

NO_MARGINS = SettledMargins(None, None, None, None, None)


def undecided(pose: tuple[float, float, float]) -> SettledState:
    """A state without an answer."""
    return SettledState(*pose, Outcome.UNDECIDED, (), None, None, None, (), None, (), NO_MARGINS, ())


Commit = Callable[[Engine, int, int], object]


def commit_settled(engine: Engine, store_id: int, index: int) -> None:
    """Commit states that are undecided."""
    states = [undecided(pose) for pose in GRID.poses(index)]
    write_settled(engine, store_id, settled_rows(GRID.orientation(index), GRID.first_ordinal(index), states))


def commit_success(engine: Engine, store_id: int, index: int) -> None:
    """Commit an orientation of the map."""
    write_orientation(engine, store_id, made_up_orientation(SUCCESS_INPUTS, index))


KINDS = pytest.mark.parametrize(
    ("inputs", "commit_one"), [(INPUTS, commit), (SETTLED_INPUTS, commit_settled), (SUCCESS_INPUTS, commit_success)]
)


@KINDS
def test_a_job_is_worked_off_and_its_result_is_found(engine: Engine, inputs: JobInputs, commit_one: Commit) -> None:
    job, store = submit_job(engine, inputs), STORES[kind_of(inputs)]
    assert (job.kind, job.inputs, job.published_id) == (kind_of(inputs), inputs, None)
    assert submit_job(engine, inputs).id == job.id
    found = next_job(engine, code_versions())
    assert found is not None
    assert found.inputs == inputs
    worker, store_id = join(engine, "one"), store.open(engine, inputs)
    assert store.open(engine, inputs) == store_id
    commit_one(engine, store_id, 3)
    open_job(engine, job.id, store_id)
    assert read_job(engine, job.id).done_count == 1
    while taken := lease_chunks(engine, worker, job.id, 1):
        commit_one(engine, store_id, taken[0])
        commit_one(engine, store_id, taken[0])
        assert complete_chunk(engine, worker, job.id, taken[0])
    assert publish_job(engine, worker, job.id, store_id, GRID)
    done = read_job(engine, job.id)
    assert (done.state, done.published_id) == (JobState.DONE, store_id)
    assert submit_job(engine, inputs).state is JobState.DONE


@KINDS
def test_what_lacks_a_chunk_is_not_published(engine: Engine, inputs: JobInputs, commit_one: Commit) -> None:
    job, store = submit_job(engine, inputs), STORES[kind_of(inputs)]
    worker, store_id = join(engine, "one"), store.open(engine, inputs)
    open_job(engine, job.id, store_id)
    for index in lease_chunks(engine, worker, job.id, GRID.orientation_count):
        if index != 4:
            commit_one(engine, store_id, index)
        complete_chunk(engine, worker, job.id, index)
    with pytest.raises(IncompleteLibraryError, match="8 of 9 orientations"):
        publish_job(engine, worker, job.id, store_id, GRID)
    assert read_job(engine, job.id).published_id is None


def test_jobs_of_each_kind_stand_side_by_side(engine: Engine) -> None:
    jobs = [submit_job(engine, inputs) for inputs in (INPUTS, SETTLED_INPUTS, SUCCESS_INPUTS)]
    assert [job.kind for job in jobs] == list(JobKind)
    assert [read_job(engine, job.id).inputs for job in jobs] == [INPUTS, SETTLED_INPUTS, SUCCESS_INPUTS]
    assert {job.code_version for job in jobs} <= code_versions()


def test_a_map_is_read_while_it_grows_and_once_it_is_published(engine: Engine) -> None:
    store = STORES[JobKind.SUCCESS]
    map_id, sha256 = store.open(engine, SUCCESS_INPUTS), SUCCESS_INPUTS.sha256
    expected = [made_up_orientation(SUCCESS_INPUTS, index) for index in range(GRID.orientation_count)]
    for index in (7, 2):
        write_orientation(engine, map_id, expected[index])
    with engine.connect() as connection:
        assert committed_orientations(connection, sha256) == [expected[2], expected[7]]
        assert committed_orientations(connection, "0" * 64) == []
    for one in expected:
        assert write_orientation(engine, map_id, one) == (one.index not in (2, 7))
    with engine.begin() as connection:
        content = store.publish(connection, map_id, GRID)
        assert store.publish(connection, map_id, GRID) == content
    assert content == map_sha256(expected)
    with engine.connect() as connection:
        found = named_success_map(connection, "latest")
        assert named_success_map(connection, str(map_id)) == found
        assert orientations_of_map(connection, map_id) == expected
        assert orientations_of_map(connection, map_id, after=4, limit=2) == expected[5:7]
    assert (found.input_sha256, found.content_sha256, found.inputs) == (sha256, content, SUCCESS_INPUTS)


def test_a_settled_library_of_a_job_is_found_with_the_hash_it_was_published_with(engine: Engine) -> None:
    store = STORES[JobKind.SETTLED]
    library_id = store.open(engine, SETTLED_INPUTS)
    for index in range(GRID.orientation_count):
        commit_settled(engine, library_id, index)
    with engine.begin() as connection:
        content = store.publish(connection, library_id, GRID)
    with engine.connect() as connection:
        assert named_settled_library(connection, "latest").content_sha256 == content
