from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from types import TracebackType

import pytest

from harness.databases import Databases
from tests.stored_histories.history_library import content_of
from threadstate.library.grid import Grid
from threadstate.settings import DATABASE
from threadstate.state.options import SolveOptions
from worker.cli import run_command_line

COMMAND = [sys.executable, "-c", "from worker.cli import main; main()"]
"""The command line as its console script starts it."""

GRID = Grid(tilt_max_deg=3.0, tilt_step_deg=3.0, phase_step_deg=15.0)
"""9 orientations of 24 phases, the tilts of all small libraries: their histories are computed once in a run."""
SMALL_GRID = ["--tilt-max", "3", "--tilt-step", "3", "--phase-step", "15"]
"""The same on the command line."""
SHORT_TURNS = SolveOptions(turn_limit_deg=3.0)
"""With these the histories of the grid take a third of the time: for tests of who computes, and not of what."""
ONE_ORIENTATION = ["--tilt-max", "0", "--phase-step", "15"]
"""The level one, in 24 phases."""


class CommandProcess(subprocess.Popen[str]):
    """A command's process. Where a test fails before it has ended it is killed, even if it is stopped."""

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self.kill()
        super().__exit__(kind, error, trace)


class CommandLine:
    """Runs commands on a database of the test's own, in this process or in one of their own."""

    def __init__(self, database: str, environment: Mapping[str, str], capsys: pytest.CaptureFixture[str]) -> None:
        self.database = database
        self._environment = {**environment, DATABASE: database}
        self._capsys = capsys

    def here(self, *arguments: str) -> tuple[int, str, str]:
        """Exit code, stdout and stderr of a command run in this process."""
        self._capsys.readouterr()
        code = run_command_line(list(arguments))
        out, err = self._capsys.readouterr()
        return code, out, err

    def start(self, *arguments: str) -> CommandProcess:
        """A command in a process, and a process group, of its own."""
        return CommandProcess(
            [*COMMAND, *arguments],
            env=self._environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            # A shell's background job inherits that SIGINT is ignored, and so would its children.
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )

    def out(self, *arguments: str) -> str:
        """What a command that succeeds, in this process, prints."""
        code, out, err = self.here(*arguments)
        assert code == 0, err
        return out


@pytest.fixture(scope="session")
def expected_content() -> str:
    """The content hash of the small library, computed without any database or process of its own."""
    return content_of(GRID)


@pytest.fixture(scope="session")
def content_with_short_turns() -> str:
    """The content hash of the small library whose turns end early, computed likewise."""
    return content_of(GRID, SHORT_TURNS)


@pytest.fixture(scope="session")
def environment() -> Mapping[str, str]:
    """The environment of commands; this source tree goes before anything installed."""
    return {**os.environ, "PYTHONPATH": str(Path(__file__).parent.parent.parent)}


@pytest.fixture
def command_line_on(environment: Mapping[str, str], capsys: pytest.CaptureFixture[str]) -> Callable[[str], CommandLine]:
    """Makes command lines on databases by their URLs."""
    return lambda database: CommandLine(database, environment, capsys)


@pytest.fixture
def command_line(
    command_line_on: Callable[[str], CommandLine], databases: Databases, monkeypatch: pytest.MonkeyPatch
) -> CommandLine:
    """A command line on a database without a schema."""
    command_line = command_line_on(databases.new())
    monkeypatch.setenv(DATABASE, command_line.database)
    return command_line
