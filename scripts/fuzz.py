"""Asks the service whatever its description allows and forbids, 10,000 times and more: ``make fuzz``.

The service is the real one, in this process, over small libraries that are computed first. What was asked of each
operation is counted; what was answered otherwise than described is printed, and ends the script with 1.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

from harness.databases import SqliteDatabases
from scripts.described import GRID, Tally, fuzz
from service.app import create_app
from threadstate.access.keys import create_key
from threadstate.access.scope import Scope
from threadstate.device.model import default_device
from threadstate.library.engine import writing
from threadstate.library.identity import LibraryInputs
from threadstate.settings import DATABASE, read_settings
from threadstate.settled.inputs import SettledInputs
from threadstate.state.options import SolveOptions
from threadstate.thread.catalogue import quarter_twenty_unc
from worker.rebuild import rebuild
from worker.settled.rebuild import rebuild_settled

LEAST_CASES = 10_000
EXAMPLES = 600
"""Random cases of an operation; those that the description lays out come on top of them."""
WORKERS = 2
MOST_SHOWN = 20


class _Unwatched:
    def begin(self, committed: int, total: int) -> None: ...

    def ready(self) -> None: ...

    def advance(self, poses: int) -> None: ...


def run(folder: Path, examples: int, seed: int) -> Tally:
    """Compute the small libraries in that folder and ask a service over them."""
    database = SqliteDatabases(folder).migrated()
    with writing(database) as engine:
        rebuild(engine, LibraryInputs(quarter_twenty_unc(), GRID, SolveOptions()), WORKERS, _Unwatched())
        rebuild_settled(engine, SettledInputs(quarter_twenty_unc(), GRID, default_device()), WORKERS, _Unwatched())
        key = create_key(engine, "fuzz", Scope.WRITE)
    app = create_app(read_settings({DATABASE: database}))
    return fuzz(app, key, examples=examples, seed=seed, told=_tell)


def _tell(part: str, tally: Tally) -> None:
    sys.stderr.write(f"{part}: over after {tally.total} cases, {len(tally.wrong)} of them wrong\n")
    sys.stderr.flush()


def main() -> None:
    """Ask, count, and say what was wrong."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=LEAST_CASES, help="fewer than so many is a failure")
    parser.add_argument("--examples", type=int, default=EXAMPLES, help="random cases of an operation")
    parser.add_argument("--seed", type=int, default=20060128)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        tally = run(Path(folder), arguments.examples, arguments.seed)
    lines = [
        f"{count:6}  {tally.seconds[operation]:6.1f} s  {operation}" for operation, count in sorted(tally.cases.items())
    ]
    statuses = ", ".join(f"{count} of {status}" for status, count in sorted(tally.statuses.items()))
    lines.append(f"{tally.total:6}  cases: {statuses}")
    if tally.total < arguments.cases:
        tally.wrong.append(f"{tally.total} cases are fewer than {arguments.cases}")
    lines += tally.wrong[:MOST_SHOWN]
    lines.append(f"{len(tally.wrong)} answers otherwise than described" if tally.wrong else "every answer as described")
    sys.stdout.write("\n".join(lines) + "\n")
    sys.exit(1 if tally.wrong else 0)


if __name__ == "__main__":
    main()
