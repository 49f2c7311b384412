"""Workers as processes of their own, on jobs of settled states and of success maps: killed they lose nothing."""

from __future__ import annotations

import time
from collections.abc import Mapping

import pytest

from harness.databases import Databases
from tests.worker.conftest import CommandLine
from tests.worker.test_rebuild import _kill
from threadstate.device.model import default_device
from threadstate.device.strategy import Strategy
from threadstate.jobs.names import JobState
from threadstate.jobs.queue import job_by_id, submit_job
from threadstate.library.engine import writing
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.settings import LEASE_S
from threadstate.settled.compute import computed_rows
from threadstate.settled.inputs import SettledInputs
from threadstate.settled.read import named_settled_library
from threadstate.success.compute import computed_orientation
from threadstate.success.document import map_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.read import named_success_map, orientations_of_map
from threadstate.thread.catalogue import quarter_twenty_unc

pytestmark = [pytest.mark.slow, pytest.mark.sqlite_alone]

PAIR, DEVICE = quarter_twenty_unc(), default_device()
SETTLED = SettledInputs(PAIR, Grid(2.0, 1.0, 120.0), DEVICE)
SUCCESS = SuccessInputs(PAIR, DEVICE, Strategy.CW, Grid(4.0, 4.0, 360.0), (0.0,), phase_tolerance_deg=360.0)
TIMEOUT_S = 120.0


def test_killed_workers_leave_jobs_of_both_kinds_to_others(
    databases: Databases, environment: Mapping[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    with databases.lent() as database, writing(database) as engine:
        command_line = CommandLine(database, {**environment, LEASE_S: "1"}, capsys)
        ids = [submit_job(engine, inputs).id for inputs in (SETTLED, SUCCESS)]

        def done_counts() -> list[int]:
            with engine.connect() as connection:
                return [job_by_id(connection, job_id).done_count for job_id in ids]

        with command_line.start("worker", "--workers", "2", "--until-idle") as worker:
            end = time.monotonic() + TIMEOUT_S
            while done_counts()[1] < 2:
                assert worker.poll() is None
                assert time.monotonic() < end
                time.sleep(0.01)
            _kill(worker)
        kept = done_counts()
        assert 2 <= kept[1] < SUCCESS.grid.orientation_count
        with command_line.start("worker", "--workers", "1", "--until-idle") as worker:
            _, err = worker.communicate(timeout=TIMEOUT_S)
            assert worker.returncode == 0, err
        with engine.connect() as connection:
            jobs = [job_by_id(connection, job_id) for job_id in ids]
            settled, found = named_settled_library(connection, "latest"), named_success_map(connection, "latest")
            orientations = orientations_of_map(connection, found.id)
    assert [job.state for job in jobs] == [JobState.DONE, JobState.DONE]
    assert [job.published_id for job in jobs] == [settled.id, found.id]
    assert settled.content_sha256 == library_sha256(
        [computed_rows(PAIR, SETTLED.grid, DEVICE, i).content_sha256 for i in range(SETTLED.grid.orientation_count)]
    )
    expected = [
        computed_orientation(
            *(PAIR, DEVICE, SUCCESS.strategy, SUCCESS.grid, SUCCESS.frictions, SUCCESS.phase_tolerance_deg),
            *(SUCCESS.mu_tolerance, SUCCESS.point_limit, index),
        )
        for index in range(SUCCESS.grid.orientation_count)
    ]
    assert orientations == expected
    assert found.content_sha256 == map_sha256(expected)
