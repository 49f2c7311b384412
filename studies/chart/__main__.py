"""``make chart``: speed against accuracy, measured; docs/speed-accuracy.svg, .json and .md."""

from __future__ import annotations

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from studies.chart.contestant import FULL
from studies.chart.drawing import DOCS, drawing
from studies.chart.findings import document
from studies.chart.page import page
from studies.chart.study import measured_study, work

PROCESSES = 2


def main() -> None:
    """Measure, and write picture, numbers and page."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("ETA"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), refresh_per_second=2) as progress:
        task = progress.add_task("contestants", total=work(FULL))
        study = measured_study(FULL, PROCESSES, lambda count: progress.advance(task, count))
    numbers = document(study)
    for ending, content in (("svg", drawing(numbers)), ("json", numbers), ("md", page(study))):
        (DOCS / f"speed-accuracy.{ending}").write_text(content)


if __name__ == "__main__":
    main()
