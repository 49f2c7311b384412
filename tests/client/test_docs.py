from __future__ import annotations

import inspect
import re
from pathlib import Path

import pytest

import threadstate.client
from scripts.write_export_columns import CLIENT, EXPORTS, export_tables, frame_tables, written
from threadstate.client import AsyncClient, AsyncItems, AsyncJob, Client, Items, Job
from threadstate.client.frame_columns import COLUMNS
from threadstate.export.column import Column
from threadstate.export.intervals import LEAST_LABELS, interval_columns
from threadstate.export.states import LEAST_CONTACTS, UNDECIDED_COLUMNS, state_columns


@pytest.fixture(scope="module")
def manual(repository_root: Path) -> str:
    """docs/client.md."""
    return (repository_root / "docs" / "client.md").read_text()


@pytest.mark.parametrize("name", threadstate.client.__all__)
def test_every_public_name_is_in_the_manual(manual: str, name: str) -> None:
    assert re.search(rf"(`{name}[`(]|^## .*\b{name}\b)", manual, re.M)


@pytest.mark.parametrize("owner", [Client, AsyncClient, Job, AsyncJob, Items, AsyncItems])
def test_every_public_method_is_in_the_manual(manual: str, owner: type[object]) -> None:
    names = {name for name in vars(owner) if not name.startswith("_")}
    assert len(names) > 2
    assert {name for name in names if not re.search(rf"`(\w+\.)?{name}[`(]", manual)} == set()


def test_every_argument_of_a_client_is_in_the_manual(manual: str) -> None:
    for name in set(inspect.signature(Client).parameters):
        assert f"| `{name}` |" in manual


def test_every_column_is_documented_as_it_is() -> None:
    """`python -m scripts.write_export_columns` writes the tables anew."""
    assert EXPORTS.read_text() == written(EXPORTS, export_tables())
    assert CLIENT.read_text() == written(CLIENT, frame_tables())


def test_no_column_is_left_out_of_the_tables() -> None:
    """What a page says of columns by letters is as many columns as there are."""
    text = EXPORTS.read_text()
    tables = re.split(r"^## Columns of ", text, flags=re.M)[1:]
    exported: list[tuple[Column[object], ...]] = [
        state_columns(LEAST_CONTACTS),  # type: ignore[list-item]
        interval_columns(LEAST_LABELS),  # type: ignore[list-item]
        UNDECIDED_COLUMNS,  # type: ignore[list-item]
    ]
    for table, columns in zip(tables, exported, strict=True):
        names = re.findall(r"^\| `([^`]+)` \|", table, re.M)
        expanded: set[str] = set()
        for name in names:
            forms = [name]
            for letter, values in (("{n}", "123"), ("{s}", "123"), ("{i}", "123"), ("{j}", "123"), ("{a}", "xyz")):
                forms = [form.replace(letter, value) for form in forms for value in values] if letter in name else forms
            expanded |= set(forms)
        assert expanded == {column.name for column in columns}
    for kind in COLUMNS:
        assert f"## Columns of `{kind.__name__}`" in CLIENT.read_text()
