"""The claims as a table for people on a terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from rich.console import Console
from rich.table import Table

from studies.paper.claim import Claim, Verdict

WIDTH_OF_A_FILE = 170
COLOURS = {Verdict.AGREES: "green", Verdict.DISAGREES: "red", Verdict.UNDECIDED: "yellow"}


def print_table(claims: Sequence[Claim]) -> None:
    """One row a claim, then how many of each verdict."""
    console = Console(highlight=False)
    if not console.is_terminal:
        console = Console(highlight=False, width=WIDTH_OF_A_FILE)
    table = Table(show_lines=True)
    for name, ratio in (("where", 2), ("the paper says", 5), ("measured", 6), ("verdict", 2), ("because", 6)):
        table.add_column(name, ratio=ratio)
    for one in claims:
        colour = COLOURS[one.verdict]
        table.add_row(one.reference, one.statement, one.measurement, f"[{colour}]{one.verdict}[/]", one.reason)
    console.print(table)
    console.print(counted(claims))


def counted(claims: Sequence[Claim]) -> str:
    """How many claims have each verdict, as a sentence."""
    counts = Counter(one.verdict for one in claims)
    return (
        f"Of {len(claims)} statements {counts[Verdict.AGREES]} agree, {counts[Verdict.DISAGREES]} disagree, and "
        f"{counts[Verdict.UNDECIDED]} cannot be decided."
    )
