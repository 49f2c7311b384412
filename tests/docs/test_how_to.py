"""docs/how-to.md: every command that it shows is one that can be given."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from typer.exceptions import TyperException

from tests.docs.test_links import LINK
from worker.cli import PROGRAM, command_group

BLOCK = re.compile(r"^```\n(?P<lines>.*?)^```$", re.MULTILINE | re.DOTALL)


def questions(page: str) -> dict[str, str]:
    """What stands below each question."""
    parts = re.split(r"^## (.*)$", page, flags=re.MULTILINE)[1:]
    return dict(zip(parts[::2], parts[1::2], strict=True))


def commands(page: str) -> list[str]:
    """The command lines of a page."""
    return [line for block in BLOCK.finditer(page) for line in block["lines"].splitlines()]


def parse(command: str) -> None:
    """Read a command line of threadstate as its program does, without running it.

    Raises:
        TyperException: no such command or option, or a value that it does not take.
    """
    program, name, *arguments = shlex.split(command)
    assert program == PROGRAM
    group = command_group()
    with group.make_context(PROGRAM, [name, *arguments]) as context:
        chosen, found, rest = group.resolve_command(context, [name, *arguments])
        assert found
        found.make_context(chosen, rest, parent=context)


@pytest.fixture(scope="module")
def page(repository_root: Path) -> str:
    """The page."""
    return (repository_root / "docs" / "how-to.md").read_text()


def test_every_heading_is_a_question_with_a_command_and_a_link(page: str) -> None:
    answers = questions(page)
    assert len(answers) > 10
    assert [question for question in answers if not question.endswith("?")] == []
    assert [question for question, answer in answers.items() if not commands(answer)] == []
    assert [question for question, answer in answers.items() if not LINK.search(answer)] == []


def test_every_answer_is_short(page: str) -> None:
    lengths = {question: len(answer.strip().splitlines()) for question, answer in questions(page).items()}
    assert {question: length for question, length in lengths.items() if length > 9} == {}


def test_every_command_is_one_that_can_be_given(
    repository_root: Path, page: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(repository_root)
    programs = [shlex.split(command)[0] for command in commands(page)]
    assert set(programs) == {PROGRAM, "dask"}
    for command in commands(page):
        if command.startswith(f"{PROGRAM} "):
            parse(command)


def test_every_example_that_is_named_is_there(repository_root: Path, page: str) -> None:
    named = set(re.findall(r"examples/[\w.]+", "\n".join(commands(page))))
    assert named
    assert [name for name in named if not (repository_root / name).is_file()] == []


@pytest.mark.parametrize(
    "command",
    [
        "threadstate solved --roll 1",
        "threadstate solve --rol 1",
        "threadstate solve --roll one",
        "threadstate assemble --roll 0 --pitch 0 --phase 0 --strategy up",
    ],
)
def test_a_command_that_cannot_be_given_is_found(command: str) -> None:
    with pytest.raises(TyperException, match=r"no such|No such|not a decimal|not one of"):
        parse(command)
