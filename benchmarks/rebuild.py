"""The wall time of ``threadstate rebuild``, and its profile."""

from __future__ import annotations

import json
import os
import pickle
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import numpy as np

from benchmarks.sample import SEED
from threadstate.contact import _solve_kernel
from threadstate.history.build import histories_of
from threadstate.history.descents import falls_of
from threadstate.history.height_curve import height_curve
from threadstate.history.records import RecordStore
from threadstate.history.window import windows_of
from threadstate.library.engine import writer_engine
from threadstate.library.fingerprint import answers_sha256
from threadstate.library.grid import Grid
from threadstate.library.identity import LibraryInputs
from threadstate.library.rows import chunk_rows
from threadstate.library.write import open_library, write_chunk
from threadstate.state.solve import SolveOptions
from threadstate.statics.rows import statics_by_ordinal
from threadstate.stored_histories.compute import computed_rows, exact_answers
from threadstate.stored_histories.rows import history_rows
from threadstate.thread.pair import Pair
from worker.garbage import collect_rarely
from worker.messages import LibraryChunk
from worker.migrate import migrate

PROFILED_ORIENTATIONS = 12
COMMAND = [sys.executable, "-c", "from worker.cli import main; main()"]
WRITER_IMPORTS = "import worker.cli, worker.rebuild"
COMPUTING_IMPORTS = "import threadstate.warm_up, worker.compute"
WARM_UP = [sys.executable, "-m", "threadstate.warm_up"]
STATES_KERNELS = "solve: kernels"
LOADING = f"{COMPUTING_IMPORTS}; threadstate.warm_up.load_kernels()"


class RebuildFailedError(Exception):
    """``threadstate rebuild`` ended with an error, which this is."""


@dataclass(frozen=True)
class Rebuilt:
    """A library made from nothing: wall time from the start of the command to its end, published; size of the file."""

    processes: int
    states: int
    seconds: float
    database_bytes: int

    def path(self, folder: Path) -> Path:
        """The database in the folder that the library was made in."""
        return _database(folder, self.processes)


@dataclass(frozen=True)
class Part:
    """A part of the work of a rebuild, with the time that it takes one core for the whole library."""

    name: str
    where: str
    seconds: float


@dataclass(frozen=True)
class Floor:
    """What no change of this code's order or packing could go below, in seconds.

    ``kernels`` is the kernels' own time spread evenly over all cores, ``disk`` a plain write of as many bytes as the
    database has, with one wait for the disk.
    """

    kernels: float
    disk: float


def rebuilt(folder: Path, grid: Grid, processes: int) -> Rebuilt:
    """Run the command on a fresh database in ``folder``.

    Raises:
        RebuildFailedError: it failed.
    """
    path = _database(folder, processes)
    arguments = ["rebuild", "--database", f"sqlite:///{path}", "--workers", str(processes), "--json"]
    for option, value in (
        ("--tilt-max", grid.tilt_max_deg),
        ("--tilt-step", grid.tilt_step_deg),
        ("--phase-step", grid.phase_step_deg),
    ):
        arguments += [option, str(value)]
    start = time.perf_counter()
    run = subprocess.run([*COMMAND, *arguments], capture_output=True, text=True, check=False)
    seconds = time.perf_counter() - start
    if run.returncode != 0:
        raise RebuildFailedError(run.stderr.strip().splitlines()[-1])
    return Rebuilt(processes, int(json.loads(run.stdout)["states"]), seconds, path.stat().st_size)


