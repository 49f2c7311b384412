from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import pytest
from sqlalchemy import Engine, delete, select

from tests.jobs.jobs import GRID, INPUTS, commit, events, opened, published_count, read_job, work_off
from threadstate.jobs.model import code_versions
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import cancel, submit_job
from threadstate.jobs.tables import job_chunk
from threadstate.jobs.work import (
    MAX_FAILURES,
    all_jobs_ended,
    complete_chunk,
    lease_chunks,
    next_job,
    publish_job,
    release_chunks,
    requeue_job,
    should_switch_job,
)
from threadstate.jobs.workers import LostLeaseError, beat, beats, join, leave, remove_dead_worker
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.read import library_by_id
from threadstate.library.tables import chunk, library
from threadstate.library.write import IncompleteLibraryError


def test_a_job_from_the_question_to_the_library(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    library_id = opened(engine, job.id)
    assert work_off(engine, worker, job.id, library_id) == GRID.orientation_count
    assert published_count(engine) == 0
    assert publish_job(engine, worker, job.id, library_id, GRID)
    assert not publish_job(engine, worker, job.id, library_id, GRID)
    done = read_job(engine, job.id)
    assert (done.state, done.published_id, done.done_count, done.lease_count) == (JobState.DONE, library_id, 9, 0)
    assert done.ended_at is not None
    assert [(event.kind, event.done_count) for event in events(engine, job.id)] == [
        (EventKind.QUEUED, 0),
        (EventKind.STARTED, 0),
        *((EventKind.PROGRESS, count) for count in range(1, 10)),
        (EventKind.PUBLISHED, 9),
    ]
    assert [event.number for event in events(engine, job.id, after=10)] == [11, 12]
    assert all_jobs_ended(engine, code_versions())


def test_work_is_the_oldest_job_of_this_code_that_there_is_something_to_do_on(engine: Engine) -> None:
    versions = code_versions()
    assert INPUTS.code_version in versions
    assert next_job(engine, versions) is None
    first, second = submit_job(engine, INPUTS), submit_job(engine, replace(INPUTS, grid=Grid(0.0, 1.0, 180.0)))
    assert next_job(engine, {"another"}) is None
    assert all_jobs_ended(engine, {"another"})

    def number() -> int | None:
        work = next_job(engine, versions)
        assert work is None or work.inputs.sha256 == read_job(engine, work.job_id).input_sha256
        return None if work is None else work.job_id

    worker = join(engine, "one")
    assert number() == first.id
    library_id = opened(engine, first.id)
    assert number() == first.id
    lease_chunks(engine, worker, first.id, 9)
    assert number() == second.id
    cancel(engine, second.id)
    assert number() is None
    assert not all_jobs_ended(engine, versions)
    leave(engine, worker)
    assert number() == first.id
    other = join(engine, "other")
    work_off(engine, other, first.id, library_id)
    assert number() == first.id, "it can be published"
    publish_job(engine, other, first.id, library_id, GRID)
    assert number() is None
    assert all_jobs_ended(engine, versions)


SMALLER = replace(INPUTS, grid=Grid(1.0, 1.0, 360.0))


@pytest.mark.parametrize("begun_first", [0, 1])
def test_workers_spread_over_jobs(engine: Engine, begun_first: int) -> None:
    older, younger = (submit_job(engine, inputs).id for inputs in (INPUTS, SMALLER))
    opened(engine, older)
    opened(engine, younger, SMALLER)
    jobs = [older, younger] if begun_first == 0 else [younger, older]
    assert _next(engine) == older, "nobody is at either"
    lease_chunks(engine, join(engine, "a"), jobs[0], 2)
    assert _next(engine) == jobs[1], "chunks are not counted, workers are"
    lease_chunks(engine, join(engine, "b"), jobs[1], 1)
    assert _next(engine) == older, "one is at each"
    third = join(engine, "c")
    lease_chunks(engine, third, older, 1)
    assert _next(engine) == younger
    leave(engine, third)
    assert _next(engine) == older


def test_a_job_that_can_be_published_is_not_passed_over(engine: Engine) -> None:
    older, younger = (submit_job(engine, inputs).id for inputs in (INPUTS, SMALLER))
    opened(engine, older)
    library_id = opened(engine, younger, SMALLER)
    lease_chunks(engine, join(engine, "one"), older, 1)
    work_off(engine, join(engine, "two"), younger, library_id, grid=SMALLER.grid)
    assert _next(engine) == younger


@pytest.mark.parametrize("younger_is_begun", [False, True])
def test_all_but_one_leave_a_job_for_one_that_nobody_is_at(engine: Engine, younger_is_begun: bool) -> None:
    older, younger = (submit_job(engine, inputs).id for inputs in (INPUTS, SMALLER))
    opened(engine, older)
    versions = code_versions()
    one, two, three = sorted(join(engine, name) for name in "abc")
    lease_chunks(engine, two, older, 1)
    assert not should_switch_job(engine, two, older, versions), "it is the only one there"
    lease_chunks(engine, one, older, 1)
    if younger_is_begun:
        opened(engine, younger, SMALLER)
    assert should_switch_job(engine, two, older, versions)
    assert should_switch_job(engine, three, older, versions), "although it has taken nothing yet"
    assert not should_switch_job(engine, one, older, versions)
    assert not should_switch_job(engine, two, older, {"another"})
    if not younger_is_begun:
        opened(engine, younger, SMALLER)
    lease_chunks(engine, three, younger, 1)
    assert not should_switch_job(engine, two, older, versions)
    leave(engine, three)
    assert should_switch_job(engine, two, older, versions)
    cancel(engine, younger)
    assert not should_switch_job(engine, two, older, versions)


def _next(engine: Engine) -> int | None:
    work = next_job(engine, code_versions())
    return None if work is None else work.job_id


def test_chunks_are_taken_once_by_many_at_once(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    opened(engine, job.id)
    workers = [join(engine, str(number)) for number in range(4)]

    def take_all(worker: str) -> list[int]:
        found: list[int] = []
        while taken := lease_chunks(engine, worker, job.id, 1):
            found += taken
        return found

    with ThreadPoolExecutor(4) as pool:
        taken = list(pool.map(take_all, workers))
    assert sorted(index for one in taken for index in one) == list(range(9))
    assert read_job(engine, job.id).lease_count == 9


def test_what_a_removed_worker_was_at_is_free_and_not_counted_twice(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    library_id = opened(engine, job.id)
    silent, other = join(engine, "silent"), join(engine, "other")
    assert list(lease_chunks(engine, silent, job.id, 3)) == [0, 1, 2]
    assert remove_dead_worker(engine, silent, beats(engine)[silent])
    assert work_off(engine, other, job.id, library_id) == 9
    # It wakes up, and does as if nothing had happened.
    commit(engine, library_id, 0)
    assert complete_chunk(engine, silent, job.id, 0)
    assert read_job(engine, job.id).done_count == 9
    for late in (beat, lambda *_: lease_chunks(engine, silent, job.id, 1)):
        with pytest.raises(LostLeaseError, match="considered dead"):
            late(engine, silent)
    with engine.connect() as connection:
        assert len(connection.scalars(select(chunk.c.orientation)).all()) == 9


def test_what_a_living_worker_is_not_at_any_more_is_freed_by_it(engine: Engine) -> None:
    """As where the server has forgotten that a chunk was handed in."""
    job = submit_job(engine, INPUTS)
    library_id = opened(engine, job.id)
    one, other = join(engine, "one"), join(engine, "other")
    assert list(lease_chunks(engine, other, job.id, 1)) == [0]
    assert list(lease_chunks(engine, one, job.id, 9)) == list(range(1, 9))
    assert next_job(engine, code_versions()) is None
    release_chunks(engine, one)
    assert read_job(engine, job.id).lease_count == 1
    assert work_off(engine, one, job.id, library_id) == 8
    release_chunks(engine, one)
    assert complete_chunk(engine, other, job.id, 0)
    assert read_job(engine, job.id).done_count == 9


def test_an_old_owner_cannot_publish(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    library_id = opened(engine, job.id)
    old = join(engine, "old")
    work_off(engine, old, job.id, library_id)
    assert remove_dead_worker(engine, old, 0)
    with pytest.raises(LostLeaseError):
        publish_job(engine, old, job.id, library_id, GRID)
    with pytest.raises(LostLeaseError):
        requeue_job(engine, old, job.id, "a failure")
    assert published_count(engine) == 0
    assert read_job(engine, job.id).state is JobState.RUNNING
    new = join(engine, "new")
    assert new != old
    assert publish_job(engine, new, job.id, library_id, GRID)


def test_one_that_beats_in_time_is_not_removed(engine: Engine) -> None:
    worker = join(engine, "one")
    seen = beats(engine)[worker]
    beat(engine, worker)
    assert not remove_dead_worker(engine, worker, seen)
    assert beats(engine) == {worker: seen + 1}


def test_nothing_is_published_while_a_chunk_is_missing(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    library_id = opened(engine, job.id)
    worker = join(engine, "one")
    work_off(engine, worker, job.id, library_id, most=8)
    assert not publish_job(engine, worker, job.id, library_id, GRID)
    with engine.begin() as connection:
        connection.execute(delete(job_chunk))
    with pytest.raises(IncompleteLibraryError):
        publish_job(engine, worker, job.id, library_id, GRID)
    assert published_count(engine) == 0


def test_a_library_that_went_away_is_computed_anew(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    work_off(engine, worker, job.id, opened(engine, job.id), most=8)
    with engine.begin() as connection:
        connection.execute(delete(library))
    assert requeue_job(engine, worker, job.id, "it is gone") is JobState.QUEUED
    library_id = opened(engine, job.id)
    assert work_off(engine, worker, job.id, library_id) == 9
    assert publish_job(engine, worker, job.id, library_id, GRID)
    with engine.connect() as connection:
        hashes = connection.scalars(select(chunk.c.content_sha256).order_by(chunk.c.orientation)).all()
        assert library_by_id(connection, library_id).content_sha256 == library_sha256(hashes)


def test_too_many_failures_end_a_job_with_the_reason_of_the_last(engine: Engine) -> None:
    job = submit_job(engine, INPUTS)
    worker = join(engine, "one")
    for number in range(1, MAX_FAILURES + 1):
        opened(engine, job.id)
        lease_chunks(engine, worker, job.id, 2)
        state = requeue_job(engine, worker, job.id, f"failure {number}")
        assert state is (JobState.QUEUED if number < MAX_FAILURES else JobState.FAILED)
    failed = read_job(engine, job.id)
    assert (failed.state, failed.reason, failed.lease_count) == (JobState.FAILED, f"failure {MAX_FAILURES}", 0)
    assert events(engine, job.id)[-1].reason == failed.reason
    assert requeue_job(engine, worker, job.id, "one more") is JobState.FAILED
    again = submit_job(engine, INPUTS)
    assert (again.state, again.reason) == (JobState.QUEUED, None)
    opened(engine, job.id)
    assert requeue_job(engine, worker, job.id, "counted again") is JobState.QUEUED
