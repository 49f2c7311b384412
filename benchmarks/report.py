"""What a run of the benchmarks found, as tables for people and as one object for machines."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass

from rich.console import Console
from rich.table import Table

from benchmarks.rebuild import Floor, Part, Rebuilt
from benchmarks.request_times import RequestTimes
from benchmarks.rivalry import Rival
from benchmarks.work import Work

WIDTH_OF_A_FILE = 150


@dataclass(frozen=True)
class Pace:
    """All three exact contacts of ``poses`` poses, in that many processes."""

    processes: int
    poses: int
    seconds: float

    @property
    def poses_per_second(self) -> float:
        """The rate."""
        return self.poses / self.seconds


@dataclass(frozen=True)
class Report:
    """One run.

    ``declined`` is how many poses of the sample the exact solver would not decide; they are left out everywhere.
    ``compared_poses_per_second`` is its pace on one core on just the poses that the meshes descend to, and
    ``first_contacts_per_second`` that of their first contacts alone, which is what meshes find. ``orientations`` is how
    many the library has, each with its history; ``compile_seconds`` is None where it was not asked for.
    """

    sampled: int
    declined: int
    paces: list[Pace]
    work: Work
    compared: int
    compared_poses_per_second: float
    first_contacts_per_second: float
    rivals: list[Rival]
    rebuilds: list[Rebuilt]
    parts: list[Part]
    floor: Floor
    requests: list[RequestTimes]
    orientations: int
    compile_seconds: float | None

    @property
    def histories_per_second(self) -> float:
        """Histories of orientations whose states are solved, on one core."""
        return self.orientations / sum(part.seconds for part in self.parts if part.name.startswith("histories"))


def as_json(report: Report) -> str:
    """The report as one line of JSON; rates in poses/s, times in s, heights in inches, angles in degrees."""
    return json.dumps(asdict(report))


def print_tables(report: Report) -> None:
    """The report as tables on stdout."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDTH_OF_A_FILE)
    for table in (_paces(report), _rivals(report), _rebuilds(report), _parts(report), _requests(report)):
        # Apart from its table: a title is broken to the table's width.
        console.print(table.title, style="bold")
        table.title = None
        console.print(table)
        console.print()
    console.print(_work(report.work))
    states = sum(part.seconds for part in report.parts if part.name.startswith("solve"))
    console.print(
        f"Histories: {report.histories_per_second:.2f}/s on one core, beyond the states of the library, in "
        f"{report.orientations / report.histories_per_second / states:.1f} times the time of these."
    )
    if report.compile_seconds is not None:
        console.print(f"Compilation of what the service needs: {report.compile_seconds:.1f} s.")
    console.print(
        f"Floor of a rebuild: the kernels alone on {report.rebuilds[-1].processes} cores {report.floor.kernels:.2f} s; "
        f"{report.rebuilds[-1].database_bytes / 1e6:.0f} MB written plainly to this disk {report.floor.disk:.2f} s."
    )


def _paces(report: Report) -> Table:
    declined = f"; {report.declined} more are declined" if report.declined else ""
    table = _table(f"Exact: all three contacts of {report.paces[0].poses} poses{declined}", "cores", "poses/s", "s")
    for pace in report.paces:
        table.add_row(str(pace.processes), f"{pace.poses_per_second:,.0f}", f"{pace.seconds:.2f}")
    return table


def _work(work: Work) -> str:
    return (
        f"Boxes a pose: {work.boxes:.0f} of {work.poses} tilted ones, {work.boxes_without_third:.0f} of the "
        f"{work.without_third} without a third contact. A pose takes {work.solving_us:.0f} us, to verify its contacts "
        f"where they are known {work.following_us:.1f} us: {work.times_the_floor:.0f} times this floor."
    )


def _rivals(report: Report) -> Table:
    table = _table(
        f"First contact alone by meshes of 60,000 triangles a part to 1e-6 in: {report.compared} poses, one core",
        "method",
        "poses/s",
        "all three faster by",
        "first by",
        "|mesh - exact| median (in)",
        "largest (in)",
        "at roll, pitch, phase",
        "tunnelled",
    )
    for name, pace in (
        ("exact, all three contacts", report.compared_poses_per_second),
        ("exact, first contact", report.first_contacts_per_second),
    ):
        table.add_row(name, f"{pace:,.0f}", *[""] * 6)
    for rival in report.rivals:
        table.add_row(
            rival.name,
            f"{rival.poses_per_second:,.0f}",
            f"{rival.ratio:.1f} x",
            f"{report.first_contacts_per_second / rival.poses_per_second:.0f} x",
            f"{rival.median_difference:.1e}",
            f"{rival.largest_difference:+.1e}",
            ", ".join(f"{angle:.2f}" for angle in rival.worst_pose),
            str(rival.tunnelled),
        )
    return table


def _rebuilds(report: Report) -> Table:
    table = _table(
        "threadstate rebuild, from its start to published, fresh database", "workers", "states", "s", "database (MB)"
    )
    for one in report.rebuilds:
        table.add_row(str(one.processes), str(one.states), f"{one.seconds:.2f}", f"{one.database_bytes / 1e6:.1f}")
    return table


def _parts(report: Report) -> Table:
    total = sum(part.seconds for part in report.parts)
    table = _table("Where the time goes: the same library part by part, one core", "part", "process", "s", "share")
    for part in report.parts:
        table.add_row(part.name, part.where, f"{part.seconds:.2f}", f"{part.seconds / total:.1%}")
    table.add_row("all", "", f"{total:.2f}", "")
    return table


def _requests(report: Report) -> Table:
    table = _table(
        "Requests to this library, by a service in this process after its precomputation",
        "request",
        "first (ms)",
        "median",
        "longest",
    )
    for one in report.requests:
        table.add_row(one.name, f"{one.first_ms:.1f}", f"{one.median_ms:.1f}", f"{one.longest_ms:.1f}")
    return table


def _table(title: str, *columns: str) -> Table:
    table = Table(title=title, box=None, pad_edge=False)
    for i, column in enumerate(columns):
        table.add_column(column, justify="right" if i else "left")
    return table
