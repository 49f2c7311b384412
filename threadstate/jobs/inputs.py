"""The inputs of a library as JSON that gives the same inputs back."""

from __future__ import annotations

from functools import cache

from pydantic import TypeAdapter

from threadstate.library.identity import LibraryInputs


def inputs_json(inputs: LibraryInputs) -> str:
    """The inputs as JSON; every double is written so that it reads back the same."""
    return _adapter().dump_json(inputs).decode()


def inputs_from_json(content: str) -> LibraryInputs:
    """The inputs that a job keeps."""
    return _adapter().validate_json(content)


@cache
def _adapter() -> TypeAdapter[LibraryInputs]:
    return TypeAdapter(LibraryInputs)
