"""How many workers are at a job is counted by the workers' few chunks, not by a job's many."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from sqlalchemy import Connection, Engine, Select

from tests.jobs.jobs import INPUTS, opened
from threadstate.jobs.queue import submit_job
from threadstate.jobs.work import lease_chunks, next_job_query, switch_job_query
from threadstate.jobs.workers import join

STATEMENTS = [next_job_query(["one", "two"]), switch_job_query("worker", 1, ["one", "two"])]


@pytest.fixture
def connection(engine: Engine) -> Iterator[Connection]:
    """A connection to a database with a job that somebody is at; PostgreSQL reads a whole table only if it has to."""
    job_id = submit_job(engine, INPUTS).id
    opened(engine, job_id)
    lease_chunks(engine, join(engine, "one"), job_id, 1)
    with engine.connect() as connection:
        if connection.dialect.name == "postgresql":
            connection.exec_driver_sql("ANALYZE")
            connection.exec_driver_sql("SET enable_seqscan = off")
        yield connection


@pytest.mark.sqlite_alone
@pytest.mark.parametrize("statement", STATEMENTS)
def test_sqlite_seeks_chunks_in_an_index(connection: Connection, statement: Select[object]) -> None:
    steps = _plan(connection, statement)
    assert any("ix_job_chunk_worker_id (worker_id=? AND job_id=?)" in step for step in steps), steps
    assert not any("SCAN job_chunk" in step for step in steps), steps


@pytest.mark.postgresql_alone
@pytest.mark.parametrize("statement", STATEMENTS)
def test_postgresql_seeks_chunks_in_an_index(connection: Connection, statement: Select[object]) -> None:
    steps = _plan(connection, statement)
    assert not any("Seq Scan" in step for step in steps), steps
    assert any("ix_job_chunk_worker_id" in step or "pk_job_chunk" in step for step in steps), steps


def _plan(connection: Connection, statement: Select[object]) -> list[str]:
    compiled = statement.compile(connection, compile_kwargs={"literal_binds": True})
    explain = "EXPLAIN QUERY PLAN" if connection.dialect.name == "sqlite" else "EXPLAIN"
    return [str(row[-1]) for row in connection.exec_driver_sql(f"{explain} {compiled}".replace("%", "%%"))]
