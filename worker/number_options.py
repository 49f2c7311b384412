"""Options that are numbers: those of :mod:`threadstate.numbers`, not all that Python would read."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

import typer

from threadstate.numbers import integer, number


def number_option(name: str, **described: Any) -> Any:
    """An option that is a number; ``described`` as for ``typer.Option``."""
    return typer.Option(name, parser=lambda value: _read(number, value), **described)


def integer_option(name: str, *, min: int | None = None, max: int | None = None, **described: Any) -> Any:  # noqa: A002
    """An option that is a whole number from ``min`` to ``max``; ``described`` as for ``typer.Option``."""

    def parse(value: object) -> object:
        found = _read(integer, value)
        if min is not None and found < min:
            _refuse(f"{found} is below {min}")
        if max is not None and found > max:
            _refuse(f"{found} is above {max}")
        return found

    return typer.Option(name, parser=parse, min=min, max=max, **described)


def _read(read: Callable[[str], float], value: Any) -> Any:
    """What a text says; a default is no text."""
    if not isinstance(value, str):
        return value
    try:
        return read(value)
    except ValueError as error:
        _refuse(str(error))


def _refuse(reason: str) -> NoReturn:
    # Loaded when it is needed: `threadstate --help` does without.
    from pydantic_core import PydanticCustomError

    raise PydanticCustomError("number", "{reason}", {"reason": reason})
