from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest
from sqlalchemy import func, select

from harness.databases import Databases
from tests.prepared import use_prepared_chunks
from tests.stored_histories.history_library import rows_of
from tests.worker.cluster.clusters import Cluster, running_cluster
from tests.worker.conftest import GRID, SHORT_TURNS, SMALL_GRID, CommandLine
from threadstate.device.model import default_device
from threadstate.history.build import histories_of
from threadstate.jobs.names import EventKind, JobState
from threadstate.jobs.queue import events_after, job_by_id, submit_job
from threadstate.library.engine import reading, writing
from threadstate.library.fingerprint import library_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.read import published_libraries
from threadstate.library.rows import chunk_rows
from threadstate.library.tables import chunk, state, undecided
from threadstate.settings import LEASE_S, SCHEDULER
from threadstate.settled.compute import computed_rows
from threadstate.settled.inputs import SettledInputs
from threadstate.state.solve import solve_poses
from threadstate.statics.rows import statics_by_ordinal
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.cluster.chunks import computing_cluster
from worker.commit import orientation_of
from worker.messages import LibraryChunk
from worker.processes import QUEUED_PER_PROCESS

pytestmark = pytest.mark.slow

INPUTS = LibraryInputs(quarter_twenty_unc(), GRID, SHORT_TURNS)
TIMEOUT_S = 120.0
WORKERS = 2


class SharedCluster:
    """A cluster for many tests, which may kill any part of it."""

    def __init__(self, factory: pytest.TempPathFactory, environment: Mapping[str, str]) -> None:
        self._factory = factory
        self._environment = environment
        self._running: Cluster | None = None

    def whole(self) -> Cluster:
        """The cluster with all its workers; another one in place of one whose scheduler was killed."""
        if self._running is None or self._running.scheduler.poll() is not None:
            self.close()
            self._running = Cluster(self._factory.mktemp("cluster"), self._environment)
        self._running.replace_dead_workers(WORKERS)
        return self._running

    def close(self) -> None:
        """End it, if it runs."""
        if self._running is not None:
            self._running.close()


@pytest.fixture(scope="module")
def shared_cluster(tmp_path_factory: pytest.TempPathFactory, environment: Mapping[str, str]) -> Iterator[SharedCluster]:
    """The cluster of the tests here; the one that kills its scheduler is the last to use it."""
    shared = SharedCluster(tmp_path_factory, environment)
    yield shared
    shared.close()


@pytest.fixture
def cluster(shared_cluster: SharedCluster) -> Cluster:
    """The shared cluster, whole."""
    return shared_cluster.whole()


def _committed(database: str) -> int:
    """How many chunks are committed."""
    with reading(database) as engine, engine.connect() as connection:
        return len(connection.scalars(select(chunk.c.orientation)).all())


def _check_whole(database: str, expected_content: str) -> None:
    """There is one library, the expected one, with each chunk and each pose once."""
    with reading(database) as engine, engine.connect() as connection:
        assert [library.content_sha256 for library in published_libraries(connection)] == [expected_content]
        orientations = connection.scalars(select(chunk.c.orientation).order_by(chunk.c.orientation)).all()
        counts = [connection.scalar(select(func.count()).select_from(table)) for table in (state, undecided)]
    assert list(orientations) == list(range(GRID.orientation_count))
    assert sum(count or 0 for count in counts) == GRID.pose_count


def _chunk(index: int) -> LibraryChunk:
    """A chunk of the inputs, computed here."""
    grid, pair = INPUTS.grid, INPUTS.pair
    orientation = grid.orientation(index)
    states = solve_poses(pair, grid.poses(index), SHORT_TURNS)
    (history,) = histories_of(pair, [(orientation.roll_deg, orientation.pitch_deg)], SHORT_TURNS)
    first = grid.first_ordinal(index)
    rows = chunk_rows(orientation, first, states, statics_by_ordinal(pair, first, states))
    return LibraryChunk(rows, rows_of(history, pair, SHORT_TURNS))


