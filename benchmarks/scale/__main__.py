"""Measures what large libraries cost, and puts the figures into docs/scale.md: ``make scale``."""

from __future__ import annotations

import json
import os
import statistics
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import asdict
from pathlib import Path

import pyarrow
import pyarrow.parquet
from sqlalchemy import Engine, select

from benchmarks.scale.computing import GRIDS, committed, computed
from benchmarks.scale.figures import Copied, Figures
from benchmarks.scale.growing import grown, rooms
from benchmarks.scale.page import write_page
from benchmarks.scale.processor import Stopwatch
from harness.postgresql_server import running_server
from threadstate.library.copying import copy_library
from threadstate.library.engine import reading, writing
from threadstate.library.read import LibraryRecord, latest_library
from threadstate.responses.library_network import library_network
from threadstate.settings import read_settings
from threadstate.tables import metadata
from threadstate.warm_up import load_kernels
from worker.migrate import migrate

FLUSHES = 50
JSON = Path("docs/scale.json")


def main() -> None:
    """Measure, report progress and write."""
    load_kernels()
    with reading(read_settings().database) as source, tempfile.TemporaryDirectory() as folder:
        figures = measured(source, Path(folder))
    JSON.write_text(json.dumps(asdict(figures), indent=1) + "\n")
    write_page(figures)
    report(f"{JSON} and the tables of docs/scale.md are written")


def measured(source: Engine, folder: Path) -> Figures:
    """All figures; ``source`` has the latest library as the one that databases grow by."""
    with source.connect() as connection:
        record = latest_library(connection)
        began = time.process_time()
        made = library_network(connection, record)
        _ = made.network, made.transitions
        network_s = time.process_time() - began
        parquet = _parquet_bytes(source, record, folder) / record.state_count
    chunks = []
    for grid in GRIDS:
        report(f"computing: {grid.tilt_step_deg:g}, {grid.phase_step_deg:g} deg")
        chunks.append(computed(grid))
    commits, growth, sizes, copies = [], [], [], []
    with _databases(folder) as databases:
        for name, own, others in databases:
            report(f"{name}: committing")
            commits += [committed(others, name, grid, made) for grid, (_, made) in zip(GRIDS, chunks, strict=True)]
            report(f"{name}: copying")
            stopwatch = Stopwatch.on(own)
            copy_library(source, own, record.id)
            copies.append(Copied(name, record.state_count, stopwatch.seconds))
            report(f"{name}: growing")
            growth += list(grown(own, name))
            sizes += rooms(own, name)
    return Figures([one for one, _ in chunks], commits, growth, sizes, copies, parquet, _flush_ms(folder), network_s)


@contextmanager
def _databases(folder: Path) -> Iterator[list[tuple[str, Engine, Engine]]]:
    """Of each kind a database that grows and one for chunks, both migrated."""
    with ExitStack() as stack:
        server = stack.enter_context(running_server())
        urls = []
        for name in ("growing", "chunks"):
            server.execute(f"CREATE DATABASE {name} TEMPLATE template0")
            urls.append((f"sqlite:///{folder / name}.sqlite3", server.url(name)))
        (sqlite, postgresql), (sqlite_chunks, postgresql_chunks) = urls
        engines = [stack.enter_context(writing(url)) for url in (sqlite, sqlite_chunks, postgresql, postgresql_chunks)]
        for engine in engines:
            migrate(engine)
        yield [("SQLite", engines[0], engines[1]), ("PostgreSQL", engines[2], engines[3])]


def _parquet_bytes(source: Engine, record: LibraryRecord, folder: Path) -> int:
    """All rows of a library, a file a table."""
    total = 0
    with source.connect() as connection:
        for table in metadata.sorted_tables:
            if "library_id" in table.c:
                rows = connection.execute(select(table).where(table.c.library_id == record.id)).mappings().all()
                path = folder / f"{table.name}.parquet"
                columns = {column.name: [row[column.name] for row in rows] for column in table.c}
                pyarrow.parquet.write_table(pyarrow.table(columns), path, compression="zstd")
                total += path.stat().st_size
    return total


def _flush_ms(folder: Path) -> float:
    times = []
    with (folder / "flushed").open("wb", buffering=0) as file:
        for _ in range(FLUSHES):
            file.write(b"x" * 4096)
            began = time.perf_counter()
            os.fsync(file.fileno())
            times.append(time.perf_counter() - began)
    return 1e3 * statistics.median(times)


def report(line: str) -> None:
    """A line for whoever is watching."""
    sys.stderr.write(f"{line}\n")


if __name__ == "__main__":
    main()
