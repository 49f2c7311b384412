"""The pair and the solver's options that a library was computed with, read back from its record."""

from __future__ import annotations

import json
from dataclasses import fields
from functools import cache

from pydantic import TypeAdapter

from threadstate.library.read import LibraryRecord
from threadstate.state.options import SolveOptions
from threadstate.thread.pair import Pair


def library_pair(record: LibraryRecord) -> Pair:
    """The pair of a library, lengths in the library's own unit."""
    return pair_of(record.pair)


def library_options(record: LibraryRecord) -> SolveOptions:
    """The options of a library's solver; of a library by meshes those that all solver methods share."""
    return options_of(record.options)


def pair_of(pair_json: str) -> Pair:
    """The pair of its canonical JSON."""
    return _adapter().validate_json(pair_json)


def options_of(options_json: str) -> SolveOptions:
    """The options that all solver methods share, of their canonical JSON."""
    stored = json.loads(options_json)
    return SolveOptions(**{field.name: stored[field.name] for field in fields(SolveOptions)})


@cache
def _adapter() -> TypeAdapter[Pair]:
    return TypeAdapter(Pair)
