"""``make load``: how many requests a second the service handles, and Datasette over the same file."""

from __future__ import annotations

import argparse
import sys
import tempfile
import urllib.request
from pathlib import Path

from benchmarks.load.report import Case, document, table
from benchmarks.load.requests import (
    HISTORY,
    HISTORY_BY_DATASETTE,
    HISTORY_FROM_ROWS,
    INTERVALS,
    ONE_HISTORY,
    POSE,
    POSE_BY_DATASETTE,
    ZIPPED_HISTORY,
    not_modified,
)
from benchmarks.load.servers import (
    NOTHING_CACHED,
    datasette,
    prepare,
    rebuilding,
    threadstate_service,
    wait_until_prepared,
)
from benchmarks.load.wrk import LoadError, LoadResult, RequestPattern, load

SEED = 20060501
_Results = dict[str, LoadResult]


def main() -> int:
    """Measure, print, and write the document.

    Returns:
        0 if every promise was met.
    """
    parser = argparse.ArgumentParser(prog="python -m benchmarks.load", description=__doc__)
    parser.add_argument("--seconds", type=float, default=5.0, help="for each number [%(default)s]")
    parser.add_argument(
        "--datasette", type=Path, default=Path(".venv-load/bin/python"), help="Python that has it [%(default)s]"
    )
    parser.add_argument("--library", type=Path, help="a database that has the library [it is computed]")
    parser.add_argument("--write", type=Path, help="the document that is written [none]")
    arguments = parser.parse_args()
    try:
        with tempfile.TemporaryDirectory(prefix="threadstate-load-") as folder:
            cases = _measured(Path(folder), arguments)
    except LoadError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    sys.stdout.write(table(cases))
    broken = [line for case in cases for line in case.broken]
    sys.stdout.writelines(f"not met: {line}\n" for line in broken)
    if arguments.write is not None:
        arguments.write.write_text(document(cases, arguments.seconds))
    return 1 if broken else 0


def _measured(folder: Path, arguments: argparse.Namespace) -> list[Case]:
    seconds = arguments.seconds
    database = prepare(folder, arguments.library)
    with datasette(arguments.datasette, database) as address:
        by_datasette = _measured_patterns(
            address, {"pose": POSE_BY_DATASETTE, "history": HISTORY_BY_DATASETTE}, seconds
        )
    alone = _of_service(folder, database, seconds)
    with rebuilding(database):
        disturbed = _of_service(folder, database, seconds)

    def case(
        name: str, of: str, least_rate: float | None, most_p99_ms: float | None = None, times: float | None = None
    ) -> Case:
        return Case(name, alone[of], disturbed[of], by_datasette.get(of), least_rate, most_p99_ms, times)

    return [
        case("pose", "pose", 3000.0, 15.0, 5.0),
        case("history", "history", 300.0, 150.0, 5.0),
        case("history, from the rows", "rows", None),
        case("intervals", "intervals", None),
        case("history, cached", "cached", None),
        case("history, cached, gzip", "zipped", None),
        case("intervals, cached", "cached intervals", None),
        case("history, 304", "unchanged", 6000.0),
    ]


def _of_service(folder: Path, database: str, seconds: float) -> _Results:
    with threadstate_service(folder, database, NOTHING_CACHED) as address:
        wait_until_prepared(address)
        patterns = {"pose": POSE, "history": HISTORY, "rows": HISTORY_FROM_ROWS, "intervals": INTERVALS}
        found = _measured_patterns(address, patterns, seconds)
    with threadstate_service(folder, database, {}) as address:
        wait_until_prepared(address)
        unchanged = not_modified(_fetch(address + ONE_HISTORY))
        patterns = {"cached": HISTORY, "zipped": ZIPPED_HISTORY, "cached intervals": INTERVALS}
        for pattern in patterns.values():
            load(address, pattern, seconds, SEED)
        return {**found, **_measured_patterns(address, {**patterns, "unchanged": unchanged}, seconds)}


def _measured_patterns(address: str, patterns: dict[str, RequestPattern], seconds: float) -> _Results:
    return {name: load(address, pattern, seconds, SEED) for name, pattern in patterns.items()}


def _fetch(address: str) -> str:
    """Send one request; the ETag of the response."""
    with urllib.request.urlopen(address, timeout=60.0) as answer:
        return str(answer.headers["ETag"])


if __name__ == "__main__":
    sys.exit(main())
