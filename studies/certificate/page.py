"""The section of docs/certificate.md that the audit writes."""

from __future__ import annotations

from collections.abc import Iterable

from studies.certificate.audit import MOST_BALLS
from studies.certificate.bounds import IN_MIDDLE, OVER_BOX
from studies.certificate.study import CLASSES, Found

HEADING = "## 11. The audit"

CLAIMS = len(OVER_BOX) + len(IN_MIDDLE) + 1
"""Of a box: its ranges, its values in the middle, its class."""


def section(found: Found) -> str:
    """What was audited and what was found, as the page's last section."""
    total = sum(count for (kind, _), count in found.boxes.items() if kind == "made")
    fails = sum(count for (_, outcome), count in found.outcomes.items() if outcome == "fails")
    undecided = sum(count for (_, outcome), count in found.outcomes.items() if outcome == "undecided")
    lines = [
        HEADING,
        "",
        f"`make certificate` put {total:,} boxes beside balls: half of them drawn at random, half taken from searches",
        "of random poses. phi and g are evaluated in ball arithmetic from their definitions alone, derivatives by",
        "the rules for sums, products and compositions, over parts of the box that are cut until each claim is proved",
        "or contradicted. A claim is a range over the box, a value in the middle with its error, or the class: of a",
        "dropped box that it holds no onset, of the others the signs that make their onset or peak the only one.",
        "",
        f"**{fails:,} claims were contradicted, {undecided:,} of {total * CLAIMS:,} stayed undecided** when a box had",
        f"been cut into more than {MOST_BALLS} parts.",
        "",
    ]
    for kind in ("made", "form", "stage", "half-width", "class"):
        lines += _table((kind, "boxes"), _rows(found, kind))
    lines += [
        "The most of each range that a corner or the middle of a box uses, and of an error in the middle; 1 is all.",
        "It is natural for a size, whose range is about 0. A slope in the middle is claimed to be that of some profile",
        "displaced by up to 1.5e-14 p (certificate, section 6); here it is set against the one that is not displaced,",
        "so that on fillets it may use more than its error.",
        "",
    ]
    lines += _table(
        ("range", "most used", "in"),
        (
            (f"`{name}`", f"{found.used[name].size:.3g}", found.used[name].text)
            for name in OVER_BOX + IN_MIDDLE
            if name in found.used and name != "depth"
        ),
    )
    contradicted = sorted(fault for fault in found.faults if " fails: " in fault)
    if contradicted:
        lines += ["Contradicted:", "", *(f"- {fault}" for fault in contradicted[:40]), ""]
    if undecided:
        rows = ((name, f"{count:,}") for (name, outcome), count in sorted(found.outcomes.items()) if outcome != "fails")
        lines += _table(("undecided", "boxes"), rows)
    return "\n".join(lines).rstrip() + "\n"


def _rows(found: Found, kind: str) -> Iterable[tuple[str, str]]:
    values = {value: count for (one, value), count in found.boxes.items() if one == kind}
    order = sorted(values, key=lambda value: float(value.split()[0])) if kind == "half-width" else sorted(values)
    if kind == "class":
        order = [value for value in CLASSES if value in values]
    return ((value, f"{values[value]:,}") for value in order)


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> list[str]:
    return [
        f"| {' | '.join(head)} |",
        f"|{'|'.join('---' for _ in head)}|",
        *(f"| {' | '.join(row)} |" for row in rows),
        "",
    ]
