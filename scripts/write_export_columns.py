"""Writes the columns of exports into docs/export.md and those of frames into docs/client.md."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from threadstate.client.frame_columns import COLUMNS
from threadstate.export.column import Column, Unit
from threadstate.export.intervals import LEAST_LABELS, interval_columns
from threadstate.export.states import LEAST_CONTACTS, UNDECIDED_COLUMNS, state_columns

DOCS = Path(__file__).parent.parent / "docs"
EXPORTS = DOCS / "export.md"
CLIENT = DOCS / "client.md"

_PLACES = (
    (r"^contact_\d_", "contact_{n}_"),
    (r"^pose_\d_", "pose_{s}_"),
    (r"_r\d\d$", "_r{i}{j}"),
    (r"_t[xyz]$", "_t{a}"),
    (r"_(point|point_bolt|normal)_[xyz]$", r"_\1_{a}"),
)


def written(path: Path, pages: Iterable[str]) -> str:
    """The page with the tables between its marks."""
    head, _, rest = path.read_text().partition("<!-- columns -->\n")
    tail = rest.partition("<!-- /columns -->")[2]
    return f"{head}<!-- columns -->\n{''.join(pages)}<!-- /columns -->{tail}"


def export_tables() -> Iterator[str]:
    """The columns of each exported table."""
    yield _table("`states`", state_columns(LEAST_CONTACTS))
    yield _table("`intervals`", interval_columns(LEAST_LABELS))
    yield _table("`undecided`", UNDECIDED_COLUMNS)


def frame_tables() -> Iterator[str]:
    """The columns of each kind of frame."""
    for kind, columns in COLUMNS.items():
        yield _table(f"`{kind.__name__}`", columns)


def _table(title: str, columns: Iterable[Column[Any]]) -> str:
    lines = dict.fromkeys(_line(column) for column in columns)
    return "\n".join(
        [f"## Columns of {title}\n", "| column | cells | unit | meaning |", "|---|---|---|---|", *lines, "\n"]
    )


def _line(column: Column[Any]) -> str:
    name = column.name
    for place, letter in _PLACES:
        name = re.sub(place, letter, name)
    meaning = re.sub(r"stage \d", "stage `{s}`", column.meaning)
    unit = {Unit.DEGREES: "deg", Unit.LENGTH: "length", Unit.NONE: ""}[column.unit]
    return f"| `{name}` | {column.kind.value} | {unit} | {meaning} |"


if __name__ == "__main__":
    EXPORTS.write_text(written(EXPORTS, export_tables()))
    CLIENT.write_text(written(CLIENT, frame_tables()))