def profile(folder: Path, pair: Pair, grid: Grid) -> list[Part]:
    """Each part by itself on one core, over orientations chosen by a seed and scaled to the whole grid."""
    collect_rarely()  # as the processes of a rebuild do
    count = min(PROFILED_ORIENTATIONS, grid.orientation_count)
    chosen = np.random.default_rng(SEED).choice(grid.orientation_count, count, replace=False).tolist()
    scale = grid.orientation_count / count
    engine = writer_engine(f"sqlite:///{folder / 'profiled.sqlite3'}")
    migrate(engine)
    inputs = LibraryInputs(pair, grid, SolveOptions())
    library_id = open_library(engine, inputs)
    computed_rows(inputs, chosen[0])
    kernels = _Stopwatch()
    of_states, of_histories = 0.0, 0.0
    solve, histories, statics, rows, hashing, handing, writing = (_Stopwatch() for _ in range(7))
    with mock.patch.object(_solve_kernel, "solve_rows", kernels.around(_solve_kernel.solve_rows)):
        for index in chosen:
            orientation, first = grid.orientation(index), grid.first_ordinal(index)
            tilt = (orientation.roll_deg, orientation.pitch_deg)
            store = RecordStore(pair, inputs.options)
            before = kernels.seconds
            with solve.running():
                answers = exact_answers(pair, inputs.options, grid.poses(index), store)
            between = kernels.seconds
            with histories.running():
                (history,) = histories_of(pair, [tilt], inputs.options, store=store)
                falls = falls_of(height_curve(pair, *tilt, inputs.options, store), pair.thread_pitch)
                windows = windows_of(pair, history)
            of_states += between - before
            of_histories += kernels.seconds - between
            with statics.running():
                loaded = statics_by_ordinal(pair, first, answers, store.records(np.array(grid.poses(index))))
            with hashing.running():
                answers_sha256(answers)
            with rows.running():
                of_chunk = chunk_rows(orientation, first, answers, loaded)
                chunk = LibraryChunk(of_chunk, history_rows(history, windows, falls))
            with handing.running():
                pickle.loads(pickle.dumps(chunk))
            with writing.running():
                write_chunk(engine, library_id, chunk.rows, chunk.history)
    engine.dispose()
    imports = _process_seconds(COMPUTING_IMPORTS)
    return [
        Part("start of Python, imports: writer", "writer", _process_seconds(WRITER_IMPORTS)),
        Part("start of Python, imports: kernels", "forkserver", imports),
        Part("loading the kernels", "forkserver", _process_seconds(LOADING) - imports),
        Part(STATES_KERNELS, "computing", of_states * scale),
        Part("solve: records to values", "computing", (solve.seconds - of_states) * scale),
        Part("histories: kernels that solve", "computing", of_histories * scale),
        Part("histories: search of changes, falls, windows", "computing", (histories.seconds - of_histories) * scale),
        Part("statics", "computing", statics.seconds * scale),
        Part("hashing", "computing", hashing.seconds * scale),
        Part("rows", "computing", (rows.seconds - hashing.seconds) * scale),
        Part("handing over", "both", handing.seconds * scale),
        Part("writing", "writer", writing.seconds * scale),
    ]


def compile_seconds(folder: Path) -> float:
    """Wall time of compiling all that the service and a rebuild need into an empty cache."""
    environment = os.environ | {"THREADSTATE_NUMBA_CACHE_DIR": str(folder / "cache")}
    start = time.perf_counter()
    subprocess.run([*WARM_UP, "--serving"], check=True, capture_output=True, env=environment)
    return time.perf_counter() - start


def floor(folder: Path, parts: list[Part], cores: int, database_bytes: int) -> Floor:
    """The floor of a rebuild whose parts and size were measured."""
    content = os.urandom(database_bytes)
    start = time.perf_counter()
    with (folder / "plain").open("wb") as file:
        file.write(content)
        os.fsync(file.fileno())
    disk = time.perf_counter() - start
    return Floor(sum(part.seconds for part in parts if part.name == STATES_KERNELS) / cores, disk)


def _database(folder: Path, processes: int) -> Path:
    return folder / f"rebuilt_by_{processes}.sqlite3"


class _Stopwatch:
    def __init__(self) -> None:
        self.seconds = 0.0

    @contextmanager
    def running(self) -> Iterator[None]:
        start = time.perf_counter()
        yield
        self.seconds += time.perf_counter() - start

    def around(self, kernel: Callable[..., None]) -> Callable[..., None]:
        """The kernel, timed."""

        def timed(*arguments: object) -> None:
            with self.running():
                kernel(*arguments)

        return timed


def _process_seconds(code: str) -> float:
    """Wall time of a Python process that runs ``code``: the second of two, so that files are in memory."""
    seconds = 0.0
    for _ in range(2):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
        seconds = time.perf_counter() - start
    return seconds
