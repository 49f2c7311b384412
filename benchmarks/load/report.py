"""What a load test found, as a table, and whether it is what the service promises."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from pathlib import Path

from benchmarks.load.wrk import CONNECTIONS, LoadResult

LEAST_DISTURBED = 0.5
"""What is to be left of a rate while a library is computed on the same cores."""


@dataclass(frozen=True)
class Case:
    """A kind of request, the measured results, and what is promised: None where nothing is.

    ``times_datasette`` is how often the rate of Datasette at the same request it has to be.
    """

    name: str
    alone: LoadResult
    disturbed: LoadResult | None = None
    datasette: LoadResult | None = None
    least_rate: float | None = None
    most_p99_ms: float | None = None
    times_datasette: float | None = None

    @property
    def broken(self) -> list[str]:
        """The promises that are not met."""
        found = []
        if self.least_rate is not None and self.alone.rate < self.least_rate:
            found.append(f"{self.name}: {self.alone.rate:.0f}/s instead of {self.least_rate:.0f}/s")
        if self.most_p99_ms is not None and self.alone.p99_ms > self.most_p99_ms:
            found.append(f"{self.name}: p99 {self.alone.p99_ms:.0f} ms instead of {self.most_p99_ms:.0f} ms")
        if self.least_rate is not None and self.disturbed is not None:
            least = LEAST_DISTURBED * self.least_rate
            if self.disturbed.rate < least:
                found.append(f"{self.name}, during a rebuild: {self.disturbed.rate:.0f}/s instead of {least:.0f}/s")
        if self.times_datasette is not None and self.datasette is not None:
            times = self.alone.rate / self.datasette.rate
            if times < self.times_datasette:
                found.append(f"{self.name}: {times:.1f} times Datasette's rate instead of {self.times_datasette:g}")
        return found


def table(cases: list[Case]) -> str:
    """The cases as a table in Markdown."""
    lines = [
        "| request | kB | responses/s | p50 | p99 | promised | during a rebuild | p99 | Datasette | times |",
        "|---|--:|--:|--:|--:|---|--:|--:|--:|--:|",
    ]
    return "\n".join([*lines, *(_row(case) for case in cases)]) + "\n"


def document(cases: list[Case], seconds: float) -> str:
    """``docs/load.md``."""
    broken = [line for case in cases for line in case.broken]
    outcome = "Every promise was met in this run." if not broken else "Not met in this run:\n\n" + _items(broken)
    return _DOCUMENT.format(
        machine=f"{_processor()}, {len(os.sched_getaffinity(0))} cores, {platform.system()} {platform.release()}, "
        f"Python {platform.python_version()}",
        load=f"{os.getloadavg()[0]:.1f}",
        connections=CONNECTIONS,
        seconds=f"{seconds:g}",
        table=table(cases),
        outcome=outcome,
    )


_DOCUMENT = """# The service under load

Written by `make load`, which needs `wrk` (`apt-get install wrk`) and a few minutes. One process of the service, on its
defaults but for what is said below, over the library of 29,160 states in SQLite; wrk with one thread and {connections}
connections on the same cores, {seconds} s for each number. A response that is not 200 (304 for a conditional request)
fails the run.

Machine: {machine}. Load average at the end of the run: {load}; what else ran took its share.

{table}
Times are milliseconds to the whole response as wrk measures them. kB are those of a response on the wire.

- **pose**: random ones of all 29,160, each read and serialised every time ([decision 20](decisions/0020-one-read.md)):
poses
  are not cached.
- **history**: random ones of all 81 with `THREADSTATE_CACHE_MB=0`, each read from the JSON that is stored with its
  orientation, and hashed every time. **From the rows**: the same in millimetres, which is assembled from 3,000 rows.
- **cached**: requested before, with the default cache. The rate of whole histories is bounded by their bytes.
- **304**: the client sends the ETag that it has.
- **during a rebuild**: `threadstate rebuild` computes a finer library into the same database meanwhile, with as many
  processes as there are cores and at the same priority.
- **Datasette** serves the very same file, without other load, and gets the same by one SQL statement: a state,
  its poses, contacts and flags; or these of all phases of an orientation.

{outcome}
"""


def _items(lines: list[str]) -> str:
    return "\n".join(f"- {line}" for line in lines)


def _row(case: Case) -> str:
    alone, disturbed, other = case.alone, case.disturbed, case.datasette
    promised = [] if case.least_rate is None else [f"{case.least_rate:,.0f}/s"]
    promised += [] if case.most_p99_ms is None else [f"p99 {case.most_p99_ms:g} ms"]
    promised += [] if case.times_datasette is None else [f"{case.times_datasette:g} times"]
    cells = (
        case.name,
        f"{alone.kilobytes:.1f}",
        f"{alone.rate:,.0f}",
        f"{alone.p50_ms:.1f}",
        f"{alone.p99_ms:.1f}",
        ", ".join(promised),
        "" if disturbed is None else f"{disturbed.rate:,.0f}",
        "" if disturbed is None else f"{disturbed.p99_ms:.1f}",
        "" if other is None else f"{other.rate:,.1f}",
        "" if other is None else f"{alone.rate / other.rate:.0f}",
    )
    return f"| {' | '.join(cells)} |"


def _processor() -> str:
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.partition(":")[2].strip()
    return platform.machine()
