"""The command line ``threadstate``: its commands, and how their errors end."""

from __future__ import annotations

import gc
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Annotated, Any, cast

import typer
from typer.core import TyperCommand, TyperGroup
from typer.exceptions import TyperException
from typer.main import get_command_from_info, get_command_name, get_group
from typer.models import CommandInfo

import threadstate
from threadstate.errors import ThreadstateError
from worker.commands.assemble import assemble
from worker.commands.chances import chances
from worker.commands.compare import compare
from worker.commands.copy import copy
from worker.commands.design import design
from worker.commands.export import export
from worker.commands.formation import formation
from worker.commands.heights import heights
from worker.commands.held import held
from worker.commands.history import history
from worker.commands.jamming import jamming
from worker.commands.key import key
from worker.commands.libraries import libraries
from worker.commands.locate import locate
from worker.commands.mesh import mesh
from worker.commands.migrate import migrate
from worker.commands.network import network
from worker.commands.path import path
from worker.commands.profiles import profiles
from worker.commands.rebuild import rebuild
from worker.commands.rebuild_settled import rebuild_settled
from worker.commands.report import report
from worker.commands.run import run
from worker.commands.serve import serve
from worker.commands.settings import settings
from worker.commands.settle import settle
from worker.commands.solve import solve
from worker.commands.statics import statics
from worker.commands.success import success
from worker.commands.summary import summary
from worker.commands.sweep import sweep
from worker.commands.threads import threads
from worker.commands.transitions import transitions
from worker.commands.windows import windows
from worker.commands.worker import worker
from worker.exit_codes import ExitCode, exit_code_of
from worker.garbage import collect_rarely
from worker.output import print_line

PROGRAM = "threadstate"
HELP = "Contact states of a bolt that meets a nut askew: solved one by one, or as a whole library."

app = typer.Typer(
    name=PROGRAM,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

COMMANDS = (
    solve,
    statics,
    jamming,
    settle,
    assemble,
    success,
    chances,
    design,
    report,
    rebuild,
    rebuild_settled,
    sweep,
    libraries,
    summary,
    held,
    history,
    heights,
    windows,
    compare,
    threads,
    profiles,
    transitions,
    network,
    formation,
    path,
    locate,
    mesh,
    migrate,
    copy,
    export,
    worker,
    key,
    serve,
    run,
    settings,
)


def _print_version(wanted: bool) -> None:
    if wanted:
        print_line(f"{PROGRAM} {threadstate.__version__}")
        raise typer.Exit


@app.callback(help=HELP)
def _program(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version.", show_default=False
        ),
    ] = False,
) -> None:
    pass


def main() -> None:
    """Run the command line and end the process with its exit code."""
    collect_rarely()
    code = run_command_line(sys.argv[1:])
    gc.freeze()  # saves the garbage collection at exit, a tenth of a second
    sys.exit(code)


class _Commands(Mapping[str, Any]):
    """The commands by name, each with its options, described when it is looked up: all of them take 0.1 s."""

    def __init__(self) -> None:
        self._functions = {get_command_name(command.__name__): command for command in COMMANDS}
        self._described: dict[str, Any] = {}

    def __getitem__(self, name: str) -> Any:
        if name not in self._described:
            self._described[name] = _described(self._functions[name])
        return self._described[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._functions)

    def __len__(self) -> int:
        return len(self._functions)


def _described(command: Callable[..., Any]) -> Any:
    """The command of a function."""
    # In a raw docstring the mark that keeps lines apart is two characters; typer wants the one that they stand for.
    text = inspect.cleandoc(command.__doc__ or "").replace("\\b", "\b")
    # The overview shows a short help as it is, and cuts what it takes from a long one.
    short = text.split("\n\n")[0].replace("\n", " ")
    info = CommandInfo(callback=command, cls=TyperCommand, help=text, short_help=short)
    return get_command_from_info(info, pretty_exceptions_short=False, rich_markup_mode=None)


@cache
def command_group() -> TyperGroup:
    """The program with its commands."""
    group = get_group(app)
    group.commands = cast("Any", _Commands())
    return group


def run_command_line(arguments: list[str]) -> int:
    """Run a command; an error is one line on stderr.

    Returns:
        The exit code.
    """
    try:
        code = command_group().main(arguments or ["--help"], prog_name=PROGRAM, standalone_mode=False)
        sys.stdout.flush()
        if code == ExitCode.INTERRUPTED:
            return _print_error("interrupted", ExitCode.INTERRUPTED)
        return code if isinstance(code, int) else ExitCode.OK
    except TyperException as error:
        context = getattr(error, "ctx", None)
        where = context.command_path if context else PROGRAM
        return _print_error(f"{error.format_message()} (try `{where} --help`)", error.exit_code)
    except ThreadstateError as error:
        return _print_error(str(error), exit_code_of(error))
    except BrokenPipeError:
        # The reader has closed the pipe; at exit Python would flush into it again.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitCode.FAILURE
    except Exception as error:  # users get no traceback
        # SQLAlchemy's message has the SQL and its rows; that of the database itself is in ``orig``.
        reason = getattr(error, "orig", None) or error
        return _print_error(f"{type(reason).__name__}: {reason}", ExitCode.FAILURE)


def _print_error(message: str, code: int) -> int:
    one_line = " ".join(message.split())
    sys.stderr.write(f"{PROGRAM}: {one_line}\n")
    return code
