"""The exit codes of ``threadstate``; ``docs/cli.md`` lists them."""

from __future__ import annotations

from enum import IntEnum

from threadstate.errors import InvalidValueError, NotFoundError, SchemaError, UnresolvedPoseError


class ExitCode(IntEnum):
    """The meaning of an exit code."""

    OK = 0
    FAILURE = 1
    USAGE = 2
    SCHEMA = 3
    NOT_FOUND = 4
    UNRESOLVED = 5
    INTERRUPTED = 130


def exit_code_of(error: Exception) -> ExitCode:
    """The exit code of a command that ended with this error."""
    match error:
        case InvalidValueError():
            return ExitCode.USAGE
        case SchemaError():
            return ExitCode.SCHEMA
        case NotFoundError():
            return ExitCode.NOT_FOUND
        case UnresolvedPoseError():
            return ExitCode.UNRESOLVED
        case _:
            return ExitCode.FAILURE
