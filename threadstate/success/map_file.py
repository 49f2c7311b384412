"""Success maps in files: a header of their inputs, then an orientation a line (``threadstate.line_file``)."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

from threadstate.device.document import device_document, device_from_document
from threadstate.device.strategy import Strategy
from threadstate.errors import InvalidValueError
from threadstate.library.grid import Grid
from threadstate.library.identity import pair_of
from threadstate.line_file import LineFile
from threadstate.success.document import orientation_document, orientation_from_document, orientation_sha256
from threadstate.success.inputs import SuccessInputs
from threadstate.success.model import OrientationMap

NAME = "map file"


def inputs_document(inputs: SuccessInputs) -> dict[str, Any]:
    """What a map is computed from, with its hash; angles in degrees, lengths in the units that pair and device name."""
    return {
        "input_sha256": inputs.sha256,
        "code_version": inputs.code_version,
        "pair": json.loads(inputs.pair_json),
        "device": device_document(inputs.device),
        "strategy": inputs.strategy.value,
        "tilt_max": inputs.grid.tilt_max_deg,
        "tilt_step": inputs.grid.tilt_step_deg,
        "phase_step": inputs.grid.phase_step_deg,
        "mu": list(inputs.frictions),
        "phase_tolerance": inputs.phase_tolerance_deg,
        "mu_tolerance": inputs.mu_tolerance,
        "point_limit": inputs.point_limit,
    }


def inputs_of_map(path: Path) -> SuccessInputs | None:
    """What a file's map is computed from, by its first line; None where there is no file, or no line in it.

    Code is no part of it: a map of other code has another hash than these inputs, and :func:`growing_map` refuses it.

    Raises:
        InvalidValueError: the file cannot be read, or its first line is not that of a map.
    """
    try:
        with path.open("rb") as file:
            line = file.readline()
    except FileNotFoundError:
        return None
    except OSError as error:
        raise InvalidValueError(NAME, str(path), f"a file that can be read ({error.strerror})") from None
    if not line.endswith(b"\n"):
        return None
    try:
        return inputs_from_document(json.loads(line))
    except (ValueError, KeyError, TypeError):
        raise InvalidValueError(NAME, str(path), "a success map, or a file that does not exist") from None


def inputs_from_document(document: Any) -> SuccessInputs:
    """What a map is computed from, of its document; hash and code version, which it names, are not compared.

    Raises:
        KeyError, TypeError, ValueError: it is not the document of such inputs.
    """
    return SuccessInputs(
        pair_of(json.dumps(document["pair"])),
        device_from_document(document["device"]),
        Strategy(document["strategy"]),
        Grid(document["tilt_max"], document["tilt_step"], document["phase_step"]),
        tuple(document["mu"]),
        document["phase_tolerance"],
        document["mu_tolerance"],
        document["point_limit"],
    )


def read_map(path: Path, inputs: SuccessInputs) -> list[OrientationMap]:
    """The orientations of a file, in the order of the grid.

    Raises:
        InvalidValueError: the file cannot be read, is not a map, or is one of other inputs.
    """
    return _lines(inputs).read(path)


def growing_map(
    path: Path, inputs: SuccessInputs
) -> AbstractContextManager[tuple[list[OrientationMap], Callable[[OrientationMap], None]]]:
    """What a file has of a map, and what appends an orientation; a file that does not exist is made.

    An orientation that was appended is on the disk. While the context lasts no other process can append.

    Raises:
        InvalidValueError: as :func:`read_map`, or the file cannot be written, or another process appends to it.
    """
    return _lines(inputs).growing(path)


def _lines(inputs: SuccessInputs) -> LineFile[OrientationMap]:
    return LineFile(
        name=NAME,
        content="a success map",
        short="a map",
        line="an orientation",
        header=inputs_document(inputs),
        document=orientation_document,
        value=orientation_from_document,
        sha256=orientation_sha256,
        index=lambda one: one.index,
    )
