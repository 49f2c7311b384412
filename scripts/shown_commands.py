"""Commands that a page shows with what they print: found, run, and written again.

A command stands alone in a block, after ``$``. Of what it prints the page may leave out lines, for which ``...`` is
put, and the last column of tables, with words; a block without output stays without.
"""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
import urllib.request
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from worker.cli import run_command_line

BLOCK = re.compile(r"^```\n\$ (?P<command>.*)\n(?P<lines>(?:(?!```).*\n)*)```$", re.MULTILINE)
SAVED = re.compile(r"^Save this as `(?P<name>[\w.]+)`:\n\n```python\n(?P<text>.*?)```$", re.MULTILINE | re.DOTALL)
REST = "..."
"""Stands for the lines that are left out."""
WORDS = "contacts"
"""The last column of tables, whose words are wide: what stands under it is left out."""


@dataclass(frozen=True)
class ShownCommand:
    """A command, and the lines of its output as a page shows them."""

    command: str
    lines: tuple[str, ...]


def shown_commands(page: str) -> list[ShownCommand]:
    """The commands of a page, in order."""
    return [ShownCommand(found["command"], tuple(found["lines"].splitlines())) for found in BLOCK.finditer(page)]


def saved_files(page: str) -> dict[str, str]:
    """The programs that a page asks to be saved, by the names of their files."""
    return {found["name"]: found["text"] for found in SAVED.finditer(page)}


def abridged(printed: str, like: Sequence[str]) -> list[str]:
    """What was printed, with lines and words left out as in the lines that are shown."""
    if not like:
        return []
    tables = printed.rstrip().split("\n\n")
    lines = "\n\n".join(_without_words(table) for table in tables).splitlines()
    if REST not in like:
        return lines
    first = list(like).index(REST)
    return [*lines[:first], REST, *lines[len(lines) - (len(like) - first - 1) :]]


def written_again(page: str, run: Callable[[str], str]) -> str:
    """A page with what its commands print now; ``run`` runs one and returns its output."""

    def block(found: re.Match[str]) -> str:
        lines = abridged(run(found["command"]), found["lines"].splitlines())
        return "\n".join(("```", f"$ {found['command']}", *lines, "```"))

    return BLOCK.sub(block, page)


class Terminal:
    """Runs what a page shows: commands here, ``curl`` and ``python`` against the service at ``address``.

    ``folder`` holds the programs that the page asks to be saved; the database is that of the environment.
    """

    def __init__(self, address: str, folder: Path, saved: Mapping[str, str]) -> None:
        self._address = address
        self._folder = folder
        for name, text in saved.items():
            (folder / name).write_text(text)

    def run(self, command: str) -> str:
        """What a command prints.

        Raises:
            RuntimeError: it failed, or is of no known kind.
        """
        program, *arguments = shlex.split(command)
        if program == "threadstate":
            return _threadstate(command, arguments)
        if program == "curl":
            (address,) = (one for one in arguments if not one.startswith("-"))
            with urllib.request.urlopen(address.replace("127.0.0.1:8000", self._address)) as response:
                content: bytes = response.read()
            return content.decode()
        if program == "python":
            environment = {**os.environ, "THREADSTATE_SERVICE": self._address}
            run = [sys.executable, str(self._folder / arguments[0]), *arguments[1:]]
            return subprocess.run(run, env=environment, check=True, capture_output=True, text=True).stdout
        raise RuntimeError(f"{command}: no command that is known here")


def _threadstate(command: str, arguments: list[str]) -> str:
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        code = run_command_line(arguments)
    if code != 0:
        raise RuntimeError(f"{command} ended with {code}")
    return printed.getvalue()


def _without_words(table: str) -> str:
    """A table, and lines before it, without the column of words."""
    lines = table.splitlines()
    head = next((number for number, line in enumerate(lines) if line.endswith(WORDS)), len(lines))
    width = lines[head].index(WORDS) if head < len(lines) else None
    return "\n".join([*lines[:head], *(line[:width].rstrip() for line in lines[head:])])
