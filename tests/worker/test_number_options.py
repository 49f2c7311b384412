"""No option that is a number is read by a syntax of Python's own."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, get_args, get_type_hints

import pytest
from typer.exceptions import TyperException

from worker.cli import COMMANDS, command_group, run_command_line

pytestmark = pytest.mark.sqlite_alone

ODD = ["1_0", " 1", "nan", "infinity", "٣", "0x1", ""]


def _is_number(annotation: Any) -> bool:
    return annotation in (int, float) or any(_is_number(one) for one in get_args(annotation))


def _options() -> Iterator[tuple[str, str]]:
    """(command, option) of every number."""
    group = command_group()
    for command in COMMANDS:
        types = get_type_hints(command)
        name = command.__name__.replace("_", "-")
        for parameter in group.commands[name].params:
            if _is_number(types[parameter.name or ""]):
                yield name, parameter.opts[0]


OPTIONS = list(_options())


def test_there_are_such_options() -> None:
    assert {("solve", "--roll"), ("worker", "--workers"), ("mesh", "--chord"), ("run", "--tilt-max")} <= set(OPTIONS)


@pytest.mark.parametrize(("command", "option"), OPTIONS)
def test_an_odd_number_is_refused_by_its_option_and_text(command: str, option: str) -> None:
    for text in ODD:
        assert f"Invalid value for '{option}': {text!r} is not a " in _refusal(command, f"{option}={text}")


@pytest.mark.parametrize(("option", "reason"), [("--workers=0", "0 is below 1"), ("--workers=257", "257 is above 256")])
def test_limits_hold(option: str, reason: str) -> None:
    assert f"Invalid value for '--workers': {reason}" in _refusal("worker", option)


def _refusal(command: str, argument: str) -> str:
    """What is said where a command is given that argument; nothing is run."""
    group = command_group()
    try:
        group.commands[command].make_context(command, [argument])
    except TyperException as error:
        return error.format_message()
    return ""


def test_a_dimension_is_refused_by_its_key_and_text(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ODD:
        given = ["--pair", "mine", "--dimension", "like=1/4-20 UNC", "--dimension", f"thread_pitch={text}"]
        assert run_command_line(["settings", *given]) == 2
        assert f"thread_pitch is {text!r}; valid: a valid number" in capsys.readouterr().err


def test_a_tilt_is_refused_as_it_was_given(capsys: pytest.CaptureFixture[str]) -> None:
    for text in ("1_0,2", "0,nan", "0,٣", "0"):
        assert run_command_line(["compare", f"--tilt={text}", "--database", "sqlite:////nowhere/at/all"]) == 2
        assert f"--tilt is {text!r}; valid: two angles in degrees" in capsys.readouterr().err