def _wait_for(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + TIMEOUT_S
    while not condition():
        assert time.monotonic() < end, "in vain"
        time.sleep(0.03)


@pytest.mark.sqlite_alone
def test_a_killed_rebuild_goes_on_where_it_was_and_chunks_of_a_killed_worker_are_computed_by_others(
    command_line: CommandLine, cluster: Cluster, expected_content: str
) -> None:
    command_line.here("migrate")
    arguments = ("rebuild", *SMALL_GRID, "--scheduler", cluster.address, "--json")
    with command_line.start(*arguments) as killed:
        _wait_for(lambda: _committed(command_line.database) > 1)
        killed.kill()
        killed.communicate()
    kept = _committed(command_line.database)
    with command_line.start(*arguments) as process:
        _wait_for(lambda: _committed(command_line.database) > kept)
        cluster.workers[0].kill()
        out, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 0, err
    assert json.loads(out)["computed"] == GRID.pose_count - kept * GRID.phase_count
    _check_whole(command_line.database, expected_content)


@pytest.mark.sqlite_alone
def test_a_worker_whose_history_code_differs_is_refused_whenever_it_joins(
    command_line: CommandLine, environment: Mapping[str, str], tmp_path: Path, repository_root: Path
) -> None:
    folder, other = tmp_path / "cluster", tmp_path / "other"
    folder.mkdir()
    for room in ("threadstate", "worker"):
        shutil.copytree(repository_root / room, other / room)
    with (other / "threadstate/history/build.py").open("a") as source:
        source.write("# another version\n")
    with running_cluster(folder, environment, workers=0) as cluster:
        with command_line.start("rebuild", *SMALL_GRID, "--scheduler", cluster.address) as process:
            assert process.stderr is not None
            waiting = f"the Dask scheduler {cluster.address} has no worker yet; waiting for one\n"
            assert process.stderr.readline() == waiting
            cluster.add_worker(PYTHONPATH=str(other))
            _, late = process.communicate(timeout=TIMEOUT_S)
        cluster.add_worker()
        _wait_for(lambda: (folder / "log").read_text().count("Starting worker compute stream") == 2)
        code, _, early = command_line.here("rebuild", *SMALL_GRID, "--scheduler", cluster.address)
    assert (process.returncode, code) == (1, 1)
    for err in (late, early):
        assert "a Dask worker cannot compute the same bits: code " in err.splitlines()[-1]
    assert "(at tcp://127.0.0.1:" in early


@pytest.mark.sqlite_alone
def test_chunks_are_those_computed_here_and_no_more_are_asked_for_than_there_is_room_for(cluster: Cluster) -> None:
    taken = 0

    def orientations() -> Iterator[int]:
        nonlocal taken
        for index in range(GRID.orientation_count):
            taken += 1
            yield index

    with computing_cluster(INPUTS, cluster.address) as computing:
        received = {}
        for one in computing.chunks(orientations(), lambda: None):
            received[orientation_of(one)] = one
            assert taken - len(received) < QUEUED_PER_PROCESS * WORKERS
    assert received == {index: _chunk(index) for index in range(GRID.orientation_count)}


@pytest.mark.postgresql_alone
def test_a_job_is_computed_by_a_cluster_that_loses_a_worker(
    databases: Databases,
    cluster: Cluster,
    environment: Mapping[str, str],
    capsys: pytest.CaptureFixture[str],
    content_with_short_turns: str,
) -> None:
    with databases.lent() as database, writing(database) as engine:
        asked = submit_job(engine, INPUTS)
        commands = CommandLine(database, {**environment, LEASE_S: "2", SCHEDULER: cluster.address}, capsys)
        with commands.start("worker", "--until-idle") as process:
            _wait_for(lambda: _committed(database) > 0)
            cluster.workers[1].kill()
            _, err = process.communicate(timeout=TIMEOUT_S)
        assert process.returncode == 0, err
        with engine.connect() as connection:
            done = job_by_id(connection, asked.id)
            kinds = [event.kind for event in events_after(connection, asked.id, 0)]
        assert (done.state, done.done_count) == (JobState.DONE, GRID.orientation_count)
        # No failure of the job: it was queued once.
        assert [kinds.count(kind) for kind in (EventKind.QUEUED, EventKind.PUBLISHED)] == [1, 1]
        _check_whole(database, content_with_short_turns)


@pytest.mark.sqlite_alone
def test_a_success_map_is_the_same_from_the_cluster(
    command_line: CommandLine, cluster: Cluster, tmp_path: Path
) -> None:
    command = ("success", "--strategy", "cw", "--mu", "0", "--phases", "1", "--phase-tolerance", "360")
    options = ("--tilt-max", "4", "--tilt-step", "4", "--json")
    there, here = (
        json.loads(command_line.out(*command, *options, *where))
        for where in (("--scheduler", cluster.address, "--out", str(tmp_path / "there.map")), ("--workers", "1"))
    )
    assert there["computed"] == here["computed"] == 9
    assert there["content_sha256"] == here["content_sha256"]
    assert there["orientations"] == here["orientations"]


@pytest.mark.sqlite_alone
def test_a_library_of_settled_states_is_the_same_from_the_cluster(command_line: CommandLine, cluster: Cluster) -> None:
    command = ("rebuild-settled", "--tilt-max", "2", "--tilt-step", "1", "--phase-step", "120", "--json")
    there = json.loads(command_line.out(*command, "--scheduler", cluster.address))
    inputs = SettledInputs(quarter_twenty_unc(), Grid(2.0, 1.0, 120.0), default_device())
    rows = [computed_rows(inputs.pair, inputs.grid, inputs.device, i) for i in range(inputs.grid.orientation_count)]
    assert there["content_sha256"] == library_sha256([one.content_sha256 for one in rows])


@pytest.mark.sqlite_alone
def test_without_its_scheduler_a_rebuild_ends_and_what_is_committed_stays(
    command_line: CommandLine, cluster: Cluster, monkeypatch: pytest.MonkeyPatch, expected_content: str
) -> None:
    command_line.here("migrate")
    with command_line.start("rebuild", *SMALL_GRID, "--scheduler", cluster.address) as process:
        _wait_for(lambda: _committed(command_line.database) > 0)
        cluster.scheduler.kill()
        _, err = process.communicate(timeout=TIMEOUT_S)
    assert process.returncode == 1
    assert f"threadstate: the Dask scheduler {cluster.address} is gone" in err
    use_prepared_chunks(monkeypatch)
    assert command_line.here("rebuild", *SMALL_GRID)[0] == 0
    _check_whole(command_line.database, expected_content)


@pytest.mark.sqlite_alone
def test_a_worker_of_jobs_waits_for_its_scheduler(
    databases: Databases, environment: Mapping[str, str], capsys: pytest.CaptureFixture[str]
) -> None:
    with databases.lent() as database, writing(database) as engine:
        asked = submit_job(engine, INPUTS)
        commands = CommandLine(database, {**environment, SCHEDULER: "tcp://127.0.0.1:1"}, capsys)
        with commands.start("worker") as process:
            assert process.stderr is not None
            told = [process.stderr.readline() for _ in range(2)]
            process.terminate()
            process.communicate(timeout=TIMEOUT_S)
        assert told[1] == ("the cluster failed, retrying: no Dask scheduler answers at tcp://127.0.0.1:1\n")
        with engine.connect() as connection:
            waiting = job_by_id(connection, asked.id)
        assert (waiting.state, waiting.lease_count) == (JobState.RUNNING, 0)


@pytest.mark.sqlite_alone
@pytest.mark.parametrize("address", ["here:8786", "http://127.0.0.1:8786", "tcp://", "tcp://127.0.0.1:x"])
def test_what_is_no_schedulers_address_is_refused(command_line: CommandLine, address: str) -> None:
    code, _, err = command_line.here("rebuild", *SMALL_GRID, "--scheduler", address)
    assert code == 2
    assert f"scheduler is {address!r}; valid: the address of a Dask scheduler" in err


@pytest.mark.sqlite_alone
def test_processes_and_a_scheduler_exclude_each_other(command_line: CommandLine) -> None:
    code, _, err = command_line.here("rebuild", "--workers", "2", "--scheduler", "tcp://127.0.0.1:8786")
    assert code == 2
    assert "--workers is 2; valid:" in err


@pytest.mark.sqlite_alone
def test_without_the_extra_it_is_said_what_to_install(command_line: CommandLine) -> None:
    script = (
        "import sys; sys.modules['distributed'] = None; from worker.cli import run_command_line; "
        f"sys.exit(run_command_line(['rebuild', '--database', {command_line.database!r}, "
        "'--scheduler', 'tcp://127.0.0.1:8786']))"
    )
    done = subprocess.run([sys.executable, "-c", script], env=os.environ, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "pip install '.[dask]'" in done.stderr.splitlines()[-1]


def test_dask_is_loaded_only_when_asked_for() -> None:
    script = (
        "import worker.cli, worker.rebuild, worker.jobs.serve, sys; "
        "print([name for name in ('dask', 'distributed') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
