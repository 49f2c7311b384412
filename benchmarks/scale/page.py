"""The tables of docs/scale.md."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path

from benchmarks.scale.figures import Committed, Computed, Figures
from benchmarks.scale.plan import (
    CORE_HOUR_USD,
    DISK_GB_MONTH_USD,
    OBJECTS_GB_MONTH_USD,
    SECONDS_AN_HOUR,
    bytes_of,
    steps,
)

PAGE = Path("docs/scale.md")
PREFIXES = ("", "k", "M", "G", "T", "P")


def write_page(figures: Figures, page: Path = PAGE) -> None:
    """Put the tables of a run into the page, between their marks."""
    text = page.read_text()
    for name, tables in (("figures", _figures(figures)), ("plan", _plan(figures))):
        block = f"<!-- {name} -->\n{tables}\n<!-- /{name} -->"
        text = re.sub(rf"<!-- {name} -->.*<!-- /{name} -->", lambda _, block=block: block, text, flags=re.DOTALL)  # type: ignore[misc]
    page.write_text(text)


def _figures(figures: Figures) -> str:
    computed = _table(
        (
            "grid: tilt, phase",
            "poses",
            "states",
            "history",
            "poses/s a core",
            "rows",
            "intervals",
            "pickled",
        ),
        (
            (
                f"{one.tilt_step_deg:g}, {one.phase_step_deg:g} deg",
                f"{one.poses:,}",
                f"{one.answers_s:.3f} s",
                f"{one.history_s:.3f} s",
                f"{one.poses / one.seconds:,.0f}",
                f"{one.rows:,.0f}",
                f"{one.intervals:.1f}",
                short(one.pickled_bytes),
            )
            for one in figures.computed
        ),
    )
    committed = _table(
        ("database", "phase", "a chunk", "of it the server", "processes that one writer keeps up with"),
        (
            (
                one.database,
                f"{one.phase_step_deg:g} deg",
                f"{1e3 * one.seconds:.0f} ms",
                f"{1e3 * one.server_s:.0f} ms" if one.server_s else "-",
                f"{_of_step(figures, one).seconds / one.seconds:.0f}",
            )
            for one in figures.committed
        ),
    )
    grown = _table(
        (
            "database",
            "libraries",
            "states",
            "bytes",
            "bytes a state",
            "a pose",
            "100 by drop",
            "an orientation",
            "publishing one",
        ),
        (
            (
                one.database,
                str(one.libraries),
                f"{one.states:,}",
                short(one.bytes),
                f"{one.bytes / one.states:,.0f}",
                f"{one.pose_ms:.2f} ms",
                f"{one.page_ms:.2f} ms",
                f"{one.orientation_ms:.1f} ms",
                f"{one.publish_ms:.0f} ms",
            )
            for one in figures.grown
        ),
    )
    databases = list(dict.fromkeys(room.database for room in figures.rooms))
    largest = [one.table for one in figures.rooms if one.database == databases[0]]
    rooms = _table(
        ("table", "rows", *(f"{one}: table, indexes" for one in databases)),
        (
            (
                f"`{table}`",
                f"{next(one.rows_each for one in figures.rooms if one.table == table):.2f}",
                *(f"{one.table_bytes:,.0f} B, {one.index_bytes:,.0f} B" for one in figures.rooms if one.table == table),
            )
            for table in largest
            if table in ("state", "stage_pose", "contact", "state_flag") or table.startswith(("history", "clearance"))
        ),
    )
    copied = "; ".join(
        f"{one.states / one.seconds:,.0f} states/s from SQLite to {one.database}" for one in figures.copied
    )
    others = (
        f"Copying with its proof: {copied}.",
        f"All tables as Parquet (zstd): {figures.parquet_bytes_a_state:.0f} bytes a state.",
        f"A flush to the disk of this machine: {figures.flush_ms:.1f} ms.",
        f"The network of the library of 81 orientations, from its rows: {figures.network_s:.1f} s.",
    )
    return "\n\n".join((computed, committed, grown, rooms, "\n".join(others)))


def _of_step(figures: Figures, one: Committed) -> Computed:
    return next(found for found in figures.computed if found.phase_step_deg == one.phase_step_deg)


def _plan(figures: Figures) -> str:
    rows = []
    for step in steps(figures):
        sqlite, postgresql = (
            {kind: bytes_of(figures, database, step, histories=kind == "histories") for kind in ("states", "histories")}
            for database in ("SQLite", "PostgreSQL")
        )
        committed = next(
            one
            for one in figures.committed
            if one.database == "PostgreSQL" and one.phase_step_deg == step.of.phase_step_deg
        )
        whole = sum(postgresql.values())
        parquet = figures.parquet_bytes_a_state * step.states
        rows.append(
            (
                step.name,
                short(step.states, unit=""),
                short(step.rows, unit=""),
                short(sum(sqlite.values())),
                short(whole),
                short(parquet),
                short(postgresql["histories"]),
                hours(step.core_hours),
                hours(step.chunks * committed.seconds / SECONDS_AN_HOUR),
                dollars(step.core_hours * CORE_HOUR_USD),
                dollars(whole / 1e9 * DISK_GB_MONTH_USD),
                dollars(parquet / 1e9 * OBJECTS_GB_MONTH_USD),
            )
        )
    return _table(
        (
            "step",
            "states",
            "rows",
            "SQLite",
            "PostgreSQL",
            "Parquet",
            "histories alone",
            "core time",
            "one writer's time",
            "computing",
            "disk a month",
            "objects a month",
        ),
        rows,
    )


def short(count: float, unit: str = "B") -> str:
    """A number with a decimal prefix."""
    prefixes = iter(PREFIXES)
    prefix = next(prefixes)
    while count >= 999.5:
        count, prefix = count / 1000.0, next(prefixes)
    return f"{count:.3g} {prefix}{unit}".strip()


def hours(count: float) -> str:
    """Hours, in what reads best."""
    if count < 1.0:
        return f"{60.0 * count:.1f} min"
    return f"{count:,.1f} h" if count < 100.0 else f"{count:,.0f} h"


def dollars(count: float) -> str:
    """An amount, to two digits."""
    return f"${float(f'{count:.2g}'):,.0f}" if count >= 1.0 else "<$1"


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
