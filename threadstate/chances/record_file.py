"""Samples in files: a header of their inputs, then a sample a line (``threadstate.line_file``)."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from threadstate.chances.document import record_document, record_from_document, record_sha256
from threadstate.chances.inputs import ChancesInputs
from threadstate.chances.model import Record
from threadstate.line_file import LineFile


def inputs_document(inputs: ChancesInputs) -> dict[str, Any]:
    """What samples are computed from, with its hash."""
    return {"input_sha256": inputs.sha256, **inputs.document}


def read_records(path: Path, inputs: ChancesInputs) -> list[Record]:
    """The samples of a file, by their numbers.

    Raises:
        InvalidValueError: the file cannot be read, has no samples, or has those of other inputs.
    """
    return _lines(inputs).read(path)


def growing_records(
    path: Path, inputs: ChancesInputs
) -> AbstractContextManager[tuple[list[Record], Callable[[Record], None]]]:
    """What a file has of the samples, and what appends one; a file that does not exist is made.

    A sample that was appended is on the disk. While the context lasts no other process can append.

    Raises:
        InvalidValueError: as :func:`read_records`, or the file cannot be written, or another process appends to it.
    """
    return _lines(inputs).growing(path)


def _lines(inputs: ChancesInputs) -> LineFile[Record]:
    return LineFile(
        name="sample file",
        content="sampled paths",
        short="samples",
        line="a sample",
        header=inputs_document(inputs),
        document=record_document,
        value=record_from_document,
        sha256=record_sha256,
        index=lambda one: one.approach.index,
    )
