"""docs/tutorial.md followed to the letter: every command is run, in order, and prints what the page shows."""

from __future__ import annotations

import re
from collections.abc import Iterator
from decimal import Decimal
from pathlib import Path

import pytest

from harness.databases import Databases
from scripts.shown_commands import ShownCommand, Terminal, abridged, saved_files, shown_commands, written_again
from tests.service_thread import service_thread
from tests.stored_histories.history_library import histories_of_grid, store_histories
from threadstate.library.grid import Grid
from threadstate.settings import DATABASE

NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?![\w.])")
UNITS_OF_THE_LAST_PLACE = 2
"""Phases of boundaries are known to 5e-7 deg, and tables show six decimals."""
COARSE_GRID = Grid(4.0, 4.0, 5.0)
"""Of the library that stands for that of ``make run``: every pose that the page asks it about is on the grid."""


def differ(one: str, other: str) -> bool:
    """Whether two lines differ in more than spaces and the last place of their numbers."""
    words = [NUMBER.sub("#", line).split() for line in (one, other)]
    if words[0] != words[1]:
        return True
    for shown, printed in zip(NUMBER.findall(one), NUMBER.findall(other), strict=True):
        last_place = Decimal(1).scaleb(int(Decimal(shown).as_tuple().exponent)) if "." in shown else Decimal(0)
        if abs(Decimal(shown) - Decimal(printed)) > UNITS_OF_THE_LAST_PLACE * last_place:
            return True
    return False


@pytest.fixture(scope="module")
def page(repository_root: Path) -> str:
    """The page."""
    return (repository_root / "docs" / "tutorial.md").read_text()


@pytest.fixture(scope="module")
def terminal(
    sqlite_databases: Databases, repository_root: Path, tmp_path_factory: pytest.TempPathFactory, page: str
) -> Iterator[Terminal]:
    """A terminal in the repository, after ``make run``."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(repository_root)
        patch.setenv("PYTHONPATH", str(repository_root))
        database = sqlite_databases.migrated()
        patch.setenv(DATABASE, database)
        store_histories(database, COARSE_GRID, histories_of_grid(COARSE_GRID))
        with service_thread(database) as address:
            yield Terminal(address, tmp_path_factory.mktemp("saved"), saved_files(page))


def test_every_command_prints_what_is_shown(terminal: Terminal, page: str) -> None:
    commands = shown_commands(page)
    assert {one.command.split()[0] for one in commands} == {"threadstate", "curl", "python"}
    for one in commands:
        printed = abridged(terminal.run(one.command), one.lines)
        assert len(printed) == len(one.lines), one.command
        assert [pair for pair in zip(one.lines, printed, strict=True) if differ(*pair)] == [], one.command


def test_the_words_between_name_the_same_figures(page: str) -> None:
    (located,) = (one for one in shown_commands(page) if "locate" in one.command)
    stretches = re.findall(r"^4 +0 +(\S+) +(\S+) ", "\n".join(located.lines), re.MULTILINE)
    width = sum(float(end) - float(start) for start, end in stretches)
    assert f"Of nine tilts only one is possible, 4 deg of roll, and {width:.0f} deg of phase" in page
    assert "6 of 9 tilts" in page
    assert "Six of the nine snap" in page


def test_the_page_begins_with_what_sets_up(page: str) -> None:
    assert page.index("make run") < page.index("source .venv/bin/activate") < page.index("$ threadstate")


@pytest.mark.parametrize(
    ("one", "other", "wanted"),
    [
        ("4  0  356.976120", "4 0 356.976121", False),
        ("4  0  356.976120", "4  0  356.976123", True),
        ("4  0  356.976120", "5  0  356.976120", True),
        ("9c365325e3  1.762 %", "9c365325e4  1.762 %", True),
        ("snap", "no snap", True),
    ],
)
def test_lines_differ_by_words_and_numbers(one: str, other: str, wanted: bool) -> None:
    assert differ(one, other) == wanted


def test_a_page_is_written_with_what_is_printed() -> None:
    shown = "Ask.\n\n```\n$ one\nold\n...\nold\n```\n\n```\n$ none\n```\n"
    printed = {"one": "a  contacts\nb  in words\nc\nd  words\n", "none": "9 s\n"}
    again = written_again(shown, printed.__getitem__)
    assert again == "Ask.\n\n```\n$ one\na\n...\nd\n```\n\n```\n$ none\n```\n"
    assert shown_commands(again) == [ShownCommand("one", ("a", "...", "d")), ShownCommand("none", ())]
