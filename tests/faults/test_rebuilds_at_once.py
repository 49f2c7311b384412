"""Several rebuilds in one database at once, as processes: each library is whole, and is the one that it is alone."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Mapping

import pytest

from harness.databases import Databases
from tests.faults.conftest import Unwatched, published
from tests.worker.conftest import COMMAND
from threadstate.library.engine import writing
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.settings import DATABASE
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.rebuild import rebuild

PHASE_STEPS = (30, 45, 60)
EACH = 2


@pytest.fixture(scope="session")
def expected(sqlite_databases: Databases) -> dict[int, str]:
    """The content hash by phase step, of libraries computed one after another."""
    with writing(sqlite_databases.migrated()) as engine:
        return {
            step: rebuild(
                engine, LibraryInputs(quarter_twenty_unc(), Grid(6.0, 6.0, step), SolveOptions()), 1, Unwatched()
            ).content_sha256
            for step in PHASE_STEPS
        }


def test_same_and_different_libraries_at_once(
    databases: Databases, environment_of_commands: Mapping[str, str], expected: dict[int, str]
) -> None:
    with databases.lent() as database:
        grid = ("--tilt-max", "6", "--tilt-step", "6", "--workers", "1", "--json")
        rebuilds = [
            subprocess.Popen(
                [*COMMAND, "rebuild", *grid, "--phase-step", str(step)],
                env={**environment_of_commands, DATABASE: database},
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            for step in PHASE_STEPS
            for _ in range(EACH)
        ]
        ended = [(process.communicate(timeout=500), process.returncode) for process in rebuilds]
        assert [(code, err if code else "") for (_, err), code in ended] == [(0, "")] * len(rebuilds)
        said = [json.loads(out) for (out, _), _ in ended]
        assert [one["content_sha256"] for one in said] == [expected[step] for step in PHASE_STEPS for _ in range(EACH)]
        for step, (one, other) in zip(PHASE_STEPS, zip(said[::2], said[1::2], strict=True), strict=True):
            assert one["library"] == other["library"]
            assert one["computed"] + other["computed"] == 9 * 360 // step, "each pose is counted once"
        with writing(database) as engine:
            assert sorted(published(engine)) == sorted(expected.values())
