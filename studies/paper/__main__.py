"""``make paper``: the paper's statements put to the test, as a table and as docs/paper-claims.md."""

from __future__ import annotations

from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from studies.paper.page import page, print_table
from studies.paper.registry import claims_by_chapter, statement_count
from studies.paper.study import FULL, poses_to_solve, solved_study

PAGE = Path(__file__).parent.parent.parent / "docs" / "paper-claims.md"


def main() -> None:
    """Solve, measure, write the page, print the table."""
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("ETA"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), refresh_per_second=5) as progress:
        poses = progress.add_task("poses", total=poses_to_solve(FULL))
        statements = progress.add_task("statements", total=statement_count())
        study = solved_study(FULL, lambda count: progress.advance(poses, count))
        chapters = claims_by_chapter(study, lambda count: progress.advance(statements, count))
    PAGE.write_text(page(chapters, study))
    print_table([claim for _, claims in chapters for claim in claims])


if __name__ == "__main__":
    main()
