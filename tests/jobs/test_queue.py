from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from sqlalchemy import Engine, delete

from tests.jobs.jobs import (
    GRID,
    INPUTS,
    SETTLED_INPUTS,
    SUCCESS_INPUTS,
    events,
    opened,
    published_count,
    read_job,
    work_off,
)
from threadstate.device.model import About, default_device
from threadstate.device.strategy import Strategy
from threadstate.errors import NotFoundError
from threadstate.jobs.model import JobEndedError, JobInputs, inputs_from_json, inputs_json, kind_of
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import cancel, jobs_before, submit_job
from threadstate.jobs.work import complete_chunk, lease_chunks, publish_job
from threadstate.jobs.workers import join
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.tables import library
from threadstate.mesh.options import MeshOptions
from threadstate.settled.inputs import SettledInputs
from threadstate.state.options import SolveOptions
from threadstate.success.inputs import SuccessInputs
from threadstate.thread.catalogue import RootForm, quarter_twenty_unc


@pytest.mark.parametrize(
    "inputs",
    [
        INPUTS,
        LibraryInputs(quarter_twenty_unc(RootForm.NEWER), Grid(0.3, 0.1, 0.25), SolveOptions(tie_tolerance=3e-11)),
        LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions(), MeshOptions(checked=False)),
        SETTLED_INPUTS,
        SettledInputs(quarter_twenty_unc(), GRID, replace(default_device(), centre=-0.1, about=About.BOLT)),
        SUCCESS_INPUTS,
        SuccessInputs(
            quarter_twenty_unc(), default_device(), Strategy.CW, Grid(0.3, 0.1, 0.25), (0.0, 0.07), 0.3, 1e-3, 700
        ),
    ],
)
def test_inputs_are_the_same_after_the_database(inputs: JobInputs) -> None:
    again = inputs_from_json(kind_of(inputs), inputs_json(inputs))
    assert again == inputs
    assert again.sha256 == inputs.sha256


def test_the_same_job_asked_for_twice_is_one(engine: Engine) -> None:
    first, second = submit_job(engine, INPUTS), submit_job(engine, INPUTS)
    assert first == second
    assert (first.state, first.chunk_count, first.done_count) == (JobState.QUEUED, 9, 0)
    assert [event.kind for event in events(engine, first.id)] == [EventKind.QUEUED]
    assert submit_job(engine, replace(INPUTS, grid=Grid(0.0, 1.0, 180.0))).id != first.id


def test_the_same_job_asked_for_by_many_at_once_is_one(engine: Engine) -> None:
    with ThreadPoolExecutor(8) as pool:
        asked = list(pool.map(lambda _: submit_job(engine, INPUTS), range(16)))
    assert len({one.id for one in asked}) == 1
    with engine.connect() as connection:
        assert len(jobs_before(connection, 2**31, 10)) == 1
    assert len(events(engine, asked[0].id)) == 1


def test_the_latest_jobs_come_first_page_by_page(engine: Engine) -> None:
    ids = [submit_job(engine, replace(INPUTS, grid=Grid(0.0, 1.0, 360.0 / n))).id for n in (1, 2, 3)]
    with engine.connect() as connection:
        assert [one.id for one in jobs_before(connection, 2**63, 2)] == [ids[2], ids[1]]
        assert [one.id for one in jobs_before(connection, ids[1], 2)] == [ids[0]]


def test_a_cancelled_job_is_not_worked_on_and_publishes_nothing(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    library_id = opened(engine, job.id)
    work_off(engine, worker, job.id, library_id, most=8)
    (last,) = lease_chunks(engine, worker, job.id, 9)
    assert cancel(engine, job.id).state is JobState.CANCELLED
    assert not complete_chunk(engine, worker, job.id, last)
    assert lease_chunks(engine, worker, job.id, 9) == ()
    assert not publish_job(engine, worker, job.id, library_id, GRID)
    assert published_count(engine) == 0
    assert cancel(engine, job.id) == read_job(engine, job.id)
    assert [event.kind for event in events(engine, job.id)][-1] is EventKind.CANCELLED


def test_a_cancelled_job_asked_for_again_goes_on_with_what_is_committed(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    library_id = opened(engine, job.id)
    work_off(engine, worker, job.id, library_id, most=4)
    cancel(engine, job.id)
    again = submit_job(engine, INPUTS)
    assert (again.id, again.state, again.ended_at, again.done_count) == (job.id, JobState.QUEUED, None, 0)
    assert opened(engine, job.id) == library_id
    assert read_job(engine, job.id).done_count == 4
    assert work_off(engine, worker, job.id, library_id) == 5
    assert publish_job(engine, worker, job.id, library_id, GRID)
    numbers = [event.number for event in events(engine, job.id)]
    assert numbers == list(range(1, len(numbers) + 1))


def test_a_job_that_is_done_stays_done_while_its_library_is_there(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    library_id = opened(engine, job.id)
    work_off(engine, worker, job.id, library_id)
    publish_job(engine, worker, job.id, library_id, GRID)
    done = submit_job(engine, INPUTS)
    assert (done.state, done.published_id) == (JobState.DONE, library_id)
    with pytest.raises(JobEndedError):
        cancel(engine, job.id)
    with engine.begin() as connection:
        connection.execute(delete(library))
    assert submit_job(engine, INPUTS).state is JobState.QUEUED


def test_a_job_that_is_not_there_is_not_found(engine: Engine) -> None:
    for job_id in (1, 2**31 - 1, 2**31, 10**18):
        with pytest.raises(NotFoundError):
            read_job(engine, job_id)
    with pytest.raises(NotFoundError):
        cancel(engine, 1)
